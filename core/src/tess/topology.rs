//! Which vertices and primitives a divided patch has, and what each of them is by its index alone.
//!
//! The outermost ring of vertices is divided by the outer levels, and rings inside it by the inner ones, each with two
//! segments fewer a side than the one around it, until what is left is a point, a line, a triangle or a row of squares.
//! Vertices are numbered ring by ring, and primitives strip by strip between rings, in the order of Direct3D 11.

use super::division::Division;
use super::strip::{Run, Strip};
use crate::abi::{TESS_ISOLINES, TESS_QUADS, TessFrame, TessRecord};

/// Halvings that find one of at most 64 rings.
const RING_BITS: u32 = 6;

/// How a patch is divided.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Topology {
    domain: u32,
    /// Sides of the domain; isolines have none.
    sides: u32,
    /// Divisions of the outer edges.
    outer: [Division; 4],
    /// Divisions along u and along v.
    inner: [Division; 2],
    /// Segments of the inner divisions on all sides together.
    around: u32,
    /// Vertices on the outer edges.
    border: u32,
    /// Rings inside the outermost one.
    rings: u32,
}

/// A row of vertices on one side of a ring, from a corner to the next one, which belongs to the next side.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Side {
    /// Index of its first vertex.
    pub first: u32,
    /// How many vertices are its own.
    pub count: u32,
    /// Which ring; of isolines, which line.
    pub ring: u32,
    /// Which side of the ring.
    pub side: u32,
}

/// Where the vertices of a side are: on a line, along a division.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Row {
    division: Division,
    /// Point of the division at which the first vertex is.
    first: u32,
    is_forward: bool,
    side: u32,
    /// How far the line is from the edge of the domain that has this side.
    depth: u32,
    /// How much earlier the line begins and ends, on a triangle.
    inset: u32,
    sides: u32,
}

impl Row {
    /// Coordinates of a vertex, counted from the first of the side, in units of 2⁻¹⁶; they add up to 1 on triangles, and there
    /// is no third one on quadrilaterals and isolines.
    #[inline(always)]
    #[must_use]
    pub const fn coordinates(&self, index: u32) -> [u32; 3] {
        let point = if self.is_forward { self.first + index } else { self.first - index };
        let place = self.division.place(point) - self.inset;
        let depth = self.depth;
        if self.sides == 3 {
            let rest = ONE - place - depth;
            return match self.side {
                0 => [depth, place, rest],
                1 => [place, depth, rest],
                _ => [place, rest, depth],
            };
        }
        match self.side {
            0 => [depth, place, 0],
            1 => [place, depth, 0],
            2 => [ONE - depth, place, 0],
            _ => [place, ONE - depth, 0],
        }
    }
}

impl Topology {
    /// Of a patch whose levels are converted.
    #[inline(always)]
    #[must_use]
    pub const fn new(frame: &TessFrame, levels: &[u32; 6]) -> Self {
        let mut topology = Self {
            domain: frame.domain,
            sides: if frame.domain == TESS_QUADS { 4 } else { 3 },
            outer: [
                Division::new(levels[0]),
                Division::new(levels[1]),
                Division::new(levels[2]),
                Division::new(levels[3]),
            ],
            inner: [Division::new(levels[4]), Division::new(levels[5])],
            around: 0,
            border: 0,
            rings: 0,
        };
        if topology.sides == 3 {
            topology.inner[1] = topology.inner[0];
        }
        let mut side = 0;
        while side < topology.sides {
            topology.border += topology.outer[side as usize].segments();
            topology.around += topology.along(side).segments();
            side += 1;
        }
        topology.rings = topology.least() / 2;
        topology
    }

    /// Is the patch dropped?
    #[inline(always)]
    #[must_use]
    pub const fn is_dropped(&self) -> bool {
        self.outer[0].segments() == 0
    }

    /// Number of vertices.
    #[inline(always)]
    #[must_use]
    pub const fn vertices(&self) -> u32 {
        if self.is_dropped() {
            0
        } else if self.domain == TESS_ISOLINES {
            self.outer[0].segments() * (self.outer[1].segments() + 1)
        } else if self.is_whole() {
            self.border
        } else if self.ends_in_line() {
            self.ring_start(self.rings) + self.line() + 1
        } else {
            self.ring_start(self.rings + 1)
        }
    }

    /// Number of triangles, or of lines.
    #[inline(always)]
    #[must_use]
    pub const fn primitives(&self) -> u32 {
        if self.domain == TESS_ISOLINES {
            return self.outer[0].segments() * self.outer[1].segments();
        }
        if self.is_dropped() {
            return 0;
        }
        self.strips_start(self.rings + 1) + self.middle()
    }

    /// The side that has a vertex.
    #[inline(always)]
    #[must_use]
    pub const fn side_of(&self, vertex: u32) -> Side {
        if self.domain == TESS_ISOLINES {
            let count = self.outer[1].segments() + 1;
            let ring = vertex / count;
            return Side { first: ring * count, count, ring, side: 0 };
        }
        let ring = self.ring_of(vertex);
        let mut found = self.first_side(ring);
        while vertex - found.first >= found.count {
            found = self.next_side(found);
        }
        found
    }

