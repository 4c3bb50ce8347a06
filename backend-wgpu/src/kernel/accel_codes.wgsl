// Mirrors core/src/accel/morton.rs: where the centre of each primitive's box is on the curve. An invocation a primitive.
//
// Codes have more bits than integers have here: ten bits of each axis are interleaved at a time.

@group(0) @binding(0) var<storage, read> accel_frame: AccelFrame;
@group(0) @binding(1) var<storage, read> boxes: array<Bounds>;
@group(0) @binding(2) var<storage, read> extent: array<u32>;
@group(0) @binding(3) var<storage, read_write> keys: array<SortKey>;

// Centres are halved so often that no difference of them can exceed the range of floats.
const SMALL: f32 = 0.03125;
const HALF_SMALL: f32 = 0.015625;

@compute @workgroup_size(ITEM_GROUP)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    ZERO = accel_frame.zero;
    let item = item_index(group, lane);
    if item < accel_frame.count {
        let scale = grid_scale();
        let code = interleaved(vec3<u32>(cell(item, scale, 0u), cell(item, scale, 1u), cell(item, scale, 2u)));
        keys[item] = SortKey(code.x, code.y, item);
    }
}

fn grid_low(axis: u32) -> f32 {
    return mul(flush(bitcast<f32>(unordered(~extent[axis]))), SMALL);
}

fn grid_side(axis: u32) -> f32 {
    return sub(mul(flush(bitcast<f32>(unordered(extent[axis + 3u]))), SMALL), grid_low(axis));
}

// The largest side becomes 1 to 2.
fn grid_scale() -> f32 {
    return unit_scale(max(max(grid_side(0u), grid_side(1u)), grid_side(2u)));
}

fn cell(index: u32, scale: f32, axis: u32) -> u32 {
    let low = flush(boxes[index].low[axis]);
    let high = flush(boxes[index].high[axis]);
    let centre = add(mul(low, HALF_SMALL), mul(high, HALF_SMALL));
    let place = mul(sub(centre, grid_low(axis)), scale);
    let cells = float(i32(1u << (accel_frame.bits - 1u)));
    return umin(u32(floor(mul(max(place, 0.0), cells))), (1u << accel_frame.bits) - 1u);
}

// Ten bits, with two zeros between any two of them.
fn spread(x: u32) -> u32 {
    var all = (x | (x << 16u)) & 0x030000ffu;
    all = (all | (all << 8u)) & 0x0300f00fu;
    all = (all | (all << 4u)) & 0x030c30c3u;
    return (all | (all << 2u)) & 0x09249249u;
}

fn interleaved_ten(cells: vec3<u32>) -> u32 {
    let ten = cells & vec3<u32>(1023u);
    return (spread(ten.x) << 2u) | (spread(ten.y) << 1u) | spread(ten.z);
}

// Lower bits of a code, and upper ones.
fn interleaved(cells: vec3<u32>) -> vec2<u32> {
    let lower = interleaved_ten(cells);
    let upper = interleaved_ten(cells >> vec3<u32>(10u));
    let last = cells >> vec3<u32>(20u);
    let top = (last.x << 2u) | (last.y << 1u) | last.z;
    return vec2<u32>(lower | (upper << 30u), (upper >> 2u) | (top << 28u));
}
