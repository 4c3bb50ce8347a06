// Mirrors core/src/kernel/scan.rs: count, prefix sum, places. Kernels have an array `totals`: how many surfaces of
// each run of the batch are split, drawn and depth-limited, and the micropolygons of those drawn.

// The same of one surface.
fn outputs(verdict: Verdict) -> vec4<u32> {
    let rates = rates_of(verdict);
    switch verdict.code {
        case CULL: {
            return vec4<u32>(0u, 0u, 0u, 0u);
        }
        case DRAW: {
            return vec4<u32>(0u, 1u, 0u, rates.x * rates.y);
        }
        case DRAW_LIMITED: {
            return vec4<u32>(0u, 1u, 1u, rates.x * rates.y);
        }
        default: {
            return vec4<u32>(1u, 0u, 0u, 0u);
        }
    }
}

// Of all runs before one.
fn counts_before(lane: u32) -> vec4<u32> {
    var sum = vec4<u32>(0u, 0u, 0u, 0u);
    for (var run = 0u; run < lane; run++) {
        sum += totals[run];
    }
    return sum;
}

// The counts after a batch with these totals.
fn commit(before: Control, counts: vec4<u32>, stack_room: u32, draw_room: u32) -> Control {
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
    after.micropolygons = before.micropolygons + counts.w;
    after.overflow = select(excess_draws, excess_stack, excess_stack > excess_draws);
    return after;
}
