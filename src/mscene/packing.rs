//! Undoes Cap'n Proto's packing, which leaves out bytes that are zero.
//!
//! Not left to `capnp`: its reader refuses runs that cross the borders of segments, and takes the size that a
//! message claims on trust.

use std::path::Path;

use crate::error::{Error, Result};

/// Largest message, unpacked: 1 GiB, over five million patches.
const MAX_WORDS: usize = 1 << 27;

/// Most that unpacking may multiply the size by. Real scenes grow by less than two; a thousand is possible.
const MAX_GROWTH: usize = 16;

/// The words of a packed message, their bytes in the order of the file.
pub(super) fn unpacked(path: &Path, packed: &[u8]) -> Result<Vec<u64>> {
    let limit = MAX_WORDS.min(packed.len().saturating_mul(MAX_GROWTH) / size_of::<u64>());
    let mut rest = packed;
    let mut words = Vec::new();
    while let Some((&tag, tail)) = rest.split_first() {
        rest = word(&mut words, tag, tail).ok_or_else(|| cut_short(path, packed.len()))?;
        if words.len() > limit {
            return Err(too_large(path, limit));
        }
    }
    Ok(words)
}

/// Unpacks the word after a tag, and the run that may follow it; gives what is left, or `None` if it is missing.
fn word<'a>(words: &mut Vec<u64>, tag: u8, mut rest: &'a [u8]) -> Option<&'a [u8]> {
    let mut bytes = [0; 8];
    for (bit, byte) in bytes.iter_mut().enumerate() {
        if tag >> bit & 1 == 1 {
            (*byte, rest) = rest.split_first().map(|(&first, tail)| (first, tail))?;
        }
    }
    words.push(u64::from_ne_bytes(bytes));
    match tag {
        0x00 => {
            let (&zeros, tail) = rest.split_first()?;
            words.resize(words.len() + usize::from(zeros), 0);
            Some(tail)
        }
        0xff => {
            let (&count, tail) = rest.split_first()?;
            let (run, tail) = tail.split_at_checked(usize::from(count) * 8)?;
            words.extend(run.as_chunks::<8>().0.iter().map(|&bytes| u64::from_ne_bytes(bytes)));
            Some(tail)
        }
        _ => Some(rest),
    }
}

fn cut_short(path: &Path, length: usize) -> Error {
    let problem = format!("the file ends in the middle of a word, after {length} bytes");
    Error::content(path, problem, "copy or export the file again: it is cut short, or not a .mscene file")
}

fn too_large(path: &Path, limit: usize) -> Error {
    let problem = format!("the message unpacks to more than {} bytes", limit * size_of::<u64>());
    let remedy = format!(
        "split the scene: at most {} MiB unpacked are read, and {MAX_GROWTH} times the size of the file",
        (MAX_WORDS * size_of::<u64>()) >> 20
    );
    Error::content(path, problem, remedy)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bytes(packed: &[u8]) -> Option<Vec<u8>> {
        let words = unpacked(Path::new("x.mscene"), packed).ok()?;
        Some(words.into_iter().flat_map(u64::to_ne_bytes).collect())
    }

    #[test]
    fn the_examples_of_the_specification_unpack() {
        let packed = [0x51, 0x08, 0x03, 0x02, 0x31, 0x19, 0xaa, 0x01];
        let plain = [8, 0, 0, 0, 3, 0, 2, 0, 0x19, 0, 0, 0, 0xaa, 1, 0, 0];
        assert_eq!(bytes(&packed), Some(plain.to_vec()));
        assert_eq!(bytes(&[0x00, 0x03]), Some(vec![0; 32]));
        let run = [0xff, 1, 2, 3, 4, 5, 6, 7, 8, 1, 9, 0, 0, 0, 0, 0, 0, 0];
        assert_eq!(bytes(&run), Some(vec![1, 2, 3, 4, 5, 6, 7, 8, 9, 0, 0, 0, 0, 0, 0, 0]));
        assert_eq!(bytes(&[]), Some(vec![]));
    }

    #[test]
    fn what_is_cut_short_is_refused() {
        for packed in [&[0x00][..], &[0x01], &[0xff, 1, 2, 3], &[0xff, 1, 2, 3, 4, 5, 6, 7, 8, 1, 9]] {
            assert_eq!(bytes(packed), None, "{packed:?}");
        }
    }

    #[test]
    fn zeros_do_not_fill_the_memory() {
        let bomb = [0x00, 0xff].repeat(1000);
        assert_eq!(bytes(&bomb), None);
    }
}
