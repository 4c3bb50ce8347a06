// Mirrors core/src/kernel/balance.rs: LOCAL's groups are counted, and told what each will have in its next round.
//
// One group; each invocation counts a run of neighbouring groups of LOCAL, the runs' totals are summed up, then
// each invocation arranges the next round of its run.

@group(0) @binding(0) var<storage, read> limits: Limits;
@group(0) @binding(1) var<storage, read_write> groups: array<Group>;
@group(0) @binding(2) var<storage, read_write> control: Control;

const RUNS: u32 = 256u;

// Counts of some groups together.
struct Totals {
    held: u32,
    draws: u32,
    processed: u32,
    culled: u32,
    limited: u32,
    micropolygons: u32,
    peak: u32,
}

var<workgroup> totals: array<Totals, RUNS>;

@compute @workgroup_size(RUNS)
fn main(@builtin(local_invocation_index) lane: u32) {
    let run = (limits.groups + RUNS - 1u) / RUNS;
    let first = umin(lane * run, limits.groups);
    let end = umin(first + run, limits.groups);
    var own = Totals();
    for (var index = first; index < end; index++) {
        own = together(own, totals_of(groups[index]));
    }
    totals[lane] = own;
    let before = control;
    workgroupBarrier();
    let after = counted(before, totals_before(RUNS));
    var draws_before = totals_before(lane).draws;
    for (var index = first; index < end; index++) {
        let group = groups[index];
        groups[index] = arranged(group, index, after, draws_before);
        draws_before += group.draws;
    }
    if lane == 0u {
        control = after;
    }
}

fn totals_of(group: Group) -> Totals {
    return Totals(
        group.held, group.draws, group.processed, group.culled, group.limited, group.micropolygons, group.peak);
}

fn together(a: Totals, b: Totals) -> Totals {
    return Totals(
        a.held + b.held, a.draws + b.draws, a.processed + b.processed,
        a.culled + b.culled, a.limited + b.limited, a.micropolygons + b.micropolygons,
        a.peak + b.peak,
    );
}

fn totals_before(lane: u32) -> Totals {
    var sum = Totals();
    for (var run = 0u; run < lane; run++) {
        sum = together(sum, totals[run]);
    }
    return sum;
}

fn share(total: u32, index: u32, players: u32) -> u32 {
    return (total + players - 1u - index) / players;
}

fn share_before(total: u32, index: u32, players: u32) -> u32 {
    return index * (total / players) + umin(index, total % players);
}

fn roots_given(held: u32, waiting: u32) -> u32 {
    let dealt = share(held, 0u, limits.groups);
    let wanted = saturating_sub(LOCAL_BATCH, dealt);
    let room = saturating_sub(limits.stack_room + 1u, limits.levels + dealt);
    return umin(waiting, umin(wanted, room) * limits.groups);
}

fn batches(surfaces: u32) -> u32 {
    let width = LOCAL_BATCH * limits.groups;
    let full = (surfaces + width - 1u) / width;
    return select(umin(full, LOCAL_BATCHES), 1u, full < 1u);
}

fn counted(before: Control, all: Totals) -> Control {
    let roots = roots_given(all.held, limits.patches - before.next_root);
    let waiting = before.waiting + before.fresh;
    var after = before;
    after.stack = all.held + roots;
    after.taken = all.processed;
    after.roots = roots;
    after.base = 0u;
    after.next_root = before.next_root + roots;
    after.waiting = waiting;
    after.fresh = all.draws;
    after.peak = select(before.peak, all.peak, all.peak > before.peak);
    after.processed = before.processed + all.processed;
    after.culled = before.culled + all.culled;
    after.drawn = before.drawn + all.draws;
    after.limited = before.limited + all.limited;
    after.micropolygons = before.micropolygons + all.micropolygons;
    after.overflow = saturating_sub(waiting + all.draws, limits.draw_room);
    return after;
}

fn arranged(before: Group, index: u32, after: Control, draws_before: u32) -> Group {
    let roots = share(after.roots, index, limits.groups);
    let first_root = after.next_root - after.roots + share_before(after.roots, index, limits.groups);
    var group = before;
    group.stack = share(after.stack - after.roots, index, limits.groups) + roots;
    group.roots = roots;
    group.next_root = first_root + roots;
    group.batches = batches(after.stack);
    group.room = limits.stack_room;
    group.first_draw = draws_before;
    group.load = select(before.load, 0u, after.next_root == after.roots);
    return group;
}
