// Mirrors core/src/kernel/scan.rs: count, prefix sum, places. Kernels have an array `totals`: how many surfaces of
// each run of the batch are split, drawn and depth-limited.

// Is a surface split, drawn, depth-limited?
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

// Of all runs before one.
fn counts_before(lane: u32) -> vec3<u32> {
    var sum = vec3<u32>(0u, 0u, 0u);
    for (var run = 0u; run < lane; run++) {
        sum += totals[run];
    }
    return sum;
}

// The counts after a batch with these totals of surfaces split, drawn and limited.
fn commit(before: Control, counts: vec3<u32>, stack_room: u32, draw_room: u32) -> Control {
    let splits = counts.x;
    let draws = counts.y;
    var after = before;
    after.stack = before.base + 2u * splits;
    let excess_stack = saturating_sub(after.stack, stack_room);
    let excess_draws = saturating_sub(before.waiting + draws, draw_room);
    after.peak = select(before.peak, after.stack, after.stack > before.peak);
    after.fresh = draws;
    after.processed = before.processed + before.taken;
    after.culled = before.culled + before.taken - draws - splits;
    after.drawn = before.drawn + draws;
    after.limited = before.limited + counts.z;
    after.overflow = select(excess_draws, excess_stack, excess_stack > excess_draws);
    return after;
}
