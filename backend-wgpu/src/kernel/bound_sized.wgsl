// Mirrors core/src/kernel/bound.rs: what a frame asks for whose surfaces are small, by the rules of any profile.

fn is_flat() -> bool {
    return false;
}

fn is_weber() -> bool {
    return (frame.flags & FLAG_WEBER) != 0u;
}
