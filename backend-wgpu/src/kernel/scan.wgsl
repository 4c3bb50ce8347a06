// Mirrors core/src/kernel/scan.rs: count, prefix sum, places.
//
// One group; each invocation counts a run of neighbouring surfaces, the runs' totals are summed up, then
// each invocation gives out the places of its run.

@group(0) @binding(0) var<storage, read> limits: Limits;
@group(0) @binding(1) var<storage, read> verdicts: array<Verdict>;
@group(0) @binding(2) var<storage, read_write> slots: array<Slot>;
@group(0) @binding(3) var<storage, read_write> control: Control;

const RUNS: u32 = 256u;

// Surfaces split, drawn and depth-limited.
var<workgroup> totals: array<vec3<u32>, RUNS>;

@compute @workgroup_size(RUNS)
fn main(@builtin(local_invocation_index) lane: u32) {
    let taken = control.taken;
    let run = (taken + RUNS - 1u) / RUNS;
    let first = umin(lane * run, taken);
    let end = umin(first + run, taken);
    var counts = vec3<u32>(0u, 0u, 0u);
    for (var item = first; item < end; item++) {
        counts += outputs(verdicts[item].code);
    }
    totals[lane] = counts;
    workgroupBarrier();
    var before = counts_before(lane);
    for (var item = first; item < end; item++) {
        slots[item] = Slot(before.x, before.y);
        before += outputs(verdicts[item].code);
    }
    workgroupBarrier();
    if lane == RUNS - 1u {
        control = commit(control, before);
    }
}

fn outputs(code: u32) -> vec3<u32> {
    switch code {
        case CULL: {
            return vec3<u32>(0u, 0u, 0u);
        }
        case DRAW: {
            return vec3<u32>(0u, 1u, 0u);
        }
        case DRAW_LIMITED: {
            return vec3<u32>(0u, 1u, 1u);
        }
        default: {
            return vec3<u32>(1u, 0u, 0u);
        }
    }
}

fn counts_before(lane: u32) -> vec3<u32> {
    var sum = vec3<u32>(0u, 0u, 0u);
    for (var run = 0u; run < lane; run++) {
        sum += totals[run];
    }
    return sum;
}

// The counts after a batch with these totals of surfaces split, drawn and limited.
fn commit(before: Control, counts: vec3<u32>) -> Control {
    let splits = counts.x;
    let draws = counts.y;
    var after = before;
    after.stack = before.base + 2u * splits;
    let excess_stack = saturating_sub(after.stack, limits.stack_room);
    let excess_draws = saturating_sub(before.waiting + draws, limits.draw_room);
    after.peak = select(before.peak, after.stack, after.stack > before.peak);
    after.fresh = draws;
    after.processed = before.processed + before.taken;
    after.culled = before.culled + before.taken - draws - splits;
    after.drawn = before.drawn + draws;
    after.limited = before.limited + counts.z;
    after.overflow = select(excess_draws, excess_stack, excess_stack > excess_draws);
    return after;
}
