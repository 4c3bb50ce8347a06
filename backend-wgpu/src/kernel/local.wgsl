// Mirrors core/src/kernel/local.rs: a group works on a stack of its own, in local memory, for some batches. An
// invocation a surface of the batch.

@group(0) @binding(0) var<storage, read> frame: Frame;
@group(0) @binding(1) var<storage, read> objects: array<Object>;
@group(0) @binding(2) var<storage, read> patches: array<Patch>;
@group(0) @binding(3) var<storage, read> dealt: array<Surface>;
@group(0) @binding(4) var<storage, read_write> groups: array<Group>;
@group(0) @binding(5) var<storage, read_write> stack: array<Surface>;
@group(0) @binding(6) var<storage, read_write> fresh: array<Draw>;
@group(0) @binding(7) var<storage, read> patches_more: array<Patch>;

const_assert GROUP == LOCAL_BATCH;

var<workgroup> own_stack: array<Surface, LOCAL_STACK>;
// Surfaces split, drawn and depth-limited, and micropolygons.
var<workgroup> totals: array<vec4<u32>, LOCAL_BATCH>;
// What one invocation tells all others, in a way that keeps their loops together.
var<workgroup> group_shared: Group;
var<workgroup> control_shared: Control;

// Where the group's draws start.
var<private> FIRST_DRAW: u32;

@compute @workgroup_size(LOCAL_BATCH)
fn main(@builtin(workgroup_id) place: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    ZERO = frame.zero;
    let index = group_index(place);
    FIRST_DRAW = index * LOCAL_DRAWS;
    if lane == 0u {
        group_shared = group_at(index);
    }
    let group = workgroupUniformLoad(&group_shared);
    let first = index * group.room;
    for (var entry = lane; entry < group.stack; entry += LOCAL_BATCH) {
        own_stack[entry] = dealt[first + entry];
    }
    let limits = Limits(0u, LOCAL_BATCH, group.room, LOCAL_DRAWS, frame.levels, 1u);
    var control = Control();
    control.stack = group.stack;
    control.peak = group.stack;
    for (var batch = 0u; batch < group.batches && control.stack > 0u; batch++) {
        work_off(take(control, limits, lane), limits, lane);
        control = workgroupUniformLoad(&control_shared);
    }
    for (var entry = lane; entry < control.stack; entry += LOCAL_BATCH) {
        stack[first + entry] = own_stack[entry];
    }
    if lane == 0u && index < arrayLength(&groups) {
        groups[index] = after_round(group, control);
    }
}

// A group that has nothing to do where there are more groups than were asked for.
fn group_at(index: u32) -> Group {
    if index < arrayLength(&groups) {
        return groups[index];
    }
    return Group();
}

// Bounds and splits a batch.
fn work_off(control: Control, limits: Limits, lane: u32) {
    var surface = Surface();
    var verdict = Verdict(); // nothing becomes of it
    if lane < control.taken {
        surface = own_stack[control.base + lane];
        verdict = bound_any(surface);
    }
    totals[lane] = outputs(verdict);
    workgroupBarrier();
    let before = counts_before(lane);
    split(control, surface, verdict, Slot(before.x, before.y));
    if lane == LOCAL_BATCH - 1u {
        let counts = before + outputs(verdict);
        control_shared = commit(control, counts, limits.stack_room, limits.draw_room);
    }
}

fn level_at(entry: u32) -> u32 {
    return level(own_stack[entry]);
}

fn put_surface(place: u32, surface: Surface) {
    own_stack[place] = surface;
}

fn put_draw(place: u32, draw: Draw) {
    fresh[FIRST_DRAW + place] = draw;
}

fn after_round(before: Group, control: Control) -> Group {
    var group = before;
    group.held = control.stack;
    group.draws = control.waiting + control.fresh;
    group.processed = control.processed;
    group.culled = control.culled;
    group.limited = control.limited;
    group.micropolygons = control.micropolygons;
    group.peak = control.peak;
    group.load = before.load + control.processed;
    return group;
}
