// Mirrors core/src/kernel/bound.rs: what a frame asks for whose surfaces are flat; in our own profile.

fn is_flat() -> bool {
    return true;
}

fn is_weber() -> bool {
    return false;
}
