// Mirrors core/src/accel/extent.rs: the box about all primitives. An invocation a primitive; a group finds its own extent before
// it tells of it.

@group(0) @binding(0) var<storage, read> accel_frame: AccelFrame;
@group(0) @binding(1) var<storage, read> boxes: array<Bounds>;
@group(0) @binding(2) var<storage, read_write> extent: array<atomic<u32>>;

var<workgroup> own: array<atomic<u32>, 6>;

@compute @workgroup_size(ITEM_GROUP)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let item = item_index(group, lane);
    if lane < 6u {
        atomicStore(&own[lane], 0u);
    }
    workgroupBarrier();
    if item < accel_frame.count {
        for (var word = 0u; word < 6u; word++) {
            let number = ordered(bounds_word(item, word));
            atomicMax(&own[word], select(number, ~number, word < 3u));
        }
    }
    workgroupBarrier();
    if lane < 6u {
        atomicMax(&extent[lane], atomicLoad(&own[lane]));
    }
}
