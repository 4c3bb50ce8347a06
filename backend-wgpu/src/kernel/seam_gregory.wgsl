// Mirrors core/src/kernel/seam_gregory.rs: as `seam.wgsl`, but the curves inside a patch are not those of one net.

fn is_inside(border: Border) -> bool {
    return record != 0u && border.at != 0u && border.at != PARAM_ONE;
}

fn longest_any(border: Border) -> u32 {
    if is_inside(border) {
        return longest_inside(border);
    }
    return longest_chord(border);
}

// The longest chord in steps of the border: that of the largest ancestor that may be drawn.
fn longest_inside(border: Border) -> u32 {
    var longest = 1u;
    for (var size = 2u * border.size; size <= PARAM_ONE; size *= 2u) {
        if is_short(followed(ancestor(border, size))) {
            longest = size / border.size;
        }
    }
    return longest;
}

// Control points along a border of the net that follows the blends.
fn followed(border: Border) -> Curve {
    let low = part_of(border, curve_at(border, border.start));
    let high = part_of(border, curve_at(border, border.start + border.size));
    return Curve(follow_row(low.x, high.x), follow_row(low.y, high.y), follow_row(low.z, high.z));
}

// From the row that the blends at the low end give to that of the high end, one coordinate.
fn follow_row(low: vec4<f32>, high: vec4<f32>) -> vec4<f32> {
    return vec4<f32>(
        low.x, between(low.y, high.y, THIRD), between(low.z, high.z, mul(2.0, THIRD)), high.w);
}

// The curve of the net that the patch has where the parameter that runs along a border is `t`.
fn curve_at(border: Border, t: u32) -> Curve {
    let u = param(select(border.at, t, border.along_u));
    let v = param(select(t, border.at, border.along_u));
    let shares = vec4<f32>(
        blend_here(0u, u, v).share,
        blend_here(1u, u, v).share,
        blend_here(2u, u, v).share,
        blend_here(3u, u, v).share,
    );
    return Curve(
        coordinate_at(border, 0u, shares), coordinate_at(border, 1u, shares), coordinate_at(border, 2u, shares));
}

fn coordinate_at(border: Border, k: u32, shares: vec4<f32>) -> vec4<f32> {
    let weights = cubic(param(border.at));
    let row1 = row_at(k, 1u, shares.x, shares.y);
    let row2 = row_at(k, 2u, shares.z, shares.w);
    if border.along_u {
        return blend_rows(weights, net_row(k, 0u), row1, row2, net_row(k, 3u));
    }
    return blend_columns(weights, net_row(k, 0u), row1, row2, net_row(k, 3u));
}

// Are both ends of the chord beyond a border near enough to its middle?
fn are_in_reach(border: Border, low: vec3<f32>, high: vec3<f32>) -> bool {
    if !is_inside(border) {
        return true;
    }
    let middle = chord_point(border, border.start + border.size);
    return is_in_reach(middle, low) && is_in_reach(middle, high);
}

fn is_in_reach(middle: vec3<f32>, end: vec3<f32>) -> bool {
    let here = perspective(middle);
    let there = perspective(end);
    let away = max(abs(sub(there.x, here.x)), abs(sub(there.y, here.y)));
    return away <= mul(frame.bound, SEAM_ALLOWANCE);
}
