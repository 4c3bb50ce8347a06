//! Gregory patches as scenes hold them (Loop, Schaefer, Ni & Castaño 2009), and the records that devices read.

use micropoly_core::abi::Patch;
use micropoly_core::patch::gregory::INNER;

/// A Gregory patch: corners `p0…3` at (u, v) = (0, 0), (0, 1), (1, 1) and (1, 0), then `e⁺0…3`, `e⁻0…3`,
/// `f⁺0…3`, `f⁻0…3`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GregoryPatch {
    /// Control points in object space.
    pub points: [[f32; 3]; 20],
}

const E_PLUS: usize = 4;
const E_MINUS: usize = 8;
const F_PLUS: usize = 12;
const F_MINUS: usize = 16;

/// Which point stands where in the net, row after row along u; the inner ones are blends.
const NET: [usize; 16] = [
    0,
    E_PLUS,
    E_MINUS + 1,
    1,
    E_MINUS,
    F_PLUS,
    F_PLUS + 1,
    E_PLUS + 1,
    E_PLUS + 3,
    F_PLUS + 3,
    F_PLUS + 2,
    E_MINUS + 2,
    3,
    E_MINUS + 3,
    E_PLUS + 2,
    2,
];

/// Face points with full weight on the border of constant u beside them, then those of constant v; each in the
/// order of [`INNER`].
const FACES: [usize; 8] =
    [F_PLUS, F_MINUS + 1, F_MINUS + 3, F_PLUS + 2, F_MINUS, F_PLUS + 1, F_PLUS + 3, F_MINUS + 2];

/// Where each point comes from when v runs the other way: corners change places with their neighbours along v,
/// and so do the points that belong to the two directions at each corner.
const REVERSED: [usize; 20] = [1, 0, 3, 2, 9, 8, 11, 10, 5, 4, 7, 6, 17, 16, 19, 18, 13, 12, 15, 14];

impl GregoryPatch {
    /// Lets v run the other way, so that the back becomes the front.
    pub fn reverse(&mut self) {
        self.points = REVERSED.map(|from| self.points[from]);
    }

    /// The control net, its inner points the means of two face points each.
    #[must_use]
    pub fn net(&self) -> [[f32; 3]; 16] {
        let mut net = NET.map(|from| self.points[from]);
        for (m, at) in INNER.into_iter().enumerate() {
            let (a, b) = (self.points[FACES[m]], self.points[FACES[4 + m]]);
            net[at] = [0, 1, 2].map(|k| 0.5 * a[k] + 0.5 * b[k]);
        }
        net
    }

    /// The record of its face points, as [`micropoly_core::patch::Faces`] reads it.
    #[must_use]
    pub fn faces(&self, object: u32) -> Patch {
        let mut record = Patch { object, ..Patch::default() };
        for (l, from) in FACES.into_iter().enumerate() {
            [record.x[l], record.y[l], record.z[l]] = self.points[from];
        }
        record
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reversing_exchanges_the_ends_of_v_and_twice_changes_nothing() {
        let patch = GregoryPatch { points: std::array::from_fn(|k| [k as f32, 1.0, 2.0]) };
        let mut reversed = patch;
        reversed.reverse();
        let mut net = patch.net();
        net.chunks_exact_mut(4).for_each(<[_]>::reverse);
        assert_eq!(reversed.net(), net);
        let (there, back) = (patch.faces(0), reversed.faces(0));
        for (m, mirrored) in [1, 0, 3, 2, 5, 4, 7, 6].into_iter().enumerate() {
            assert_eq!(there.x[m], back.x[mirrored]);
        }
        reversed.reverse();
        assert_eq!(reversed, patch);
    }
}
