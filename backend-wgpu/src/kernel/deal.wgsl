// Mirrors core/src/kernel/deal.rs: all surfaces that LOCAL's groups have left are dealt out anew, the lowest of all
// stacks first; draws go to the draw buffer.
//
// One group a group of LOCAL; each invocation deals a run of neighbouring entries of its stack. Groups that hold as
// many surfaces are counted together, so that nobody goes through all groups for every entry.

@group(0) @binding(0) var<storage, read> control: Control;
@group(0) @binding(1) var<storage, read> roots: array<u32>;
@group(0) @binding(2) var<storage, read> groups: array<Group>;
@group(0) @binding(3) var<storage, read> stack: array<Surface>;
@group(0) @binding(4) var<storage, read> fresh: array<Draw>;
@group(0) @binding(5) var<storage, read_write> dealt: array<Surface>;
@group(0) @binding(6) var<storage, read_write> draws: array<Draw>;

const GROUP: u32 = LOCAL_BATCH;
const RUN: u32 = LOCAL_STACK / GROUP;

// How many groups, and how many of them before this one, hold one surface, two, three …
var<workgroup> holders: array<atomic<u32>, LOCAL_STACK>;
var<workgroup> holders_before: array<atomic<u32>, LOCAL_STACK>;
// What the groups hold that are counted in a run, how many these are, and how many of them are before this one.
var<workgroup> totals: array<vec3<u32>, GROUP>;

@compute @workgroup_size(GROUP)
fn main(@builtin(workgroup_id) place: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let index = group_index(place);
    if control.overflow > 0u || index >= arrayLength(&groups) {
        return;
    }
    for (var bin = lane; bin < LOCAL_STACK; bin += GROUP) {
        atomicStore(&holders[bin], 0u);
        atomicStore(&holders_before[bin], 0u);
    }
    workgroupBarrier();
    count_groups(index, lane);
    workgroupBarrier();
    totals[lane] = totals_of(lane * RUN);
    workgroupBarrier();
    deal_run(index, lane);
    put_roots(index, lane);
    put_draws(index, lane);
}

fn count_groups(index: u32, lane: u32) {
    for (var other = lane; other < arrayLength(&groups); other += GROUP) {
        let held = groups[other].held;
        if held > 0u {
            atomicAdd(&holders[held - 1u], 1u);
            if other < index {
                atomicAdd(&holders_before[held - 1u], 1u);
            }
        }
    }
}

fn totals_of(first: u32) -> vec3<u32> {
    var sum = vec3<u32>(0u, 0u, 0u);
    for (var bin = first; bin < first + RUN; bin++) {
        let count = atomicLoad(&holders[bin]);
        sum += vec3<u32>(count * (bin + 1u), count, atomicLoad(&holders_before[bin]));
    }
    return sum;
}

// Deals the entries of a run. The rank of the first is the number of all surfaces that lie lower, and of those that
// lie as low in a group before this one.
fn deal_run(index: u32, lane: u32) {
    let first = lane * RUN;
    // Of groups that hold no more than the entry has below it, and of all others, which have as many there.
    var lower = sums(0u, lane).x;
    var higher = sums(lane, GROUP).yz;
    for (var entry = first; entry < first + RUN; entry++) {
        if entry < groups[index].held {
            deal(index, entry, lower + entry * higher.x + higher.y);
        }
        let count = atomicLoad(&holders[entry]);
        lower += count * (entry + 1u);
        higher -= vec2<u32>(count, atomicLoad(&holders_before[entry]));
    }
}

fn sums(first: u32, end: u32) -> vec3<u32> {
    var sum = vec3<u32>(0u, 0u, 0u);
    for (var run = first; run < end; run++) {
        sum += totals[run];
    }
    return sum;
}

// Mirrors dealt_to: the surface goes to another group, above its roots.
fn deal(index: u32, entry: u32, rank: u32) {
    let players = arrayLength(&groups);
    let target_group = rank % players;
    let target_entry = rank / players + groups[target_group].roots;
    dealt[place_of(target_group, target_entry)] = stack[place_of(index, entry)];
}

// Where an entry of a group's stack lies.
fn place_of(index: u32, entry: u32) -> u32 {
    return index * groups[index].room + entry;
}

// No group is given more roots than a batch.
fn put_roots(index: u32, lane: u32) {
    if lane < groups[index].roots {
        dealt[place_of(index, lane)] = root(patch_of(groups[index].next_root - 1u - lane));
    }
}

// Mirrors core/src/kernel/take.rs (patch_of).
fn patch_of(number: u32) -> u32 {
    if control.listed == 0u {
        return number;
    }
    return roots[number];
}

fn put_draws(index: u32, lane: u32) {
    let first = control.waiting + groups[index].first_draw;
    for (var item = lane; item < groups[index].draws; item += GROUP) {
        draws[first + item] = fresh[index * LOCAL_DRAWS + item];
    }
}
