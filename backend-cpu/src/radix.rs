//! Codes in order, on all threads: each sorts a run digit by digit (least significant first), and runs are merged.

/// A code, and whose it is.
pub(crate) type Key = (u64, u32);

/// Bits of a digit.
const DIGIT_BITS: u32 = 11;
const DIGITS: usize = 1 << DIGIT_BITS;
/// Fewer keys than this are one thread's.
const FEW: usize = 1 << 13;

/// Sorts by code, of which the lower `bits` count; equal ones stay in order.
pub(crate) fn sorted(mut keys: Vec<Key>, bits: u32) -> Vec<Key> {
    let passes = bits.div_ceil(DIGIT_BITS);
    let runs = rayon::current_num_threads().min(keys.len() / FEW).max(1);
    let merges = runs.next_power_of_two().ilog2();
    let mut spare = bytemuck::zeroed_vec(keys.len());
    sort_runs(&mut keys, &mut spare, passes, merges);
    // Each pass, and each merge, goes from one buffer to the other.
    if (passes + merges).is_multiple_of(2) { keys } else { spare }
}

/// Sorts `2^merges` runs and merges them.
fn sort_runs(keys: &mut [Key], spare: &mut [Key], passes: u32, merges: u32) {
    if merges == 0 {
        return sort_run(keys, spare, passes);
    }
    let middle = keys.len() / 2;
    let ((a, b), (spare_a, spare_b)) = (keys.split_at_mut(middle), spare.split_at_mut(middle));
    rayon::join(|| sort_runs(a, spare_a, passes, merges - 1), || sort_runs(b, spare_b, passes, merges - 1));
    if (passes + merges - 1).is_multiple_of(2) { merge(a, b, spare) } else { merge(spare_a, spare_b, keys) }
}

fn sort_run<'a>(mut keys: &'a mut [Key], mut spare: &'a mut [Key], passes: u32) {
    for pass in 0..passes {
        let digit = |key: &Key| (key.0 >> (pass * DIGIT_BITS)) as usize % DIGITS;
        let mut places = [0_u32; DIGITS];
        keys.iter().for_each(|key| places[digit(key)] += 1);
        let mut before = 0;
        for place in &mut places {
            before += std::mem::replace(place, before);
        }
        for key in &*keys {
            let place = &mut places[digit(key)];
            spare[*place as usize] = *key;
            *place += 1;
        }
        (keys, spare) = (spare, keys);
    }
}

/// Merges two runs; of equal codes those of the first come first.
fn merge(a: &[Key], b: &[Key], out: &mut [Key]) {
    if out.len() < FEW {
        return merge_run(a, b, out);
    }
    // Where the longer one is cut in two, and where the other has to be.
    let (cut_a, cut_b) = if a.len() >= b.len() {
        let cut = a.len() / 2;
        (cut, b.partition_point(|key| key.0 < a[cut].0))
    } else {
        let cut = b.len() / 2;
        (a.partition_point(|key| key.0 <= b[cut].0), cut)
    };
    let (first, second) = out.split_at_mut(cut_a + cut_b);
    rayon::join(|| merge(&a[..cut_a], &b[..cut_b], first), || merge(&a[cut_a..], &b[cut_b..], second));
}

fn merge_run(a: &[Key], b: &[Key], out: &mut [Key]) {
    let (mut i, mut j) = (0, 0);
    for key in out {
        let is_first = j == b.len() || (i < a.len() && a[i].0 <= b[j].0);
        *key = if is_first { a[i] } else { b[j] };
        i += usize::from(is_first);
        j += usize::from(!is_first);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_are_sorted_by_code_and_equal_ones_stay_in_order() {
        let mut state = 1_u64;
        for (count, bits) in [(0, 30), (1, 63), (1000, 30), (3 * FEW, 30), (5 * FEW + 1, 63), (5 * FEW, 3)] {
            for threads in [1, 2, 3, 8] {
                let mut next = || {
                    state =
                        state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                    state >> (64 - bits)
                };
                let keys: Vec<Key> = (0..count as u32).map(|index| (next(), index)).collect();
                let mut wanted = keys.clone();
                wanted.sort_unstable();
                let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
                assert!(pool.install(|| sorted(keys, bits)) == wanted, "{count} {bits} {threads}");
            }
        }
    }
}
