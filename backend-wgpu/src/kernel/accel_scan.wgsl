// Mirrors core/src/accel/sort.rs (`scan`): sums of the counts before each. One group; each invocation has an unbroken run of them.

@group(0) @binding(0) var<storage, read> accel_frame: AccelFrame;
@group(0) @binding(1) var<storage, read_write> counts: array<u32>;

const RUNS: u32 = 256u;

var<workgroup> sums: array<u32, RUNS>;

@compute @workgroup_size(RUNS)
fn main(@builtin(local_invocation_index) lane: u32) {
    let count = accel_frame.counts;
    let run = (count + RUNS - 1u) / RUNS;
    let first = umin(lane * run, count);
    let end = umin(first + run, count);
    var own = 0u;
    for (var index = first; index < end; index++) {
        own += counts[index];
    }
    sums[lane] = own;
    workgroupBarrier();
    var before = 0u;
    for (var earlier = 0u; earlier < lane; earlier++) {
        before += sums[earlier];
    }
    for (var index = first; index < end; index++) {
        let here = counts[index];
        counts[index] = before;
        before += here;
    }
    if lane == RUNS - 1u {
        counts[count] = before;
    }
}
