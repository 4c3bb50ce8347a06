// Mirrors core/src/surface.rs: a patch and a dyadic parameter range, all integers.

const LEVEL_MASK: u32 = 31u;
const LEVELS_MASK: u32 = LEVEL_MASK | (LEVEL_MASK << V_LEVEL_SHIFT);
const V_LEVEL_SHIFT: u32 = 5u;

// A whole patch.
fn root(patch_id: u32) -> Surface {
    return Surface(patch_id, 0u, 0u, 0u, array<u32, 4>(0u, 0u, 0u, 0u));
}

fn u_level(surface: Surface) -> u32 {
    return surface.shape & LEVEL_MASK;
}

fn v_level(surface: Surface) -> u32 {
    return (surface.shape >> V_LEVEL_SHIFT) & LEVEL_MASK;
}

fn level(surface: Surface) -> u32 {
    return u_level(surface) + v_level(surface);
}

fn u_size(surface: Surface) -> u32 {
    return PARAM_ONE >> u_level(surface);
}

fn v_size(surface: Surface) -> u32 {
    return PARAM_ONE >> v_level(surface);
}

// The lower (0) or upper (1) half of the range of u, with borders that are not its own yet.
fn half_u(surface: Surface, upper: u32) -> Surface {
    let start = surface.u + upper * (u_size(surface) / 2u);
    return Surface(surface.patch_id, start, surface.v, surface.shape + 1u, surface.borders);
}

// The lower (0) or upper (1) half of the range of v, with borders that are not its own yet.
fn half_v(surface: Surface, upper: u32) -> Surface {
    let start = surface.v + upper * (v_size(surface) / 2u);
    let shape = surface.shape + (1u << V_LEVEL_SHIFT);
    return Surface(surface.patch_id, surface.u, start, shape, surface.borders);
}

// The surface that is diced.
fn surface_of(draw: Draw) -> Surface {
    return Surface(draw.patch_id, draw.u, draw.v, draw.shape & LEVELS_MASK, draw.borders);
}
