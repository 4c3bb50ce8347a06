// Mirrors core/src/kernel/seam_gregory.rs: as `seam.cl`, but the curves inside a patch are not those of one net.

INLINED bool is_inside(__local const Grid *grid, Border border) {
    return grid->is_gregory && border.at != 0u && border.at != PARAM_ONE;
}

// The curve of the net that the patch has where the parameter that runs along a border is `t`.
INLINED void curve_at(__constant Frame *frame, __local const Grid *grid, Border border, uint t, float4 *curve) {
    const uint zero = frame->zero;
    const uint2 place = place_on(border, t);
    const float u = param(zero, place.x), v = param(zero, place.y);
    const float4 share = (float4)(blend_here(frame, 0u, u, v).x, blend_here(frame, 1u, u, v).x,
                                  blend_here(frame, 2u, u, v).x, blend_here(frame, 3u, u, v).x);
    for (uint k = 0u; k < 3u; k++) {
        __local const float *c = coordinate(grid->net, k);
        const float4 inside = inner_points(zero, grid->faces + 8u * k, share);
        curve[k] = border_curve(zero, border, vload4(0, c), (float4)(c[4], inside.x, inside.y, c[7]),
                                (float4)(c[8], inside.z, inside.w, c[11]), vload4(3, c));
    }
}

// From the row that the blends at the low end give to that of the high end, one coordinate.
static float4 follow_row(uint zero, float4 low, float4 high) {
    return (float4)(low.x, between(zero, low.y, high.y, THIRD), between(zero, low.z, high.z, mul(2.0f, THIRD)),
                    high.w);
}

// Control points along a border of the net that follows the blends.
static void followed(__constant Frame *frame, __local const Grid *grid, Border border, float4 *part) {
    const uint zero = frame->zero;
    float4 curve[3], low[3], high[3];
    curve_at(frame, grid, border, border.start, curve);
    part_of(zero, border, curve, low);
    curve_at(frame, grid, border, border.start + border.size, curve);
    part_of(zero, border, curve, high);
    for (uint k = 0u; k < 3u; k++) {
        part[k] = follow_row(zero, low[k], high[k]);
    }
}

// The longest chord in steps of the border: that of the largest ancestor that may be drawn.
static uint longest_inside(__constant Frame *frame, __local const Grid *grid, Border border) {
    float4 part[3];
    uint longest = 1u;
    for (uint size = 2u * border.size; size <= PARAM_ONE; size *= 2u) {
        followed(frame, grid, ancestor(border, size), part);
        if (is_short(frame, part)) {
            longest = size / border.size;
        }
    }
    return longest;
}

// Is this end of a chord near enough to its middle?
static bool is_in_reach(__constant Frame *frame, float3 middle, float3 end) {
    const uint zero = frame->zero;
    const float3 here = perspective(frame, middle), there = perspective(frame, end);
    const float away = max(abs(sub(there.x, here.x)), abs(sub(there.y, here.y)));
    return away <= mul(frame->bound, SEAM_ALLOWANCE);
}

// Are both ends of the chord beyond a border near enough to its middle?
static bool are_in_reach(__constant Frame *frame, __local const Grid *grid, Border border,
                         __local const float3 *chord) {
    if (!is_inside(grid, border)) {
        return true;
    }
    const float3 middle = position_any(frame, grid, place_on(border, border.start + border.size));
    return is_in_reach(frame, middle, chord[0]) && is_in_reach(frame, middle, chord[1]);
}

static uint longest_any(__constant Frame *frame, __local const Grid *grid, Border border) {
    return is_inside(grid, border) ? longest_inside(frame, grid, border)
                                   : longest_chord(frame, grid->net, border);
}

// The seam along one of the borders v = low, v = high, u = low and u = high.
static void put_seam(__constant Frame *frame, __local Grid *grid, Surface surface, uint number) {
    __local Seam *seam = grid->seams + number;
    const Border border = border_of(surface, number);
    const uint end = border.start + border.size;
    seam->longest = longest_any(frame, grid, border);
    const uint half_chord = chord_beyond(frame, border, seam->longest);
    seam->has_chord = 0u;
    if (half_chord != 0u) {
        seam->chord[0] = position_any(frame, grid, place_on(border, end - half_chord));
        seam->chord[1] = position_any(frame, grid, place_on(border, end + half_chord));
        seam->has_chord = are_in_reach(frame, grid, border, seam->chord);
    }
}
