// Mirrors core/src/accel/sort.rs (`scatter`): keys to their places. A group a block; those of a run come behind those of the
// runs before, so that equal digits stay in order.

@group(0) @binding(0) var<storage, read> accel_frame: AccelFrame;
@group(0) @binding(1) var<storage, read> keys: array<SortKey>;
@group(0) @binding(2) var<storage, read> counts: array<u32>;
@group(0) @binding(3) var<storage, read_write> sorted: array<SortKey>;

@compute @workgroup_size(ITEM_GROUP)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let block = group_index(group);
    count_run(block, lane);
    workgroupBarrier();
    if lane < SORT_DIGITS && block * SORT_BLOCK < accel_frame.count {
        var before = counts[count_place(lane, block)];
        for (var run = 0u; run < ITEM_GROUP; run++) {
            let here = runs[lane * ITEM_GROUP + run];
            runs[lane * ITEM_GROUP + run] = before;
            before += here;
        }
    }
    workgroupBarrier();
    let end = run_start(block, lane + 1u);
    for (var index = run_start(block, lane); index < end; index++) {
        let place = digit_of(index) * ITEM_GROUP + lane;
        sorted[runs[place]] = keys[index];
        runs[place] += 1u;
    }
}
