// Mirrors core/src/patch/half.rs: sides that are halves of larger patches' sides. All that lies on such a side is found on
// the large patch's curve.

// Bits of a patch's kind that tell of halves, one a side.
#define ALL_SIDES 15u

// Is this side one half of another patch's?
static bool is_half(__global const Patch *patch, uint side) {
    return (patch->kind >> (KIND_HALF_SHIFT + side) & 1u) != 0u;
}

static bool has_halves(__global const Patch *patch) {
    return (patch->kind >> KIND_HALF_SHIFT & ALL_SIDES) != 0u;
}

// Does a parameter lie on a side of its patch?
static bool lies_on(uint side, uint2 at) {
    return (side < 2u ? at.y : at.x) == (side % 2u) * PARAM_ONE;
}

// Where a vertex is evaluated: on the patch of which its side is half, as source of a grid 1 + the side; or on source 0,
// its own.
static Owner joined_of(__global const Patch *patch, uint2 at) {
    for (uint side = 0u; side < 4u; side++) {
        if (is_half(patch, side) && lies_on(side, at)) {
            return new_owner(1u + side, place_on(patch->owners[side], side < 2u ? at.x : at.y));
        }
    }
    return new_owner(0u, at);
}

// Does a side of a surface lie on the same side of its patch?
static bool is_outer(Surface surface, uint side) {
    return lies_on(side, on_side(surface, side, 0u));
}

// Eye-space position of a vertex of a Bézier patch, given its net in eye space.
static float3 joined_position(uint zero, __global const Patch *patches, __global const Object *object,
                              __global const Patch *patch, const Net *net, uint2 at) {
    const Owner owner = joined_of(patch, at);
    if (owner.slot == 0u) {
        return position_at(zero, net, at);
    }
    Net large;
    in_eye_space(zero, patches + patch_in(patch->owners[owner.slot - 1u], 0u), object, &large);
    return position_at(zero, &large, owner.at);
}

// Control point `k` of a side; `SIDE_POINTS` in core.
static uint side_point(uint side, uint k) {
    return side < 2u ? 4u * k + 3u * side : k + 12u * (side - 2u);
}

// Control points of the piece from `low` to `high` along a side that is half of another's, given the side's word;
// `half_line` in core.
static void line_of_half(uint zero, __global const Patch *patches, __global const Object *object, uint word, uint low,
                         uint high, float3 *line) {
    __global const Patch *large = patches + patch_in(word, 0u);
    const Transform to_eye = to_eye_of(object);
    const uint side = (word >> 1) & 3u;
    const uint2 from = place_on(word, low), to = place_on(word, high);
    const uint a = side < 2u ? from.x : from.y, b = side < 2u ? to.x : to.y;
    float4 weights[4], x, y, z;
    blossom(zero, lesser_of(a, b), greater_of(a, b), weights);
    for (uint k = 0u; k < 4u; k++) {
        const uint l = side_point(side, k);
        x[k] = transformed(zero, large, to_eye.x, l);
        y[k] = transformed(zero, large, to_eye.y, l);
        z[k] = transformed(zero, large, to_eye.z, l);
    }
    for (uint k = 0u; k < 4u; k++) {
        line[k] = (float3)(blend4(zero, weights[k], x), blend4(zero, weights[k], y), blend4(zero, weights[k], z));
    }
}