    /// The side after a side; there is one if its first vertex is below [`Topology::vertices`].
    #[inline(always)]
    #[must_use]
    pub const fn next_side(&self, side: Side) -> Side {
        let first = side.first + side.count;
        if self.domain == TESS_ISOLINES {
            return Side { first, ring: side.ring + 1, ..side };
        }
        if side.side + 1 == self.sides || self.is_line(side.ring) {
            return self.first_side(side.ring + 1);
        }
        let next = side.side + 1;
        Side { first, count: self.segments(side.ring, next), ring: side.ring, side: next }
    }

    /// Where the vertices of a side are.
    #[inline(always)]
    #[must_use]
    pub const fn row(&self, side: Side) -> Row {
        let Side { ring, side, .. } = side;
        if self.domain == TESS_ISOLINES {
            let depth = self.outer[0].place(ring);
            return Row {
                division: self.outer[1],
                first: 0,
                is_forward: true,
                side: 1,
                depth,
                inset: 0,
                sides: 4,
            };
        }
        // A square that is not divided begins at (0, 0), one side on.
        let side = if self.is_whole() && self.sides == 4 { (side + 1) % 4 } else { side };
        let division = if ring == 0 { self.outer[side as usize] } else { *self.along(side) };
        // Sides 1 and 2 of quads, and 1 of triangles, run in the direction of their coordinate.
        let is_forward = side == 1 || (side == 2 && self.sides == 4);
        let first = if is_forward { ring } else { division.segments() - ring };
        let depth = if ring == 0 { 0 } else { self.along(side + 1).place(ring) };
        if self.sides == 4 {
            return Row { division, first, is_forward, side, depth, inset: 0, sides: 4 };
        }
        // Rings of a triangle are as far from its edges as from each other.
        let depth = (depth * TWO_THIRDS + HALF) >> 16;
        Row { division, first, is_forward, side, depth, inset: depth.div_ceil(2), sides: 3 }
    }

    /// The strip that has a triangle.
    #[inline(always)]
    #[must_use]
    pub const fn strip_of(&self, triangle: u32) -> Strip {
        if self.domain == TESS_ISOLINES {
            return self.line_strip(triangle / self.outer[1].segments());
        }
        let ring = self.ring_of_strip(triangle);
        let mut found = self.strip(ring, 0, self.strips_start(ring));
        while triangle - found.first >= found.count {
            found = self.next_strip(found);
        }
        found
    }

    /// The strip after a strip; there is one if its first triangle is below [`Topology::primitives`].
    #[inline(always)]
    #[must_use]
    pub const fn next_strip(&self, strip: Strip) -> Strip {
        let first = strip.first + strip.count;
        if self.domain == TESS_ISOLINES {
            self.line_strip(strip.ring + 1)
        } else if strip.side + 1 == self.sides {
            self.strip(strip.ring + 1, 0, first)
        } else {
            self.strip(strip.ring, strip.side + 1, first)
        }
    }

    /// One of the isolines.
    #[inline(always)]
    const fn line_strip(&self, line: u32) -> Strip {
        let count = self.outer[1].segments();
        Strip::line(line, count, line * (count + 1))
    }

    /// The strip between a side of a ring and the ring around it; behind the last ring, what is in the middle.
    #[inline(always)]
    const fn strip(&self, ring: u32, side: u32, first: u32) -> Strip {
        if ring > self.rings {
            return self.middle_strip(first);
        }
        let (outside, inside) = (self.run(ring - 1, side), self.run(ring, side));
        let place = Strip { first, count: 0, ring, side, outside, inside, ..Strip::NONE };
        if ring == 1 { place.between(&self.outer[side as usize], self.along(side)) } else { place.regular() }
    }

    /// What the last ring encloses, if anything: a triangle, or a row of squares.
    #[inline(always)]
    const fn middle_strip(&self, first: u32) -> Strip {
        let (ring, side) = (self.rings + 1, self.sides - 1);
        let count = self.middle();
        if self.sides == 3 {
            let corner = self.run(self.rings, 0);
            let across = self.run(self.rings, 1);
            let place = Strip { first, count, ring, side, outside: corner, inside: across, ..Strip::NONE };
            return place.triangle_in_the_middle();
        }
        let near = self.line_side();
        let (outside, inside) = (self.run(self.rings, near), self.run(self.rings, near + 2));
        let place = Strip { first, count, ring, side, outside, inside, ..Strip::NONE };
        place.row(self.is_whole(), near > 0 || self.line().is_multiple_of(2))
    }

