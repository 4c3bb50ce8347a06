//! Texture coordinates of patches: those of their faces, straight between the corners.

use super::Cage;
use super::net::BORDER_CORNER;
use super::origin::Origin;

/// Finds the texture coordinates of a cage's patches.
#[derive(Clone, Debug)]
pub struct TextureMap<'a> {
    cage: &'a Cage,
    /// First corner of each face.
    starts: Vec<usize>,
}

impl<'a> TextureMap<'a> {
    /// Of a cage; `None` if it has no texture coordinates.
    #[must_use]
    pub fn new(cage: &'a Cage) -> Option<Self> {
        if cage.texture.is_empty() || cage.texture_corners.len() != cage.corners.len() {
            return None;
        }
        let mut starts = Vec::with_capacity(cage.face_sizes.len());
        let mut start = 0;
        for &size in &cage.face_sizes {
            starts.push(start);
            start += size as usize;
        }
        Some(Self { cage, starts })
    }

    /// Those at the four corners of a patch, numbered as in [`micropoly_core::border`]; `None` if the patch is not on the
    /// cage, or its face names coordinates that are not there.
    #[must_use]
    pub fn at(&self, origin: &Origin) -> Option<[[f32; 2]; 4]> {
        let square = self.square(origin)?;
        let squares = f64::from(1_u32.checked_shl(origin.level.into())?);
        let mut corners = [[0.0; 2]; 4];
        for (at, [x, y]) in [[0, 0], [1, 0], [1, 1], [0, 1]].into_iter().enumerate() {
            let u = f64::from(u32::from(origin.x) + x) / squares;
            let v = f64::from(u32::from(origin.y) + y) / squares;
            let shares = [(1.0 - u) * (1.0 - v), u * (1.0 - v), u * v, (1.0 - u) * v];
            let sum = |axis: usize| (0..4).map(|k| shares[k] * square[k][axis]).sum::<f64>() as f32;
            corners[usize::from(BORDER_CORNER[at])] = [sum(0), sum(1)];
        }
        Some(corners)
    }

    /// The coordinates at the corners of the face or sub-face, counter-clockwise.
    fn square(&self, origin: &Origin) -> Option<[[f64; 2]; 4]> {
        let face = origin.face as usize;
        let (start, size) = (*self.starts.get(face)?, *self.cage.face_sizes.get(face)? as usize);
        let corner = |at: usize| -> Option<[f64; 2]> {
            let index = *self.cage.texture_corners.get(start + at % size)? as usize;
            self.cage.texture.get(index).map(|place| place.map(f64::from))
        };
        if origin.sub < 0 {
            return Some([corner(0)?, corner(1)?, corner(2)?, corner(3)?]);
        }
        let at = origin.sub as usize;
        let mean = |a: [f64; 2], b: [f64; 2]| [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])];
        let (here, after, before) = (corner(at)?, corner(at + 1)?, corner(at + size.max(1) - 1)?);
        let mut middle = [0.0; 2];
        for k in 0..size {
            let place = corner(k)?;
            middle = [middle[0] + place[0] / size as f64, middle[1] + place[1] / size as f64];
        }
        Some([here, mean(here, after), middle, mean(before, here)])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cage(sizes: &[u32]) -> Cage {
        let count = sizes.iter().sum::<u32>();
        Cage {
            face_sizes: sizes.to_vec(),
            corners: (0..count).collect(),
            texture: vec![[0.0, 0.0], [1.0, 0.0], [1.0, 2.0], [0.0, 2.0], [5.0, 5.0], [8.0, 5.0], [5.0, 8.0]],
            texture_corners: (0..count).collect(),
            ..Cage::default()
        }
    }

    #[test]
    fn a_quarter_of_a_quad_has_a_quarter_of_its_texture() {
        let cage = cage(&[4]);
        let map = TextureMap::new(&cage).expect("coordinates");
        let quarter = Origin { level: 1, x: 1, y: 0, ..Origin::whole(0, -1) };
        assert_eq!(map.at(&quarter), Some([[0.5, 0.0], [1.0, 0.0], [0.5, 1.0], [1.0, 1.0]]));
    }

    #[test]
    fn sub_faces_meet_in_the_middle() {
        let cage = cage(&[4, 3]);
        let map = TextureMap::new(&cage).expect("coordinates");
        let expected = [[8.0, 5.0], [6.5, 6.5], [6.5, 5.0], [6.0, 6.0]];
        let found = map.at(&Origin::whole(1, 1)).expect("a sub-face");
        for (found, expected) in found.iter().zip(expected) {
            assert!(
                (found[0] - expected[0]).abs() + (found[1] - expected[1]).abs() < 1e-6,
                "{found:?} {expected:?}"
            );
        }
    }

    #[test]
    fn what_is_not_there_has_no_texture() {
        assert!(TextureMap::new(&Cage::default()).is_none());
        let mut cage = cage(&[4]);
        assert!(TextureMap::new(&cage).and_then(|map| map.at(&Origin::whole(1, -1))).is_none());
        cage.texture_corners[2] = 99;
        assert!(TextureMap::new(&cage).and_then(|map| map.at(&Origin::whole(0, -1))).is_none());
    }
}
