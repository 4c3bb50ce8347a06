//! The bounded scheduler against an adversary that chooses every verdict: the stack never exceeds its
//! proven bound, and reaches it. The kernels `take`, `scan` and `split` are the real ones.

mod common;

use std::collections::HashSet;

use micropoly_core::abi::{CULL, Control, Limits, MAX_SPLITS, SPLIT_U, SPLIT_V, Slot, Surface, Verdict};
use micropoly_core::kernel::scan::scan;
use micropoly_core::kernel::seed::{seed, start};
use micropoly_core::kernel::split::{Outcome, split};
use micropoly_core::kernel::take::{flush, take};
use micropoly_core::memory::{stack_bound, stack_exact, stack_min};

/// A stack in the middle of a frame.
#[derive(Clone)]
struct Stack {
    surfaces: Vec<Surface>,
    control: Control,
}

impl Stack {
    fn new(n: u32, room: u32) -> Self {
        let mut surfaces = vec![Surface::default(); room as usize];
        for (position, surface) in surfaces[..n as usize].iter_mut().enumerate() {
            *surface = seed(position as u32, n);
        }
        Self { surfaces, control: start(n) }
    }

    /// Levels of the surfaces, bottom first: all that the future depends on.
    fn levels(&self) -> Vec<u32> {
        self.surfaces[..self.control.stack as usize].iter().map(|surface| surface.level()).collect()
    }

    /// Runs one batch in which the surfaces picked by `chosen` are split, as far as `levels` allow.
    fn step(&mut self, p: u32, levels: u32, chosen: impl Fn(usize) -> bool) {
        let limits = Limits { batch: p, stack_room: self.surfaces.len() as u32, levels, ..Limits::default() };
        let control = take(flush(self.control), &limits, &self.surfaces);
        let batch: Vec<Surface> = self.surfaces[control.base as usize..][..control.taken as usize].to_vec();
        let verdict = |(index, surface): (usize, &Surface)| {
            let axis = if surface.u_level() < MAX_SPLITS { SPLIT_U } else { SPLIT_V };
            let code = if chosen(index) && surface.level() + 1 < levels { axis } else { CULL };
            Verdict { code, ..Verdict::default() }
        };
        let verdicts: Vec<Verdict> = batch.iter().enumerate().map(verdict).collect();
        let mut slots = vec![Slot::default(); batch.len()];
        self.control = scan(control, &verdicts, &mut slots, self.surfaces.len() as u32, p);
        assert_eq!(self.control.overflow, 0, "the stack overflows");
        for index in 0..batch.len() {
            if let Outcome::Split(place, halves) =
                split(&control, batch[index], verdicts[index], slots[index])
            {
                self.surfaces[place as usize..][..2].copy_from_slice(&halves);
            }
        }
    }
}

/// The largest stack that any sequence of verdicts leads to.
fn worst(n: u32, p: u32, levels: u32) -> u32 {
    worst_within(n, p, levels, stack_exact(n.into(), p.into(), levels.into()) as u32)
}

/// The same for a stack with so much room; a batch is never empty, and the largest that is safe.
fn worst_within(n: u32, p: u32, levels: u32, room: u32) -> u32 {
    let first = Stack::new(n, room);
    let (mut seen, mut open) = (HashSet::from([first.levels()]), vec![first]);
    let mut peak = n;
    while let Some(stack) = open.pop() {
        let batch = largest_safe(&stack.levels(), p, levels, room);
        assert!(batch > 0, "n {n}, p {p}, k {levels}, room {room}: nothing is safe on {:?}", stack.levels());
        for pattern in 0..1_u32 << batch {
            let mut next = stack.clone();
            next.step(p, levels, |index| pattern >> index & 1 == 1);
            assert_eq!(
                next.control.taken,
                batch,
                "n {n}, p {p}, k {levels}, room {room}: {:?}",
                stack.levels()
            );
            peak = peak.max(next.control.peak);
            if next.control.stack > 0 && seen.insert(next.levels()) {
                open.push(next);
            }
        }
    }
    peak
}

