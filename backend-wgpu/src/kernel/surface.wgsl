// Mirrors core/src/surface.rs: a patch and a dyadic parameter range, all integers.

const LEVEL_MASK: u32 = 31u;
const V_LEVEL_SHIFT: u32 = 5u;

// A whole patch.
fn root(patch_id: u32) -> Surface {
    return Surface(patch_id, 0u, 0u, 0u);
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

// The lower (0) or upper (1) half of the range of u.
fn half_u(surface: Surface, upper: u32) -> Surface {
    let start = surface.u + upper * (u_size(surface) / 2u);
    return Surface(surface.patch_id, start, surface.v, surface.shape + 1u);
}

// The lower (0) or upper (1) half of the range of v.
fn half_v(surface: Surface, upper: u32) -> Surface {
    let start = surface.v + upper * (v_size(surface) / 2u);
    return Surface(surface.patch_id, surface.u, start, surface.shape + (1u << V_LEVEL_SHIFT));
}

// The surface to be diced.
fn draw_of(surface: Surface, verdict: Verdict) -> Draw {
    return Draw(surface.patch_id, surface.u, surface.v, surface.shape, verdict.columns, verdict.rows);
}

fn surface_of(draw: Draw) -> Surface {
    return Surface(draw.patch_id, draw.u, draw.v, draw.shape);
}
