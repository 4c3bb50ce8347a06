//! Corners that triangles of a cell have in common, each once.

use micropoly_core::accel::bsp::lattice::Point;
use micropoly_core::accel::bsp::table::FEW;

/// Most corners of few triangles.
pub(super) const CORNERS: usize = 3 * FEW;
/// Places in the table; the rest stays empty, so that each corner is found soon.
const PLACES: usize = 512;
const EMPTY: u8 = u8::MAX;

/// A hash table of corners.
pub(super) struct Shared {
    pub(super) points: Vec<Point>,
    places: [u8; PLACES],
}

impl Default for Shared {
    fn default() -> Self {
        Self { points: Vec::with_capacity(CORNERS), places: [EMPTY; PLACES] }
    }
}

impl Shared {
    pub(super) fn clear(&mut self) {
        self.points.clear();
        self.places.fill(EMPTY);
    }

    /// The number of a corner, a new one if it was not seen before.
    pub(super) fn number(&mut self, point: Point) -> u8 {
        let mut place = hash(point);
        loop {
            let number = self.places[place];
            if number == EMPTY {
                self.places[place] = self.points.len() as u8;
                self.points.push(point);
                return self.places[place];
            }
            if self.points[usize::from(number)] == point {
                return number;
            }
            place = (place + 1) % PLACES;
        }
    }
}

/// The upper bits of products with odd numbers: golden ratio and the like.
fn hash([x, y, z]: Point) -> usize {
    let mixed = (x as u32).wrapping_mul(0x9E37_79B1) ^ (y as u32).wrapping_mul(0x85EB_CA77);
    let mixed = (mixed ^ (z as u32).wrapping_mul(0xC2B2_AE3D)).wrapping_mul(0x27D4_EB2F);
    (mixed >> 23) as usize
}
