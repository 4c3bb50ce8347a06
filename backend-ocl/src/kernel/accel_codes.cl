// Mirrors core/src/accel/morton.rs: where the centre of each primitive's box is on the curve. One work-item a primitive.

// Centres are halved so often that no difference of them can exceed the range of floats.
#define SMALL 0.03125f
#define HALF_SMALL 0.015625f

typedef struct {
    float low[3];
    float scale;
    uint bits;
} AccelGrid;

static AccelGrid grid_over(uint zero, __global const uint *extent, uint bits) {
    AccelGrid grid;
    float sides[3];
    for (uint axis = 0u; axis < 3u; axis++) {
        const float low = as_float(unordered(~extent[axis])), high = as_float(unordered(extent[axis + 3u]));
        grid.low[axis] = mul(flush(low), SMALL);
        sides[axis] = sub(mul(flush(high), SMALL), grid.low[axis]);
    }
    grid.scale = unit_scale(max(max(sides[0], sides[1]), sides[2]));
    grid.bits = bits;
    return grid;
}

// 21 bits, with two zeros between any two of them.
static ulong spread(uint x) {
    ulong all = x;
    all = (all | all << 32) & 0x001f00000000ffffUL;
    all = (all | all << 16) & 0x001f0000ff0000ffUL;
    all = (all | all << 8) & 0x100f00f00f00f00fUL;
    all = (all | all << 4) & 0x10c30c30c30c30c3UL;
    return (all | all << 2) & 0x1249249249249249UL;
}

static uint cell(uint zero, const AccelGrid *grid, __global const Bounds *bounds, uint axis) {
    const float low = flush(bounds->low[axis]), high = flush(bounds->high[axis]);
    const float centre = add(mul(low, HALF_SMALL), mul(high, HALF_SMALL));
    const float place = mul(sub(centre, grid->low[axis]), grid->scale);
    const float cells = number((int)(1u << (grid->bits - 1u)));
    return lesser_of((uint)floor(mul(max(place, 0.0f), cells)), (1u << grid->bits) - 1u);
}

static ulong code_of(uint zero, const AccelGrid *grid, __global const Bounds *bounds) {
    return spread(cell(zero, grid, bounds, 0u)) << 2 | spread(cell(zero, grid, bounds, 1u)) << 1 |
           spread(cell(zero, grid, bounds, 2u));
}

__kernel __attribute__((reqd_work_group_size(GROUP, 1, 1)))
void stage_accel_codes(__global const AccelFrame *accel_frame, __global const Bounds *boxes, __global const uint *extent,
                       __global SortKey *keys) {
    const uint zero = accel_frame->zero, index = get_global_id(0);
    if (index < accel_frame->count) {
        const AccelGrid grid = grid_over(zero, extent, accel_frame->bits);
        const ulong code = code_of(zero, &grid, boxes + index);
        const SortKey key = {(uint)code, (uint)(code >> 32), index};
        keys[index] = key;
    }
}