    /// The vertices of one side of a ring, both corners among them.
    #[inline(always)]
    const fn run(&self, ring: u32, side: u32) -> Run {
        let (start, length) = (self.ring_start(ring), self.segments(ring, side));
        if self.is_line(ring) {
            return self.run_on_line(start, side, length);
        }
        let mut first = start;
        let mut before = 0;
        while before < side {
            first += self.segments(ring, before);
            before += 1;
        }
        let end = if side + 1 == self.sides { start } else { first + length };
        Run { first, step: 1, length, end }
    }

    /// A ring of two sides that lie on each other, and two that are its ends.
    #[inline(always)]
    const fn run_on_line(&self, start: u32, side: u32, length: u32) -> Run {
        let line = self.line();
        let place = if self.sides == 3 { 0 } else { side.wrapping_sub(self.line_side()) % 4 };
        match place {
            0 => Run { first: start, step: 1, length, end: start + length },
            1 => Run { first: start + line, step: 0, length, end: start + line },
            2 => Run { first: start + line, step: u32::MAX, length, end: start },
            _ => Run { first: start, step: 0, length, end: start },
        }
    }

    /// Is the patch not divided at all?
    #[inline(always)]
    const fn is_whole(&self) -> bool {
        self.rings == 0
    }

    /// Segments of the inner division that has fewer.
    #[inline(always)]
    const fn least(&self) -> u32 {
        let [u, v] = [self.inner[0].segments(), self.inner[1].segments()];
        if u < v { u } else { v }
    }

    /// Is the last ring a point or a line?
    #[inline(always)]
    const fn ends_in_line(&self) -> bool {
        self.least().is_multiple_of(2)
    }

    /// Is it this ring?
    #[inline(always)]
    const fn is_line(&self, ring: u32) -> bool {
        ring == self.rings && ring > 0 && self.ends_in_line()
    }

    /// Segments of the longer sides of the last ring.
    #[inline(always)]
    const fn line(&self) -> u32 {
        self.inner[0].segments() + self.inner[1].segments() - self.least() - 2 * self.rings
    }

    /// The side along which the vertices of the line in the middle are numbered.
    #[inline(always)]
    const fn line_side(&self) -> u32 {
        (self.inner[0].segments() > self.inner[1].segments()) as u32
    }

    /// Primitives that the last ring encloses.
    #[inline(always)]
    const fn middle(&self) -> u32 {
        if self.ends_in_line() {
            0
        } else if self.sides == 3 {
            1
        } else {
            2 * self.line()
        }
    }

    /// The inner division along a side.
    #[inline(always)]
    const fn along(&self, side: u32) -> &Division {
        &self.inner[(side & 1 == 0) as usize]
    }

    /// Segments of a side of a ring.
    #[inline(always)]
    const fn segments(&self, ring: u32, side: u32) -> u32 {
        if ring == 0 { self.outer[side as usize].segments() } else { self.along(side).segments() - 2 * ring }
    }

    /// Index of the first vertex of a ring.
    #[inline(always)]
    const fn ring_start(&self, ring: u32) -> u32 {
        if ring == 0 { 0 } else { self.border + (ring - 1) * (self.around - self.sides * ring) }
    }

    /// Index of the first triangle between a ring and the one around it.
    #[inline(always)]
    const fn strips_start(&self, ring: u32) -> u32 {
        if ring < 2 {
            0
        } else {
            self.border + self.around - 2 * self.sides + 2 * (ring - 2) * (self.around - self.sides * ring)
        }
    }

    #[inline(always)]
    const fn first_side(&self, ring: u32) -> Side {
        let first = self.ring_start(ring);
        if self.is_line(ring) {
            return Side { first, count: self.line() + 1, ring, side: self.line_side() };
        }
        Side { first, count: self.segments(ring, 0), ring, side: 0 }
    }

    /// The ring that has a vertex.
    #[inline(always)]
    const fn ring_of(&self, vertex: u32) -> u32 {
        let mut ring = 0;
        let mut bit = 1 << (RING_BITS - 1);
        while bit > 0 {
            if ring + bit <= self.rings && self.ring_start(ring + bit) <= vertex {
                ring += bit;
            }
            bit /= 2;
        }
        ring
    }

    /// The ring that has a triangle between it and the one around it; the one behind the last ring for what is in the
    /// middle.
    #[inline(always)]
    const fn ring_of_strip(&self, triangle: u32) -> u32 {
        let mut ring = 1;
        let mut bit = 1 << (RING_BITS - 1);
        while bit > 0 {
            if ring + bit <= self.rings + 1 && self.strips_start(ring + bit) <= triangle {
                ring += bit;
            }
            bit /= 2;
        }
        ring
    }
}

/// Of a patch that is recorded.
impl TessRecord {
    /// How it is divided.
    #[inline(always)]
    #[must_use]
    pub const fn topology(&self, frame: &TessFrame) -> Topology {
        Topology::new(frame, &self.levels)
    }
}

const ONE: u32 = crate::abi::TESS_UNIT;
const HALF: u32 = crate::abi::TESS_HALF;
/// Two thirds in units of 2⁻¹⁶, as Direct3D has it.
const TWO_THIRDS: u32 = 0xaaaa;
