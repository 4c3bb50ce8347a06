//! Curves of homogeneous points on their way to cubic Bézier segments.

use super::net::Homogeneous;

/// (1 − share) · a + share · b; exactly `a` or `b` where the share is 0 or 1.
pub(super) fn mix(a: Homogeneous, b: Homogeneous, share: f64) -> Homogeneous {
    [0, 1, 2, 3].map(|k| (1.0 - share) * a[k] + share * b[k])
}

/// Goes from `a` a part of the way to `b`: exactly `a` where both are the same.
pub(super) fn towards(a: Homogeneous, b: Homogeneous, part: f64) -> Homogeneous {
    [0, 1, 2, 3].map(|k| a[k] + part * (b[k] - a[k]))
}

/// A Bézier curve of degree 1 to 3 as one of degree 3 (Farin, ch. 5.1); the other way round it gives the same bits.
/// A single point is a curve that stays there.
pub(crate) fn raised(curve: &[Homogeneous]) -> [Homogeneous; 4] {
    const THIRD: f64 = 1.0 / 3.0;
    const TWO_THIRDS: f64 = 2.0 / 3.0;
    match *curve {
        [a, b, c, d, ..] => [a, b, c, d],
        [a, b, c] => [a, towards(a, b, TWO_THIRDS), towards(c, b, TWO_THIRDS), c],
        [a, b] => [a, towards(a, b, THIRD), towards(b, a, THIRD), b],
        [a] => [a; 4],
        [] => [[0.0; 4]; 4],
    }
}

/// Cubic segments in a row, of which each starts where the one before ends: the last point of one is the first of the next.
pub(crate) fn joined(segments: impl Iterator<Item = [Homogeneous; 4]>) -> Vec<Homogeneous> {
    let mut chain = Vec::new();
    for [first, second, third, last] in segments {
        if chain.is_empty() {
            chain.push(first);
        }
        chain.extend([second, third, last]);
    }
    chain
}

/// Piecewise Bézier curves of a degree, `degree` points a segment and one more, as cubic segments.
pub(super) fn raised_chain(degree: usize, points: &[Homogeneous]) -> Vec<Homogeneous> {
    let ends = (degree..points.len()).step_by(degree.max(1));
    joined(ends.map(|end| raised(&points[end - degree..=end])))
}
