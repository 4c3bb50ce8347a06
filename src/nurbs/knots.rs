//! Knots: what is to be drawn of a spline, as Bézier segments between its knots.

use super::NurbsError;
use super::curves::{joined, mix, raised};
use super::net::Homogeneous;

/// One direction of a surface: `'u'` or `'v'`.
pub(super) struct Knots<'a> {
    pub(super) direction: char,
    pub(super) degree: usize,
    pub(super) values: &'a [f64],
    pub(super) range: [f64; 2],
}

impl Knots<'_> {
    /// Number of control points that these knots belong to.
    pub(super) fn point_count(&self) -> usize {
        self.values.len().saturating_sub(self.degree + 1)
    }

    /// # Errors
    /// If there is no spline with such knots, or none in the range.
    pub(super) fn check(&self) -> Result<(), NurbsError> {
        let &Self { direction, degree, .. } = self;
        if !(1..=3).contains(&degree) {
            return Err(NurbsError::Degree { direction, degree });
        }
        if self.point_count() <= degree {
            let needed = 2 * (degree + 1);
            return Err(NurbsError::KnotCount { direction, degree, needed, found: self.values.len() });
        }
        self.check_values()?;
        self.check_multiplicities()?;
        self.check_range()
    }

    fn check_values(&self) -> Result<(), NurbsError> {
        let direction = self.direction;
        // Half of the largest number, so that differences are finite.
        let wild = self.values.iter().position(|knot| !knot.is_finite() || knot.abs() > 0.5 * f64::MAX);
        if let Some(index) = wild {
            return Err(NurbsError::KnotValue { direction, index });
        }
        match self.values.windows(2).position(|pair| pair[0] > pair[1]) {
            Some(before) => Err(NurbsError::KnotOrder { direction, index: before + 1 }),
            None => Ok(()),
        }
    }

    /// Inside the domain a knot may be there as often as the degree says, elsewhere once more.
    fn check_multiplicities(&self) -> Result<(), NurbsError> {
        let [low, high] = self.domain();
        for equal in self.values.chunk_by(|a, b| a == b) {
            let knot = equal[0];
            let is_inside = low < knot && knot < high;
            let most = if is_inside { self.degree } else { self.degree + 1 };
            if equal.len() > most {
                let (direction, found) = (self.direction, equal.len());
                return Err(NurbsError::Multiplicity { direction, knot, found, most });
            }
        }
        Ok(())
    }

    fn check_range(&self) -> Result<(), NurbsError> {
        let (direction, [low, high], [start, end]) = (self.direction, self.domain(), self.range);
        if !(low <= start && end <= high) {
            return Err(NurbsError::OutsideRange { direction, start, end, low, high });
        }
        // This way round NaN is refused too.
        if start < end { Ok(()) } else { Err(NurbsError::EmptyRange { direction, start, end }) }
    }

    /// The parameters for which there is a spline.
    fn domain(&self) -> [f64; 2] {
        [self.values[self.degree], self.values[self.point_count()]]
    }

    /// A spline's cubic Bézier segments, within the range.
    pub(super) fn chain(&self, points: &[Homogeneous]) -> Vec<Homogeneous> {
        joined(self.spans().map(|(span, ends)| raised(&self.segment(points, span, ends))))
    }

    /// Indices of knots after which there is something to be drawn, and from where to where.
    pub(super) fn spans(&self) -> impl Iterator<Item = (usize, [f64; 2])> {
        let [start, end] = self.range;
        (self.degree..self.point_count()).filter_map(move |span| {
            let ends = [self.values[span].max(start), self.values[span + 1].min(end)];
            (ends[0] < ends[1]).then_some((span, ends))
        })
    }

    /// The Bézier points of a piece of a polynomial are its blossom at the piece's ends (Ramshaw 1989, "Blossoms are
    /// polar forms", sec. 4).
    fn segment(&self, points: &[Homogeneous], span: usize, [a, b]: [f64; 2]) -> Vec<Homogeneous> {
        let degree = self.degree;
        (0..=degree)
            .map(|i| {
                let arguments = [0, 1, 2].map(|k| if k < degree - i { a } else { b });
                self.blossom(points, span, &arguments[..degree])
            })
            .collect()
    }

    /// The blossom of the polynomial between two knots, by the algorithm of de Boor with another parameter each round
    /// (ibid.). All parameters lie between the two knots, so every step is a convex combination, and no weight
    /// becomes 0.
    fn blossom(&self, points: &[Homogeneous], span: usize, arguments: &[f64]) -> Homogeneous {
        let (degree, knots) = (self.degree, self.values);
        let mut net = [[0.0; 4]; 4];
        net[..=degree].copy_from_slice(&points[span - degree..=span]);
        for (round, &argument) in (1..).zip(arguments) {
            for j in (round..=degree).rev() {
                let (low, high) = (knots[span + j - degree], knots[span + j + 1 - round]);
                net[j] = mix(net[j - 1], net[j], (argument - low) / (high - low));
            }
        }
        net[degree]
    }
}
