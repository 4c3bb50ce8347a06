// Mirrors core/src/accel/bsp/plane.rs (`BspPlane::is_before`): which planes the eye is before. An invocation a plane.

@group(0) @binding(0) var<storage, read> bsp_frame: BspFrame;
@group(0) @binding(1) var<storage, read> planes: array<BspPlane>;
@group(0) @binding(2) var<storage, read_write> is_before: array<u32>;

@compute @workgroup_size(ITEM_GROUP)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let item = item_index(group, lane);
    if item < bsp_frame.planes {
        is_before[item] = select(0u, 1u, is_before_plane(planes[item], bsp_frame.eye));
    }
}

fn wide(a: i32) -> Wide {
    return Wide(u32(a), u32(a >> 31u));
}

fn sum_of(words: array<i32, 3>, eye: array<i32, 3>) -> Wide {
    let both = wide_add(wide_mul(words[0], eye[0]), wide_mul(words[1], eye[1]));
    return wide_add(both, wide_mul(words[2], eye[2]));
}

fn is_before_plane(plane: BspPlane, eye: array<i32, 3>) -> bool {
    let low = wide_sub(sum_of(plane.low, eye), wide(plane.offset_low));
    let own = wide_sub(sum_of(plane.high, eye), wide(plane.offset_high));
    let sign = wide_sign(wide_add(own, wide(i32(low.high))));
    return sign > 0 || (sign == 0 && low.low != 0u);
}
