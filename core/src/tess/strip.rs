//! The triangles between two rows of vertices, each by its index alone.

use super::division::{Division, highest_bit};

/// Halvings that find one of at most 32 marks.
const MARK_BITS: u32 = 5;
/// Marks on half a ruler.
const MARKS: u32 = 1 << MARK_BITS;

/// A row of vertices.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Run {
    /// Index of its first vertex.
    pub first: u32,
    /// From one index to the next, modulo 2³².
    pub step: u32,
    /// Segments.
    pub length: u32,
    /// Index of its last vertex.
    pub end: u32,
}

impl Run {
    /// Index of a vertex of the row.
    #[inline(always)]
    #[must_use]
    pub const fn vertex(&self, at: u32) -> u32 {
        if at >= self.length { self.end } else { self.first.wrapping_add(self.step.wrapping_mul(at)) }
    }
}

/// How the triangles of a strip are laid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Not triangles but the segments of the outside.
    Line,
    /// The outside has two segments more than the inside.
    Regular,
    /// Both sides are divided as they like: vertices come in the order of the marks of a ruler.
    Between,
    /// Both sides have as many segments, and the inside runs the other way.
    Row,
    /// The same where there is a square in the middle of a row along v: its diagonal runs the other way.
    Column,
    /// A patch that is a single square.
    Square,
    /// A single triangle.
    Triangle,
}

/// A strip of triangles between two rows of vertices.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Strip {
    /// Index of its first triangle.
    pub first: u32,
    /// How many it has.
    pub count: u32,
    /// The ring that the inside is of; of isolines, which line.
    pub ring: u32,
    /// The side of the rings.
    pub side: u32,
    /// The row outside.
    pub outside: Run,
    /// The row inside.
    pub inside: Run,
    /// How its triangles are laid.
    pub kind: Kind,
    /// Marks on half of the outside and of the inside, if it is [`Kind::Between`].
    pub marks: [u32; 2],
}

impl Strip {
    pub(super) const NONE: Self = Self {
        first: 0,
        count: 0,
        ring: 0,
        side: 0,
        outside: Run { first: 0, step: 0, length: 0, end: 0 },
        inside: Run { first: 0, step: 0, length: 0, end: 0 },
        kind: Kind::Line,
        marks: [0; 2],
    };

    #[inline(always)]
    pub(super) const fn line(line: u32, count: u32, vertex: u32) -> Self {
        let outside = Run { first: vertex, step: 1, length: count, end: vertex + count };
        Self { first: line * count, count, ring: line, outside, ..Self::NONE }
    }

    #[inline(always)]
    pub(super) const fn regular(self) -> Self {
        Self { count: 2 * self.inside.length + 2, kind: Kind::Regular, ..self }
    }

    #[inline(always)]
    pub(super) const fn between(self, outside: &Division, inside: &Division) -> Self {
        let count = self.outside.length + self.inside.length;
        Self { count, kind: Kind::Between, marks: [outside.marks(), inside.marks()], ..self }
    }

    #[inline(always)]
    pub(super) const fn row(self, is_whole: bool, is_alike: bool) -> Self {
        let kind = if is_alike { Kind::Row } else { Kind::Column };
        Self { kind: if is_whole { Kind::Square } else { kind }, ..self }
    }

    #[inline(always)]
    pub(super) const fn triangle_in_the_middle(self) -> Self {
        Self { kind: Kind::Triangle, ..self }
    }

    /// Vertices of a triangle of the strip, counted from its first one, counter-clockwise in (u, v); of a line, two and the
    /// second once more.
    #[inline(always)]
    #[must_use]
    pub const fn triangle(&self, index: u32) -> [u32; 3] {
        let (outside, inside) = (&self.outside, &self.inside);
        match self.kind {
            Kind::Regular => self.regular_triangle(index),
            Kind::Between => self.triangle_between(index),
            Kind::Row => self.row_triangle(index),
            Kind::Column => self.column_triangle(index),
            Kind::Line => [outside.vertex(index), outside.vertex(index + 1), outside.vertex(index + 1)],
            Kind::Square if index == 0 => [outside.first, outside.vertex(1), inside.vertex(1)],
            Kind::Square => [outside.vertex(1), inside.first, inside.vertex(1)],
            Kind::Triangle => [outside.first, inside.first, inside.end],
        }
    }

    /// Diagonals run from the ends of the outside towards the middle of the inside. At both ends a quadrilateral is but half
    /// there.
    #[inline(always)]
    const fn regular_triangle(&self, index: u32) -> [u32; 3] {
        let (outside, inside) = (&self.outside, &self.inside);
        let quad = index.div_ceil(2);
        let is_second = index.is_multiple_of(2);
        let [a, b] = [outside.vertex(quad), outside.vertex(quad + 1)];
        if index + 1 == self.count {
            return [a, b, inside.end];
        }
        let d = inside.vertex(quad);
        if quad <= inside.length.div_ceil(2) {
            if is_second { [a, b, d] } else { [a, d, inside.vertex(quad - 1)] }
        } else {
            let c = inside.vertex(quad - 1);
            if is_second { [c, b, d] } else { [c, a, b] }
        }
    }

