// Mirrors core/src/surface.rs: a patch and a dyadic parameter range, all integers.
#define LEVEL_MASK 31u
#define V_LEVEL_SHIFT 5u

static Surface root(uint patch_id) {
    const Surface surface = {patch_id, 0u, 0u, 0u};
    return surface;
}

static uint u_level(Surface surface) {
    return surface.shape & LEVEL_MASK;
}

static uint v_level(Surface surface) {
    return (surface.shape >> V_LEVEL_SHIFT) & LEVEL_MASK;
}

static uint level(Surface surface) {
    return u_level(surface) + v_level(surface);
}

static uint u_size(Surface surface) {
    return PARAM_ONE >> u_level(surface);
}

static uint v_size(Surface surface) {
    return PARAM_ONE >> v_level(surface);
}

// Both halves of a surface.
typedef struct {
    Surface low;
    Surface high;
} Halves;

static Halves halves_u(Surface surface) {
    const uint shape = surface.shape + 1u;
    const Halves halves = {
        {surface.patch_id, surface.u, surface.v, shape},
        {surface.patch_id, surface.u + u_size(surface) / 2u, surface.v, shape},
    };
    return halves;
}

static Halves halves_v(Surface surface) {
    const uint shape = surface.shape + (1u << V_LEVEL_SHIFT);
    const Halves halves = {
        {surface.patch_id, surface.u, surface.v, shape},
        {surface.patch_id, surface.u, surface.v + v_size(surface) / 2u, shape},
    };
    return halves;
}

static Halves halves_of(Surface surface, uint code) {
    return code == SPLIT_U ? halves_u(surface) : halves_v(surface);
}

static Draw new_draw(Surface surface, Verdict verdict) {
    const Draw draw = {surface.patch_id, surface.u, surface.v, surface.shape, verdict.columns, verdict.rows};
    return draw;
}

static Surface surface_of(Draw draw) {
    const Surface surface = {draw.patch_id, draw.u, draw.v, draw.shape};
    return surface;
}
