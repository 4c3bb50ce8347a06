// Mirrors core/src/accel/sort.rs (`count`): how many keys of a block have which digit. A group a block.

@group(0) @binding(0) var<storage, read> accel_frame: AccelFrame;
@group(0) @binding(1) var<storage, read> keys: array<SortKey>;
@group(0) @binding(2) var<storage, read_write> counts: array<u32>;

@compute @workgroup_size(ITEM_GROUP)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let block = group_index(group);
    count_run(block, lane);
    workgroupBarrier();
    if lane < SORT_DIGITS && block * SORT_BLOCK < accel_frame.count {
        var all = 0u;
        for (var run = 0u; run < ITEM_GROUP; run++) {
            all += runs[lane * ITEM_GROUP + run];
        }
        counts[count_place(lane, block)] = all;
    }
}
