//! The adaptive batch against adversaries that choose every verdict: in any capacity from `stack_min` upward
//! no stack overflows, every frame ends, and no larger batch would have been safe.

mod common;

use std::collections::HashSet;

use micropoly_core::memory::{stack_exact, stack_min};
use micropoly_core::schedule::adaptive::base;

/// One frame's sizes.
#[derive(Clone, Copy, Debug)]
struct Case {
    n: u32,
    batch: u32,
    levels: u32,
    capacity: u32,
}

impl Case {
    fn roots(self) -> Vec<u32> {
        vec![0; self.n as usize]
    }

    fn exact(self) -> u32 {
        stack_exact(self.n.into(), self.batch.into(), self.levels.into()) as u32
    }

    fn base(self, stack: &[u32]) -> usize {
        base(stack.len() as u32, self.batch, self.levels, self.capacity, |entry| stack[entry as usize])
            as usize
    }

    /// Entry + levels - level, for every entry at or above `from`.
    fn is_safe(self, stack: &[u32], from: usize) -> bool {
        let needed = |entry: usize| entry as u32 + self.levels - stack[entry];
        (from..stack.len()).all(|entry| needed(entry) <= self.capacity)
    }

    /// The levels, bottom first, after a batch of which `chosen` ones are split, as far as levels allow.
    fn split(self, stack: &[u32], base: usize, chosen: impl Fn(usize) -> bool) -> Vec<u32> {
        let mut after = stack[..base].to_vec();
        for (index, level) in stack[base..].iter().enumerate() {
            if level + 1 < self.levels && chosen(index) {
                after.extend([level + 1; 2]);
            }
        }
        after
    }

    /// The same base by trying all of them; the stack must be safe.
    fn base_by_trying(self, stack: &[u32]) -> usize {
        let safe = |base: &usize| self.is_safe(&self.split(stack, *base, |_| true), *base);
        let first = stack.len().saturating_sub(self.batch as usize);
        (first..=stack.len()).find(safe).expect("no batch is always safe")
    }

    /// Surfaces that can still be processed.
    fn weight(self, stack: &[u32]) -> u64 {
        stack.iter().map(|level| (1_u64 << (self.levels - level)) - 1).sum()
    }

    /// Runs a batch; `chosen` are split.
    fn step(self, stack: &[u32], chosen: impl Fn(usize) -> bool) -> Vec<u32> {
        let base = self.base(stack);
        assert_eq!(base, self.base_by_trying(stack), "{self:?} {stack:?}");
        assert!(base < stack.len(), "nothing is taken: {self:?} {stack:?}");
        let after = self.split(stack, base, chosen);
        assert!(after.len() as u32 <= self.capacity, "overflow: {self:?} {stack:?}");
        let taken = (stack.len() - base) as u64;
        assert!(self.weight(&after) + taken <= self.weight(stack), "no end: {self:?} {stack:?}");
        after
    }
}

/// Visits every stack that any sequence of verdicts leads to, and returns how many there are.
fn visit_all(case: Case) -> usize {
    let (mut seen, mut open) = (HashSet::from([case.roots()]), vec![case.roots()]);
    while let Some(stack) = open.pop() {
        let taken = stack.len() - case.base(&stack);
        if case.capacity >= case.exact() {
            assert_eq!(taken, stack.len().min(case.batch as usize), "narrow without need: {case:?}");
        }
        for pattern in 0..1_u32 << taken {
            let after = case.step(&stack, |index| pattern >> index & 1 == 1);
            if !after.is_empty() && seen.insert(after.clone()) {
                open.push(after);
            }
        }
    }
    seen.len()
}

#[test]
fn no_adversary_of_small_stacks_causes_an_overflow_or_a_standstill() {
    let (mut cases, mut stacks) = (0, 0);
    for levels in 1..=4 {
        for batch in 1..=4 {
            for n in 1..=5 {
                let least = stack_min(n.into(), levels.into()) as u32;
                let most = stack_exact(n.into(), batch.into(), levels.into()) as u32;
                for capacity in least..=most + 1 {
                    stacks += visit_all(Case { n, batch, levels, capacity });
                    cases += 1;
                }
            }
        }
    }
    assert!(cases > 300 && stacks > 10_000, "{cases} cases, {stacks} stacks");
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
fn the_base_is_the_smallest_safe_one_of_every_small_stack() {
    let mut compared = 0;
    for levels in 1..=4 {
        for stack in sorted_stacks(7, levels) {
            for batch in 1..=8 {
                for capacity in 0..=18 {
                    let case = Case { n: 0, batch, levels, capacity };
                    if case.is_safe(&stack, 0) {
                        assert_eq!(case.base(&stack), case.base_by_trying(&stack), "{case:?} {stack:?}");
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
        let least = stack_min(n.into(), levels.into()) as u32;
        let most = stack_exact(n.into(), batch.into(), levels.into()) as u32;
        let capacity = [least, least + random.u32(0..8), random.u32(least..=most), most][round / 4 % 4];
        let case = Case { n, batch, levels, capacity };
        let (mut stack, mut peak, mut time) = (case.roots(), n, 0);
        while !stack.is_empty() {
            // Splits all, the lower half, the upper half or some of the batch, and in the end nothing.
            let half = (stack.len() - case.base(&stack)) / 2;
            let seed = random.u64(..);
            let some =
                |index: usize| fastrand::Rng::with_seed(seed ^ index as u64).u64(0..4) <= time / 16 % 4;
            let chosen =
                |index: usize| time < ROUNDS && [true, index <= half, index >= half, some(index)][round % 4];
            stack = case.step(&stack, chosen);
            peak = peak.max(stack.len() as u32);
            time += 1;
        }
        // Where all is split, no order of the surfaces needs less.
        assert!(round % 4 != 0 || peak >= least, "{case:?}");
    }
}

#[test]
fn the_largest_numbers_do_not_wrap() {
    assert_eq!(base(0, u32::MAX, 41, u32::MAX, |_| 0), 0);
    assert_eq!(base(u32::MAX - 40, 1, 41, u32::MAX, |_| 0), u32::MAX - 41);
    // Room for one surface at a time, and for three.
    assert_eq!(base(u32::MAX - 40, 1 << 24, 41, u32::MAX, |_| 0), u32::MAX - 41);
    assert_eq!(base(u32::MAX - 42, 1 << 24, 41, u32::MAX, |_| 0), u32::MAX - 45);
    // Never split, so there is always room.
    assert_eq!(base(u32::MAX, 1 << 24, 41, u32::MAX, |_| 40), u32::MAX - (1 << 24));
}
