// Mirrors core/src/surface.rs: a patch and a dyadic parameter range, all integers.
#define LEVEL_MASK 31u
#define V_LEVEL_SHIFT 5u
#define LEVELS_MASK (LEVEL_MASK | LEVEL_MASK << V_LEVEL_SHIFT)

static Surface root(uint patch_id) {
    const Surface surface = {patch_id, 0u, 0u, 0u, {0u, 0u, 0u, 0u}};
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

// The halves of the range of u, with borders that are not theirs yet.
static Halves halves_u(Surface surface) {
    surface.shape += 1u;
    Halves halves = {surface, surface};
    halves.high.u += u_size(surface);
    return halves;
}

// The halves of the range of v, with borders that are not theirs yet.
static Halves halves_v(Surface surface) {
    surface.shape += 1u << V_LEVEL_SHIFT;
    Halves halves = {surface, surface};
    halves.high.v += v_size(surface);
    return halves;
}

static Surface surface_of(Draw draw) {
    const Surface surface = {draw.patch_id, draw.u, draw.v, draw.shape & LEVELS_MASK,
                             {draw.borders[0], draw.borders[1], draw.borders[2], draw.borders[3]}};
    return surface;
}
