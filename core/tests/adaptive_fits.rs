//! The adaptive batch against adversaries that choose every verdict: in any capacity from `stack_min` upward
//! no stack overflows, every frame ends, and no larger batch would have been safe.

mod common;

use std::collections::HashSet;

use micropoly_core::memory::{stack_exact, stack_min};
use micropoly_core::schedule::adaptive::{Batch, next};

/// One frame's sizes.
#[derive(Clone, Copy, Debug)]
struct Case {
    n: u32,
    batch: u32,
    levels: u32,
    capacity: u32,
}

/// Roots that have not been taken, and the levels on the stack, bottom first.
type State = (u32, Vec<u32>);

impl Case {
    fn start(self) -> State {
        (self.n, Vec::new())
    }

    fn exact(self) -> u32 {
        stack_exact(self.n.into(), self.batch.into(), self.levels.into()) as u32
    }

    fn next(self, (roots, stack): &State) -> Batch {
        next(stack.len() as u32, *roots, self.batch, self.levels, self.capacity, |entry| {
            stack[entry as usize]
        })
    }

    fn taken(self, state: &State) -> u32 {
        let Batch { base, roots } = self.next(state);
        state.1.len() as u32 - base + roots
    }

    /// Entry + levels - level, for every entry at or above `from`.
    fn is_safe(self, stack: &[u32], from: usize) -> bool {
        let needed = |entry: usize| entry as u32 + self.levels - stack[entry];
        (from..stack.len()).all(|entry| needed(entry) <= self.capacity)
    }

    /// What is left after a batch of which `chosen` ones are split, as far as levels allow.
    fn split(self, (roots, stack): &State, batch: Batch, chosen: impl Fn(usize) -> bool) -> State {
        let base = batch.base as usize;
        let mut after = stack[..base].to_vec();
        let taken = (0..batch.roots).map(|_| 0).chain(stack[base..].iter().copied());
        for (index, level) in taken.enumerate() {
            if level + 1 < self.levels && chosen(index) {
                after.extend([level + 1; 2]);
            }
        }
        (roots - batch.roots, after)
    }

    /// The same batch by trying all of them, the largest first; the stack must be safe.
    fn next_by_trying(self, state: &State) -> Batch {
        let (roots, held) = (state.0, state.1.len() as u32);
        let first = held.saturating_sub(self.batch);
        let spare = self.batch.saturating_sub(held).min(roots);
        let with_roots = (1..=spare).rev().map(|roots| Batch { base: 0, roots });
        let without = (first..=held).map(|base| Batch { base, roots: 0 });
        let safe = |batch: &Batch| self.is_safe(&self.split(state, *batch, |_| true).1, batch.base as usize);
        with_roots.chain(without).find(safe).expect("no batch is always safe")
    }

    /// Surfaces that can still be processed.
    fn weight(self, (roots, stack): &State) -> u64 {
        let tree = |level: u32| (1_u64 << (self.levels - level)) - 1;
        u64::from(*roots) * tree(0) + stack.iter().map(|level| tree(*level)).sum::<u64>()
    }

    /// Runs a batch; `chosen` are split.
    fn step(self, state: &State, chosen: impl Fn(usize) -> bool) -> State {
        let batch = self.next(state);
        assert_eq!(batch, self.next_by_trying(state), "{self:?} {state:?}");
        let taken = self.taken(state);
        assert!(taken > 0, "nothing is taken: {self:?} {state:?}");
        let after = self.split(state, batch, chosen);
        assert!(after.1.len() as u32 <= self.capacity, "overflow: {self:?} {state:?}");
        assert!(self.weight(&after) + u64::from(taken) <= self.weight(state), "no end: {self:?} {state:?}");
        after
    }
}

fn is_done(state: &State) -> bool {
    *state == (0, Vec::new())
}

/// Visits every state that any sequence of verdicts leads to, and returns how many there are.
fn visit_all(case: Case) -> usize {
    let (mut seen, mut open) = (HashSet::from([case.start()]), vec![case.start()]);
    while let Some(state) = open.pop() {
        let taken = case.taken(&state);
        if case.capacity >= case.exact() {
            let all = state.0 + state.1.len() as u32;
            assert_eq!(taken, all.min(case.batch), "narrow without need: {case:?}");
        }
        for pattern in 0..1_u32 << taken {
            let after = case.step(&state, |index| pattern >> index & 1 == 1);
            if !is_done(&after) && seen.insert(after.clone()) {
                open.push(after);
            }
        }
    }
    seen.len()
}

