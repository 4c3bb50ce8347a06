// Mirrors core/src/patch/half.rs: sides that are halves of the sides of larger patches.

// The side of a patch of this kind on which a vertex lies, among those that are halves of others'; 4 if there is none.
fn joined_side(kind: u32, at: vec2<u32>) -> u32 {
    let is_there = vec4<bool>(at.y == 0u, at.y == PARAM_ONE, at.x == 0u, at.x == PARAM_ONE);
    let bits = select(vec4<u32>(0u), vec4<u32>(1u, 2u, 4u, 8u), is_there);
    let on = bits.x | bits.y | bits.z | bits.w;
    return firstTrailingBit((on & (kind >> KIND_HALF_SHIFT)) | 16u);
}

// Where the larger patch has the vertex that is at `at` on a side with this word.
fn joined_place(word: u32, side: u32, at: vec2<u32>) -> vec2<u32> {
    return place_on(word, select(at.y, at.x, side < 2u));
}

// Does a side of a surface lie on the same side of its patch?
fn is_outer(surface: Surface, side: u32) -> bool {
    let range = range_of(surface);
    return chosen(range.zwxy, side) == (side & 1u) * PARAM_ONE;
}

// Which of a patch's control points is number k of those of a side.
fn side_point(side: u32, k: u32) -> u32 {
    return select(12u * (side & 1u) + k, 3u * (side & 1u) + 4u * k, side < 2u);
}

// Control points of a piece of a line, in eye space.
struct Line {
    points: array<vec3<f32>, 4>,
}

// The piece from `low` to `high` along a side that is half of another's, given the side's word.
fn half_line(word: u32, object: u32, low: u32, high: u32) -> Line {
    let patch_id = (word >> OWNER_SHIFT) - 1u;
    let side = (word >> 1u) & 3u;
    let from_low = place_on(word, low);
    let to_high = place_on(word, high);
    let a = select(from_low.y, from_low.x, side < 2u);
    let b = select(to_high.y, to_high.x, side < 2u);
    let is_turned = a > b;
    var weights = blossom(select(a, b, is_turned), select(b, a, is_turned));
    var x: vec4<f32>;
    var y: vec4<f32>;
    var z: vec4<f32>;
    for (var k = 0u; k < 4u; k++) {
        let point = point_to_eye(object, control_point(patch_id, side_point(side, k)));
        x[k] = point.x;
        y[k] = point.y;
        z[k] = point.z;
    }
    var line: Line;
    for (var k = 0u; k < 4u; k++) {
        let row = weights.rows[k];
        line.points[k] = vec3<f32>(blend4(row, x), blend4(row, y), blend4(row, z));
    }
    return line;
}
