// Mirrors core/src/kernel/scan.rs (scan): scan for the batch in flight.
//
// One group; each invocation counts a run of neighbouring surfaces, the runs' totals are summed up, then
// each invocation gives out the places of its run.

@group(0) @binding(0) var<storage, read> limits: Limits;
@group(0) @binding(1) var<storage, read> verdicts: array<Verdict>;
@group(0) @binding(2) var<storage, read_write> slots: array<Slot>;
@group(0) @binding(3) var<storage, read_write> control: Control;

const RUNS: u32 = 256u;

// Surfaces split, drawn and depth-limited, and micropolygons.
var<workgroup> totals: array<vec4<u32>, RUNS>;

@compute @workgroup_size(RUNS)
fn main(@builtin(local_invocation_index) lane: u32) {
    let taken = control.taken;
    let run = (taken + RUNS - 1u) / RUNS;
    let first = umin(lane * run, taken);
    let end = umin(first + run, taken);
    var counts = vec4<u32>(0u, 0u, 0u, 0u);
    for (var item = first; item < end; item++) {
        counts += outputs(verdicts[item]);
    }
    totals[lane] = counts;
    workgroupBarrier();
    var before = counts_before(lane);
    for (var item = first; item < end; item++) {
        slots[item] = Slot(before.x, before.y);
        before += outputs(verdicts[item]);
    }
    workgroupBarrier();
    if lane == RUNS - 1u {
        control = commit(control, before, limits.stack_room, limits.draw_room);
    }
}