/// Number of surfaces of the largest batch whose splitting leaves every entry room to be worked off alone:
/// tried out one by one.
fn largest_safe(stack: &[u32], p: u32, levels: u32, room: u32) -> u32 {
    let is_safe = |batch: u32| {
        let (below, top) = stack.split_at(stack.len() - batch as usize);
        // Of the last level none is split.
        let children = top.iter().filter(|&&level| level + 1 < levels).flat_map(|level| [level + 1; 2]);
        let after = below.iter().copied().chain(children);
        (0..).zip(after).all(|(index, level)| index + levels <= room + level)
    };
    (1..=p.min(stack.len() as u32)).rev().find(|&batch| is_safe(batch)).unwrap_or(0)
}

#[test]
fn any_room_is_enough_that_one_surface_at_a_time_needs() {
    let mut cases = 0;
    for levels in 1..=5 {
        for p in 1..=4 {
            for n in 1..=5 {
                let most = stack_exact(n.into(), p.into(), levels.into()) as u32;
                for room in stack_min(n.into(), levels.into()) as u32..=most {
                    let peak = worst_within(n, p, levels, room);
                    assert!(peak <= room && (room < most || peak == most), "n {n}, p {p}, k {levels}");
                    cases += 1;
                }
            }
        }
    }
    assert_eq!(cases, 351);
}

#[test]
fn every_adversary_stays_within_the_bound_and_one_reaches_it() {
    let mut cases = 0;
    for levels in 1..=5 {
        for p in 1..=4 {
            for n in 1..=6 {
                let (exact, bound) = (
                    stack_exact(n.into(), p.into(), levels.into()),
                    stack_bound(n.into(), p.into(), levels.into()),
                );
                assert_eq!(u64::from(worst(n, p, levels)), exact, "n {n}, p {p}, k {levels}");
                assert!(exact <= bound);
                assert!(n < p || exact == bound);
                cases += 1;
            }
        }
    }
    assert_eq!(cases, 120);
}

#[test]
fn splitting_everything_reaches_the_bound_of_large_stacks() {
    for (n, p, levels) in [(32, 64, 23), (1000, 256, 16), (1, 1, 41), (7, 100, 41), (5000, 4096, 23)] {
        let room = stack_exact(n.into(), p.into(), levels.into()) as u32;
        let mut stack = Stack::new(n, room);
        for _ in 0..2 * levels + n / p {
            stack.step(p, levels, |_| true);
        }
        assert_eq!(stack.control.peak, room, "n {n}, p {p}, k {levels}");
    }
}

#[test]
fn random_adversaries_stay_within_the_bound_of_large_stacks() {
    let mut random = common::random(20);
    for _ in 0..40 {
        let (n, p, levels) = (random.u32(1..200), random.u32(1..64), random.u32(1..24));
        let mut stack = Stack::new(n, stack_exact(n.into(), p.into(), levels.into()) as u32);
        let seed = random.u64(..);
        for round in 0..400_u64 {
            // A bias that changes slowly, so that whole batches are split now and then.
            let bias = (round / 16 % 4) as u8;
            let choice =
                |index: usize| fastrand::Rng::with_seed(seed ^ round << 20 ^ index as u64).u8(0..4) <= bias;
            stack.step(p, levels, choice);
        }
        assert!(u64::from(stack.control.peak) <= stack_exact(n.into(), p.into(), levels.into()));
        assert!(stack_min(n.into(), levels.into()) <= stack_exact(n.into(), p.into(), levels.into()));
    }
}

#[test]
fn a_stack_that_is_too_small_is_reported_and_not_written() {
    let mut stack = Stack::new(2, 3);
    // As if the stack had room for the children, which the scan knows better.
    let limits = Limits { batch: 2, stack_room: 4, levels: 2, ..Limits::default() };
    let control = take(stack.control, &limits, &stack.surfaces);
    let verdicts = [Verdict { code: SPLIT_U, ..Verdict::default() }; 2];
    stack.control = scan(control, &verdicts, &mut [Slot::default(); 2], 3, 2);
    assert_eq!(stack.control.overflow, 1);
}
