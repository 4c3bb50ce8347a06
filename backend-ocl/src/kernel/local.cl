// Mirrors core/src/kernel/local.rs: a group works on a stack of its own, in local memory. It is a work-group; each
// of its work-items has a surface of the batch.

// A group's own memory. Surfaces are plain numbers, in the order of their fields, and apart from their borders.
typedef struct {
    uint4 stack[LOCAL_STACK];
    uint4 borders[LOCAL_STACK];
    Counts counts[GROUP];
    uint base;
} LocalMemory;

static void put_surface(__local LocalMemory *memory, uint entry, Surface surface) {
    memory->stack[entry] = (uint4)(surface.patch_id, surface.u, surface.v, surface.shape);
    memory->borders[entry] =
        (uint4)(surface.borders[0], surface.borders[1], surface.borders[2], surface.borders[3]);
}

static Surface surface_at(__local const LocalMemory *memory, uint entry) {
    const uint4 numbers = memory->stack[entry], borders = memory->borders[entry];
    const Surface surface = {numbers.x, numbers.y, numbers.z, numbers.w,
                             {borders.x, borders.y, borders.z, borders.w}};
    return surface;
}

// Base of the next batch of a stack of `count` surfaces; `next` in core/src/schedule/adaptive.rs, without roots.
static uint next_base(__local LocalMemory *memory, uint count, uint levels, uint capacity, uint lane) {
    const uint first = saturating_sub(count, LOCAL_BATCH), entry = first + lane;
    if (entry == first) {
        memory->base = first;
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    if (!is_safe(count, count - first, levels, capacity) && entry < count) {
        atomic_max(&memory->base, lowest(entry, level(surface_at(memory, entry)), levels, capacity));
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    return memory->base;
}

// Carries out the verdict on a surface, after those `before` it; `split` for a stack in local memory.
static void split_local(__local LocalMemory *memory, __global Draw *draws, Control control, Surface surface,
                        Verdict verdict, Counts before) {
    const Counts own = counted(verdict);
    if (own.x != 0u) {
        const Halves halves = halves_of(surface, verdict);
        put_surface(memory, control.base + 2u * before.x, halves.low);
        put_surface(memory, control.base + 2u * before.x + 1u, halves.high);
    } else if (own.y != 0u) {
        draws[control.waiting + before.y] = new_draw(surface, verdict);
    }
}

static void report(__global Group *group, Control control) {
    group->held = control.stack;
    group->draws = control.waiting + control.fresh;
    group->processed = control.processed;
    group->culled = control.culled;
    group->limited = control.limited;
    group->micropolygons = control.micropolygons;
    group->peak = control.peak;
    group->load += control.processed;
}

__kernel __attribute__((reqd_work_group_size(GROUP, 1, 1)))
void stage_local(__constant Frame *frame, __global const Object *objects, __global const Patch *patches,
                 __global const Surface *dealt, __global Group *groups, __global Surface *stack,
                 __global Draw *fresh) {
    __local LocalMemory memory;
    const uint lane = get_local_id(0), index = get_group_id(0);
    const uint room = groups[index].room, batches = groups[index].batches, held = groups[index].stack;
    Control control = {0u};
    control.stack = held;
    control.peak = held;
    for (uint entry = lane; entry < held; entry += GROUP) {
        put_surface(&memory, entry, dealt[index * room + entry]);
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    for (uint batch = 0u; batch < batches && control.stack > 0u; batch++) {
        control = take(control, next_base(&memory, control.stack, frame->levels, room, lane), 0u);
        const bool is_one = lane < control.taken;
        // Where there is no surface, one all the same: compilers may load first and branch later.
        const Surface surface = surface_at(&memory, control.base + (is_one ? lane : 0u));
        Verdict verdict = {CULL, 0u, 0u, 0u, 0u};
        if (is_one) {
            verdict = bound_any(frame, objects, patches, surface);
        }
        memory.counts[lane] = counted(verdict);
        barrier(CLK_LOCAL_MEM_FENCE);
        control = commit(control, sum(memory.counts, GROUP), room, LOCAL_DRAWS);
        split_local(&memory, fresh + index * LOCAL_DRAWS, control, surface, verdict,
                    sum(memory.counts, lane));
        barrier(CLK_LOCAL_MEM_FENCE);
    }
    for (uint entry = lane; entry < control.stack; entry += GROUP) {
        stack[index * room + entry] = surface_at(&memory, entry);
    }
    if (lane == 0u) {
        report(groups + index, control);
    }
}
