//! Inputs for the stages of LOCAL: stacks of all sizes that are safe for their room, unequal loads, roots left and
//! none left.

use micropoly_core::abi::{
    Control, Draw, Group, LOCAL_BATCHES, LOCAL_DRAWS, LOCAL_STACK, Limits, MAX_RATE, MAX_SPLITS, PARAM_ONE,
    Surface,
};
use micropoly_core::kernel::balance;
use micropoly_core::stage::Items;

use super::scenes::{PATCHES, scene};
use super::{Parts, control, descendant, empty, words};

/// One of some numbers.
fn one_of<const N: usize>(random: &mut fastrand::Rng, numbers: [u32; N]) -> u32 {
    numbers[random.usize(0..N)]
}

fn group(random: &mut fastrand::Rng) -> Group {
    let mut any = || random.u32(0..100_000);
    Group {
        stack: any(),
        roots: any(),
        next_root: any(),
        batches: any(),
        room: any(),
        held: any(),
        draws: any(),
        first_draw: any(),
        processed: any(),
        culled: any(),
        limited: any(),
        micropolygons: any(),
        peak: any(),
        load: any(),
    }
}

/// A surface of this level, anywhere.
fn surface_of_level(random: &mut fastrand::Rng, level: u32) -> Surface {
    let along_u = random.u32(level.saturating_sub(MAX_SPLITS)..=level.min(MAX_SPLITS));
    let mut start = |level: u32| random.u32(0..1 << level) * (PARAM_ONE >> level);
    let at = [start(along_u), start(level - along_u)];
    let patch_id = random.u32(0..PATCHES);
    descendant(random, patch_id, at, [along_u, level - along_u], MAX_RATE)
}

/// A stack of so many surfaces, of any levels at which it is safe.
fn safe_stack(random: &mut fastrand::Rng, count: u32, room: u32, levels: u32) -> Vec<Surface> {
    let shallow = random.bool();
    (0..count)
        .map(|entry| {
            let least = (entry + levels).saturating_sub(room).min(levels - 1);
            let most = if shallow { least } else { levels - 1 };
            let level = random.u32(least..=most);
            surface_of_level(random, level)
        })
        .collect()
}

pub(super) fn local(random: &mut fastrand::Rng) -> Parts {
    let (frame, objects, patches) = scene(random);
    let most = one_of(random, [frame.levels + 8, 150, LOCAL_STACK]);
    let room = random.u32(frame.levels..=most);
    let count = random.usize(1..6);
    let (mut groups, mut dealt) = (Vec::new(), Vec::new());
    for _ in 0..count {
        let stack = random.u32(0..=room);
        let batches = random.u32(0..=LOCAL_BATCHES);
        groups.push(Group { stack, batches, room, ..group(random) });
        dealt.extend(safe_stack(random, stack, room, frame.levels));
        dealt.resize(groups.len() * room as usize, Surface::default());
    }
    let buffers = vec![
        words(&[frame]),
        words(&objects),
        words(&patches),
        words(&dealt),
        words(&groups),
        empty::<Surface>(dealt.len()),
        empty::<Draw>(count * LOCAL_DRAWS as usize),
    ];
    (Items::Groups(count as u32), buffers)
}

/// Groups after a round, as unequal as they can get.
fn worked_off(random: &mut fastrand::Rng, room: u32) -> Vec<Group> {
    let most = one_of(random, [3, 40, 700]);
    let count = random.u32(1..most);
    let (most_held, most_drawn) = (random.u32(0..=room), random.u32(0..=LOCAL_DRAWS));
    (0..count)
        .map(|_| {
            let busy = random.bool();
            let mut some = |most: u32| if busy { random.u32(0..=most) } else { 0 };
            let (held, draws) = (some(most_held), some(most_drawn));
            Group { room, held, draws, ..group(random) }
        })
        .collect()
}

/// Groups after a round, the counts before it, and limits.
fn round(random: &mut fastrand::Rng) -> (Control, Limits, Vec<Group>) {
    let levels = random.u32(2..=41);
    let most = one_of(random, [levels + 8, LOCAL_STACK]);
    let room = random.u32(levels..=most);
    let groups = worked_off(random, room);
    let next_root = if random.bool() { 0 } else { random.u32(0..5000) };
    let most = one_of(random, [1, 100, 100_000]);
    let patches = next_root + random.u32(0..most);
    let most = one_of(random, [2000, 1_000_000]);
    let draw_room = random.u32(500..most);
    let (stack_room, count) = (room, groups.len() as u32);
    let limits = Limits { patches, batch: 0, stack_room, draw_room, levels, groups: count };
    (Control { next_root, waiting: random.u32(0..500), ..control(random) }, limits, groups)
}

pub(super) fn balance(random: &mut fastrand::Rng) -> Parts {
    let (control, limits, groups) = round(random);
    (Items::Count(1), vec![words(&[limits]), words(&groups), words(&[control])])
}

pub(super) fn deal(random: &mut fastrand::Rng) -> Parts {
    let (control, limits, mut groups) = round(random);
    groups.truncate(150); // more would only take longer
    let count = groups.len();
    let full = random.u8(0..8) == 0;
    let draw_room = if full { 0 } else { u32::MAX };
    let limits = Limits { groups: count as u32, draw_room, ..limits };
    let control = Control { waiting: random.u32(0..500), fresh: 0, ..control };
    let control = balance::balance(control, &limits, &mut groups);
    let roots: Vec<u32> = (0..control.next_root.max(1)).map(|_| random.u32(..)).collect();
    let entries = count * limits.stack_room as usize;
    let stack = (0..entries).map(|_| surface_of_level(random, 9)).collect::<Vec<_>>();
    let draw = |patch_id| Draw { patch_id, u: 1, v: 2, shape: 3, borders: [6, 7, 8, 9], columns: 4, rows: 5 };
    let fresh: Vec<Draw> = (0..(count * LOCAL_DRAWS as usize) as u32).map(draw).collect();
    let buffers = vec![
        words(&[control]),
        roots,
        words(&groups),
        words(&stack),
        words(&fresh),
        empty::<Surface>(entries),
        empty::<Draw>((control.waiting + control.fresh).max(1) as usize),
    ];
    (Items::Groups(count as u32), buffers)
}
