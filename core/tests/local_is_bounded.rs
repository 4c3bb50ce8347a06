//! LOCAL against adversaries that choose every verdict: whatever groups have left and wherever it is dealt, no
//! group's stack overflows, every frame ends, and nobody has more to do than the others.

mod common;

use micropoly_core::abi::{
    CULL, Control, DRAW, Group, LOCAL_BATCH, Limits, MAX_SPLITS, SPLIT_U, SPLIT_V, Slot, Surface, Verdict,
};
use micropoly_core::kernel::balance::{balance, share, share_before};
use micropoly_core::kernel::deal::{dealt_to, rank, root};
use micropoly_core::kernel::scan::scan;
use micropoly_core::kernel::split::{Outcome, split};
use micropoly_core::kernel::take::take;
use micropoly_core::memory::stack_min;

/// All groups in the middle of a frame.
struct Frame {
    limits: Limits,
    control: Control,
    groups: Vec<Group>,
    stacks: Vec<Vec<Surface>>,
    /// How often a root was dealt, by patch.
    roots: Vec<u32>,
}

impl Frame {
    fn new(patches: u32, groups: u32, levels: u32, room: u32) -> Self {
        let (stack_room, draw_room) = (room, u32::MAX);
        Self {
            limits: Limits { patches, batch: 0, stack_room, draw_room, levels, groups },
            control: Control::default(),
            groups: vec![Group::default(); groups as usize],
            stacks: vec![Vec::new(); groups as usize],
            roots: vec![0; patches as usize],
        }
    }

    /// What `local` does, but for the verdicts.
    fn work(&mut self, mut chosen: impl FnMut(&Surface) -> u32) {
        for (group, stack) in self.groups.iter_mut().zip(&mut self.stacks) {
            let room = self.limits.stack_room;
            let limits = Limits { patches: 0, batch: LOCAL_BATCH, ..self.limits };
            let mut control = Control { stack: group.stack, peak: group.stack, ..Control::default() };
            stack.resize(room as usize, Surface::default());
            for _ in 0..group.batches {
                control = take(control, &limits, stack);
                let batch = stack[control.base as usize..][..control.taken as usize].to_vec();
                assert!(control.stack == 0 || !batch.is_empty(), "a standstill");
                let verdict = |surface| Verdict { code: chosen(surface), ..Verdict::default() };
                let verdicts: Vec<Verdict> = batch.iter().map(verdict).collect();
                let mut slots = vec![Slot::default(); batch.len()];
                control = scan(control, &verdicts, &mut slots, room, u32::MAX);
                assert_eq!(control.overflow, 0, "a group's stack overflows");
                for ((surface, verdict), slot) in batch.iter().zip(verdicts).zip(slots) {
                    if let Outcome::Split(place, halves) = split(&control, *surface, verdict, slot) {
                        stack[place as usize..][..2].copy_from_slice(&halves);
                    }
                }
            }
            stack.truncate(control.stack as usize);
            let load = group.load + control.processed;
            let Control { processed, peak, stack: held, waiting, fresh, .. } = control;
            *group = Group { held, draws: waiting + fresh, processed, peak, load, ..*group };
        }
    }

    fn deal(&mut self) {
        self.control = balance(self.control, &self.limits, &mut self.groups);
        let sizes = self.groups.iter().map(|group| vec![None; group.stack as usize]);
        let mut dealt: Vec<Vec<Option<Surface>>> = sizes.collect();
        for (group, stack) in self.stacks.iter().enumerate() {
            for (entry, surface) in (0..).zip(stack) {
                let (target, place) = dealt_to(&self.groups, rank(&self.groups, group as u32, entry));
                assert!(place - self.groups[target as usize].roots <= entry, "a surface moved up");
                let before = dealt[target as usize][place as usize].replace(*surface);
                assert_eq!(before, None, "two surfaces are dealt to one place");
            }
        }
        for (group, dealt) in self.groups.iter().zip(&mut dealt) {
            for entry in 0..group.roots {
                let root = root(&Control::default(), &[], group, entry);
                self.roots[root.patch_id as usize] += 1;
                dealt[entry as usize] = Some(root);
            }
        }
        let all = dealt.into_iter().map(|stack| stack.into_iter().map(|place| place.expect("a surface")));
        self.stacks = all.map(Iterator::collect).collect();
        self.assert_safe();
    }

    /// Every entry can be worked off alone, and every group has as much to do as any other.
    fn assert_safe(&self) {
        let Limits { levels, stack_room, .. } = self.limits;
        for stack in &self.stacks {
            let needed = (0..).zip(stack).map(|(entry, surface)| entry + levels - surface.level());
            assert!(needed.max().unwrap_or(0) <= stack_room, "a stack is not safe: {:?}", self.limits);
        }
        let sizes = || self.stacks.iter().map(Vec::len);
        assert!(sizes().max() <= sizes().min().map(|least| least + 2), "not dealt evenly");
    }

    fn is_done(&self) -> bool {
        self.control.stack == 0 && self.control.next_root == self.limits.patches
    }
}

#[test]
fn no_adversary_makes_a_group_overflow_and_every_frame_ends() {
    let mut random = common::random(5);
    for case in 0..200_u64 {
        let levels = random.u32(1..16);
        let least = stack_min(levels.into()) as u32;
        let room = [least, least + random.u32(0..6), random.u32(least..300)][case as usize % 3];
        let (patches, groups) = (random.u32(1..400), random.u32(1..12));
        let mut frame = Frame::new(patches, groups, levels, room);
        let (mut rounds, until) = (0, random.u32(1..60));
        frame.deal();
        while !frame.is_done() {
            // At first much is split, of some patches all; in the end nothing.
            let bias = if rounds < until { random.u8(0..=4) } else { 0 };
            frame.work(|surface| {
                let along = if surface.u_level() < MAX_SPLITS { SPLIT_U } else { SPLIT_V };
                let is_split = bias > 0 && surface.patch_id % 3 == 0 || random.u8(0..4) < bias;
                if is_split && surface.level() + 1 < levels {
                    along
                } else {
                    [CULL, DRAW][random.usize(0..2)]
                }
            });
            frame.deal();
            rounds += 1;
            assert!(rounds < 100_000, "no end: case {case}");
        }
        assert!(frame.roots.iter().all(|&dealt| dealt == 1), "a root was lost or dealt twice: case {case}");
        let load: u32 = frame.groups.iter().map(|group| group.load).sum();
        assert_eq!(load, frame.control.processed, "case {case}");
    }
}

#[test]
fn things_are_shared_out_evenly_and_none_is_left() {
    for players in 1..20 {
        for total in 0..100 {
            let mut before = 0;
            for index in 0..players {
                assert_eq!(share_before(total, index, players), before);
                let own = share(total, index, players);
                assert!(own == total / players || own == total.div_ceil(players));
                before += own;
            }
            assert_eq!(before, total);
        }
    }
}