#[test]
fn no_adversary_of_small_stacks_causes_an_overflow_or_a_standstill() {
    let (mut cases, mut states) = (0, 0);
    for levels in 1..=4 {
        for batch in 1..=4 {
            for n in 1..=5 {
                let least = stack_min(levels.into()) as u32;
                let most = least.max(stack_exact(n.into(), batch.into(), levels.into()) as u32);
                for capacity in least..=most + 1 {
                    states += visit_all(Case { n, batch, levels, capacity });
                    cases += 1;
                }
            }
        }
    }
    assert!(cases > 300 && states > 10_000, "{cases} cases, {states} states");
}

/// Every sorted stack of up to `length` entries.
fn sorted_stacks(length: usize, levels: u32) -> Vec<Vec<u32>> {
    let (mut all, mut from) = (vec![Vec::new()], 0);
    for _ in 0..length {
        let until = all.len();
        for index in from..until {
            for level in all[index].last().copied().unwrap_or(0)..levels {
                let mut longer: Vec<u32> = all[index].clone();
                longer.push(level);
                all.push(longer);
            }
        }
        from = until;
    }
    all
}

#[test]
fn the_batch_is_the_largest_safe_one_of_every_small_stack() {
    let mut compared = 0;
    for levels in 1..=4 {
        for stack in sorted_stacks(7, levels) {
            for batch in 1..=8 {
                for (capacity, n) in (levels..=18).flat_map(|capacity| [0, 1, 3, 9].map(|n| (capacity, n))) {
                    let case = Case { n, batch, levels, capacity };
                    if case.is_safe(&stack, 0) {
                        let state = (n, stack.clone());
                        assert_eq!(case.next(&state), case.next_by_trying(&state), "{case:?} {state:?}");
                        compared += 1;
                    }
                }
            }
        }
    }
    assert!(compared > 10_000, "{compared}");
}

#[test]
fn greedy_and_random_adversaries_of_large_stacks_find_no_overflow_and_no_standstill() {
    const ROUNDS: u64 = 300;
    let mut random = common::random(31);
    for round in 0..160 {
        let (n, batch, levels) = (random.u32(1..200), random.u32(1..64), random.u32(1..24));
        let least = stack_min(levels.into()) as u32;
        let most = least.max(stack_exact(n.into(), batch.into(), levels.into()) as u32);
        let capacity = [least, least + random.u32(0..8), random.u32(least..=most), most][round / 4 % 4];
        let case = Case { n, batch, levels, capacity };
        let (mut state, mut peak, mut time) = (case.start(), 0, 0);
        while !is_done(&state) {
            // Splits all, the lower half, the upper half or some of the batch, and in the end nothing.
            let half = case.taken(&state) as usize / 2;
            let seed = random.u64(..);
            let some =
                |index: usize| fastrand::Rng::with_seed(seed ^ index as u64).u64(0..4) <= time / 16 % 4;
            let chosen =
                |index: usize| time < ROUNDS && [true, index <= half, index >= half, some(index)][round % 4];
            state = case.step(&state, chosen);
            peak = peak.max(state.1.len() as u32);
            time += 1;
        }
        // Where all is split, no order of the surfaces needs less.
        assert!(round % 4 != 0 || levels < 2 || peak >= least, "{case:?}");
    }
}

#[test]
fn the_largest_numbers_do_not_wrap() {
    let base = |stack, batch, level| next(stack, 0, batch, 41, u32::MAX, |_| level).base;
    assert_eq!(base(0, u32::MAX, 0), 0);
    assert_eq!(base(u32::MAX - 40, 1, 0), u32::MAX - 41);
    // Room for one surface at a time, and for three.
    assert_eq!(base(u32::MAX - 40, 1 << 24, 0), u32::MAX - 41);
    assert_eq!(base(u32::MAX - 42, 1 << 24, 0), u32::MAX - 45);
    // Never split, so there is always room.
    assert_eq!(base(u32::MAX, 1 << 24, 40), u32::MAX - (1 << 24));
    assert_eq!(next(0, u32::MAX, 1 << 24, 41, u32::MAX, |_| 0), Batch { base: 0, roots: 1 << 24 });
    assert_eq!(next(0, u32::MAX, 1 << 24, 1, 1, |_| 0), Batch { base: 0, roots: 1 << 24 });
}