    /// All diagonals run the same way.
    #[inline(always)]
    const fn row_triangle(&self, index: u32) -> [u32; 3] {
        let [a, b, c, d] = self.square(index / 2);
        if index.is_multiple_of(2) { [d, a, b] } else { [d, b, c] }
    }

    /// All diagonals but the one in the middle run the same way.
    #[inline(always)]
    const fn column_triangle(&self, index: u32) -> [u32; 3] {
        let [a, b, c, d] = self.square(index / 2);
        let is_middle = index / 2 == self.inside.length / 2;
        match (is_middle, index % 2) {
            (false, 0) => [a, b, d],
            (false, _) => [d, b, c],
            (true, 0) => [a, c, d],
            (true, _) => [a, b, c],
        }
    }

    /// Corners of a square of a row, counter-clockwise from the start of its outside.
    #[inline(always)]
    const fn square(&self, index: u32) -> [u32; 4] {
        let (outside, inside) = (&self.outside, &self.inside);
        let back = inside.length - index;
        [outside.vertex(index), outside.vertex(index + 1), inside.vertex(back - 1), inside.vertex(back)]
    }

    /// The first half of the triangles as they come, the other half mirrored, and what is between them.
    #[inline(always)]
    const fn triangle_between(&self, index: u32) -> [u32; 3] {
        let [outer, inner] = self.marks;
        // On the inside the corner is no mark, as the ring there is two segments shorter.
        let half = outer + inner.saturating_sub(1);
        if index < half {
            let (out, inn, is_outside) = self.step(index);
            return self.advance(out, inn, is_outside);
        }
        if index + half >= self.count {
            let (out, inn, is_outside) = self.step(self.count - 1 - index);
            let (out, inn) = (self.outside.length - 1 - out, self.inside.length.wrapping_sub(1 + inn));
            return if is_outside {
                self.advance(out, inn.wrapping_add(1), true)
            } else {
                self.advance(out.wrapping_add(1), inn, false)
            };
        }
        let middle = index - half;
        let inn = inner.saturating_sub(1);
        let is_odd = [self.outside.length % 2 == 1, self.inside.length % 2 == 1];
        match is_odd {
            [true, true] if middle == 0 => self.advance(outer, inn, false),
            [true, true] => {
                [self.inside.vertex(inn + 1), self.outside.vertex(outer), self.outside.vertex(outer + 1)]
            }
            [true, false] => {
                [self.inside.vertex(inn), self.outside.vertex(outer), self.outside.vertex(outer + 1)]
            }
            _ => self.advance(outer, inn, false),
        }
    }

    #[inline(always)]
    const fn advance(&self, out: u32, inn: u32, is_outside: bool) -> [u32; 3] {
        let (outside, inside) = (&self.outside, &self.inside);
        if is_outside {
            [outside.vertex(out), outside.vertex(out + 1), inside.vertex(inn)]
        } else {
            [inside.vertex(inn), outside.vertex(out), inside.vertex(inn + 1)]
        }
    }

    /// Step `index` of the first half: at which vertices both sides are, and whether the outside goes on.
    #[inline(always)]
    const fn step(&self, index: u32) -> (u32, u32, bool) {
        let [outer, inner] = self.marks;
        // The mark before which no more than `index` steps are taken.
        let mut mark = 0;
        let mut bit = MARKS / 2;
        while bit > 0 {
            if marks_before(mark + bit, outer) + inner_marks_before(mark + bit, inner) <= index {
                mark += bit;
            }
            bit /= 2;
        }
        let (out, inn) = (marks_before(mark, outer), inner_marks_before(mark, inner));
        // At a mark of both, the inside goes on first.
        let inside_goes_on = inner_marks_before(mark + 1, inner) - inn;
        let is_outside = index - out - inn >= inside_goes_on;
        (out, if is_outside { inn + inside_goes_on } else { inn }, is_outside)
    }
}

/// How many of the first `marks` marks lie before mark `end` of half a ruler: first comes the one at its start, then that
/// in its middle, then those in the middle between these, and so on, each time from the start on.
#[inline(always)]
const fn marks_before(end: u32, marks: u32) -> u32 {
    if marks == 0 || end == 0 {
        return 0;
    }
    let whole = highest_bit(marks);
    let rest = marks - whole;
    let apart = MARKS / whole;
    let between = (end - 1 + apart / 2) / apart;
    1 + (end - 1) / apart + if between < rest { between } else { rest }
}

/// The same without the one at the start.
#[inline(always)]
const fn inner_marks_before(end: u32, marks: u32) -> u32 {
    marks_before(end, marks).saturating_sub(1)
}
