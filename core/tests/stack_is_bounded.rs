//! The bounded scheduler against an adversary that chooses every verdict: the stack never exceeds its
//! proven bound, and reaches it. The kernels `take`, `scan` and `split` are the real ones.

mod common;

use std::collections::HashSet;

use micropoly_core::abi::{CULL, Control, Limits, MAX_SPLITS, SPLIT_U, SPLIT_V, Slot, Surface, Verdict};
use micropoly_core::kernel::scan::scan;
use micropoly_core::kernel::split::{Outcome, split};
use micropoly_core::kernel::take::{flush, member, take};
use micropoly_core::memory::{stack_bound, stack_exact, stack_min};

/// A stack in the middle of a frame.
#[derive(Clone)]
struct Stack {
    roots: u32,
    surfaces: Vec<Surface>,
    control: Control,
}

/// Roots that have not been taken, and levels of the surfaces, bottom first: all that the future depends on.
type State = (u32, Vec<u32>);

impl Stack {
    fn new(n: u32, room: u32) -> Self {
        Self { roots: n, surfaces: vec![Surface::default(); room as usize], control: Control::default() }
    }

    fn state(&self) -> State {
        let surfaces = &self.surfaces[..self.control.stack as usize];
        (self.roots - self.control.next_root, surfaces.iter().map(|surface| surface.level()).collect())
    }

    fn is_done(&self) -> bool {
        self.state() == (0, Vec::new())
    }

    /// Runs one batch in which the surfaces picked by `chosen` are split, as far as `levels` allow.
    fn step(&mut self, p: u32, levels: u32, chosen: impl Fn(usize) -> bool) {
        let (patches, stack_room) = (self.roots, self.surfaces.len() as u32);
        let limits = Limits { patches, batch: p, stack_room, levels, ..Limits::default() };
        let control = take(flush(self.control), &limits, &self.surfaces);
        let batch: Vec<Surface> = (0..control.taken)
            .map(|item| member(&control, &self.surfaces, Surface::default(), item))
            .collect();
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
    let (mut seen, mut open) = (HashSet::from([first.state()]), vec![first]);
    let mut peak = 0;
    while let Some(stack) = open.pop() {
        let batch = largest_safe(&stack.state(), p, levels, room);
        assert!(batch > 0, "n {n}, p {p}, k {levels}, room {room}: nothing is safe on {:?}", stack.state());
        for pattern in 0..1_u32 << batch {
            let mut next = stack.clone();
            next.step(p, levels, |index| pattern >> index & 1 == 1);
            assert_eq!(
                next.control.taken,
                batch,
                "n {n}, p {p}, k {levels}, room {room}: {:?}",
                stack.state()
            );
            peak = peak.max(next.control.peak);
            if !next.is_done() && seen.insert(next.state()) {
                open.push(next);
            }
        }
    }
    peak
}

/// Number of surfaces of the largest batch whose splitting leaves every entry room to be worked off alone:
/// tried out one by one. Roots have no entry before they are split.
fn largest_safe((roots, stack): &State, p: u32, levels: u32, room: u32) -> u32 {
    let all = *roots as usize + stack.len();
    let is_safe = |batch: u32| {
        let below = stack.len().saturating_sub(batch as usize);
        let taken_roots = vec![0; (batch as usize).saturating_sub(stack.len())];
        let (below, top) = stack.split_at(below);
        let top = taken_roots.iter().chain(top);
        // Of the last level none is split.
        let children = top.filter(|&&level| level + 1 < levels).flat_map(|level| [level + 1; 2]);
        let after = below.iter().copied().chain(children);
        (0..).zip(after).all(|(index, level)| index + levels <= room + level)
    };
    (1..=p.min(all as u32)).rev().find(|&batch| is_safe(batch)).unwrap_or(0)
}

#[test]
fn any_room_is_enough_that_one_surface_at_a_time_needs() {
    let mut cases = 0;
    for levels in 1..=5 {
        for p in 1..=4 {
            for n in 1..=5 {
                let most = stack_exact(n.into(), p.into(), levels.into()) as u32;
                for room in stack_min(levels.into()) as u32..=most {
                    let peak = worst_within(n, p, levels, room);
                    assert!(peak <= room && (room < most || peak == most), "n {n}, p {p}, k {levels}");
                    cases += 1;
                }
            }
        }
    }
    assert_eq!(cases, 411);
}

#[test]
fn every_adversary_stays_within_the_bound_and_one_reaches_it() {
    let mut cases = 0;
    for levels in 1..=5 {
        for p in 1..=4 {
            for n in 1..=6 {
                let exact = stack_exact(n.into(), p.into(), levels.into());
                let bound = stack_bound(p.into(), levels.into());
                assert_eq!(u64::from(worst(n, p, levels)), exact, "n {n}, p {p}, k {levels}");
                assert!(exact <= bound);
                assert!(n < p || levels < 2 || exact == bound);
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
        assert!(levels < 2 || stack_min(levels.into()) <= stack_exact(n.into(), p.into(), levels.into()));
    }
}

#[test]
fn a_stack_that_is_too_small_is_reported_and_not_written() {
    let mut stack = Stack::new(2, 3);
    // As if the stack had room for the children, which the scan knows better.
    let limits = Limits { patches: 2, batch: 2, stack_room: 4, levels: 2, ..Limits::default() };
    let control = take(stack.control, &limits, &stack.surfaces);
    let verdicts = [Verdict { code: SPLIT_U, ..Verdict::default() }; 2];
    stack.control = scan(control, &verdicts, &mut [Slot::default(); 2], 3, 2);
    assert_eq!(stack.control.overflow, 1);
}
