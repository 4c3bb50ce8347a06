// Mirrors core/src/kernel/bound.rs: what of it concerns Bezier patches in our own profile only. Most scenes need
// no more, and a software device would run the rest for nothing.

fn bound_any(surface: Surface) -> Verdict {
    return bound(surface);
}

// Lengths along u and along v on screen.
fn extents_of(seen: OnScreen) -> vec2<f32> {
    return vec2<f32>(length_u(seen), length_v(seen));
}

fn wobble_of(seen: OnScreen, spread: f32, scale: f32) -> f32 {
    return 0.0;
}
