//! Quadrics of RenderMan's interface: surfaces of revolution about z, exactly, as rational bicubic patches.
//!
//! A profile of rational cubics is turned about z by rational arcs of at most 90° (Piegl & Tiller, "The NURBS Book",
//! sec. 7.3 and 8.5; arcs are quadratic and raised to cubic). u goes around and v along the profile, as in
//! RenderMan's interface, but neither is proportional to the angle, nor v of a paraboloid to z.
//!
//! The front, where du × dv points, is always the outer side: away from the axis, for tori away from the circle in
//! their middle, and for disks and flat hyperboloids up z. Signs of parameters do not turn it over.

mod arc;
#[cfg(test)]
mod tests;

use self::arc::{arc, revolved};
use crate::nurbs::{Homogeneous, NurbsError, raised};
use crate::shape::RationalPatch;

/// A quadric. Angles are in degrees; sweeps of 360° or more are whole turns; the order of `z_min` and `z_max`, and of
/// `phi_min` and `phi_max`, does not matter, nor does the sign of a radius.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Quadric {
    /// A sphere about the origin, cut off below and above.
    Sphere {
        /// Radius.
        radius: f64,
        /// Where it starts; −radius or less is the lower pole.
        z_min: f64,
        /// Where it ends.
        z_max: f64,
        /// How far around it goes.
        theta_max: f64,
    },
    /// A cylinder, open at both ends.
    Cylinder {
        /// Radius.
        radius: f64,
        /// Where it starts.
        z_min: f64,
        /// Where it ends.
        z_max: f64,
        /// How far around it goes.
        theta_max: f64,
    },
    /// A cone, open below.
    Cone {
        /// z of its tip.
        height: f64,
        /// Radius at z = 0.
        radius: f64,
        /// How far around it goes.
        theta_max: f64,
    },
    /// A torus.
    Torus {
        /// Radius of the circle in its middle.
        major_radius: f64,
        /// Radius of the circle that is turned.
        minor_radius: f64,
        /// Where on the latter it starts, from the outermost point upwards.
        phi_min: f64,
        /// Where on the latter it ends.
        phi_max: f64,
        /// How far around it goes.
        theta_max: f64,
    },
    /// A disk.
    Disk {
        /// Its z.
        height: f64,
        /// Radius.
        radius: f64,
        /// How far around it goes.
        theta_max: f64,
    },
    /// What a line becomes that is turned.
    Hyperboloid {
        /// One end of the line.
        point1: [f64; 3],
        /// The other end.
        point2: [f64; 3],
        /// How far around it goes.
        theta_max: f64,
    },
    /// A paraboloid with its apex in the origin.
    Paraboloid {
        /// Radius at `z_max`.
        r_max: f64,
        /// Where it starts; 0 is the apex.
        z_min: f64,
        /// Where it ends.
        z_max: f64,
        /// How far around it goes.
        theta_max: f64,
    },
}

/// Why a quadric cannot be drawn.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum QuadricError {
    /// A parameter is NaN, infinite or too large.
    #[error("{name} is {value}, which is not a finite number that single precision has")]
    NotFinite {
        /// The parameter.
        name: &'static str,
        /// Its value.
        value: f64,
    },
    /// A parameter leaves nothing of the surface.
    #[error("{name} is 0, which leaves nothing to be drawn")]
    Zero {
        /// The parameter.
        name: &'static str,
    },
    /// The ends of a range leave nothing of the surface.
    #[error("nothing of the surface is between {least} = {from} and {most} = {to}")]
    Empty {
        /// Parameter for the lower end.
        least: &'static str,
        /// Parameter for the upper end.
        most: &'static str,
        /// Value of the former.
        from: f64,
        /// Value of the latter.
        to: f64,
    },
    /// A paraboloid on both sides of its apex.
    #[error("z_min = {z_min} and z_max = {z_max} are on different sides of the paraboloid's apex at 0")]
    Apex {
        /// Where it should start.
        z_min: f64,
        /// Where it should end.
        z_max: f64,
    },
    /// Points too far away for single precision.
    #[error(transparent)]
    Net(#[from] NurbsError),
}

/// A curve beside the axis that is turned about it: cubic segments in a row.
type Profile = Vec<Homogeneous>;

impl Quadric {
    /// Its patches, u slower than v.
    ///
    /// # Errors
    /// [`QuadricError`], if a parameter is not finite, or nothing is left to be drawn.
    pub fn patches(&self) -> Result<Vec<RationalPatch>, QuadricError> {
        self.check()?;
        let (profile, theta_max) = self.profile()?;
        let sweep = theta_max.clamp(-360.0, 360.0);
        let mut patches = revolved(&profile, sweep).patches()?;
        if (sweep < 0.0) != self.is_inside_out(&profile) {
            patches.iter_mut().for_each(RationalPatch::reverse);
        }
        Ok(patches)
    }

    fn check(&self) -> Result<(), QuadricError> {
        for (name, value) in self.parameters() {
            if !(value as f32).is_finite() {
                return Err(QuadricError::NotFinite { name, value });
            }
            let may_be_zero =
                !matches!(name, "radius" | "major_radius" | "minor_radius" | "r_max" | "theta_max");
            if value == 0.0 && !may_be_zero {
                return Err(QuadricError::Zero { name });
            }
        }
        Ok(())
    }

    fn parameters(&self) -> Vec<(&'static str, f64)> {
        match *self {
            Self::Sphere { radius, z_min, z_max, theta_max }
            | Self::Cylinder { radius, z_min, z_max, theta_max } => {
                vec![("radius", radius), ("z_min", z_min), ("z_max", z_max), ("theta_max", theta_max)]
            }
            Self::Cone { height, radius, theta_max } | Self::Disk { height, radius, theta_max } => {
                vec![("height", height), ("radius", radius), ("theta_max", theta_max)]
            }
            Self::Torus { major_radius, minor_radius, phi_min, phi_max, theta_max } => vec![
                ("major_radius", major_radius),
                ("minor_radius", minor_radius),
                ("phi_min", phi_min),
                ("phi_max", phi_max),
                ("theta_max", theta_max),
            ],
            Self::Hyperboloid { point1, point2, theta_max } => {
                let ends = point1.map(|c| ("point1", c)).into_iter().chain(point2.map(|c| ("point2", c)));
                ends.chain([("theta_max", theta_max)]).collect()
            }
            Self::Paraboloid { r_max, z_min, z_max, theta_max } => {
                vec![("r_max", r_max), ("z_min", z_min), ("z_max", z_max), ("theta_max", theta_max)]
            }
        }
    }

    /// What is turned, and how far.
    fn profile(&self) -> Result<(Profile, f64), QuadricError> {
        Ok(match *self {
            Self::Sphere { radius, z_min, z_max, theta_max } => {
                (meridian(radius.abs(), z_min, z_max)?, theta_max)
            }
            Self::Cylinder { radius, z_min, z_max, theta_max } => {
                let (low, high) = ordered(["z_min", "z_max"], z_min, z_max)?;
                (line([radius.abs(), 0.0, low], [radius.abs(), 0.0, high]), theta_max)
            }
            Self::Cone { height, radius, theta_max } => {
                (line([radius.abs(), 0.0, 0.0], [0.0, 0.0, height]), theta_max)
            }
            Self::Disk { height, radius, theta_max } => {
                (line([radius.abs(), 0.0, height], [0.0, 0.0, height]), theta_max)
            }
            Self::Torus { major_radius, minor_radius, phi_min, phi_max, theta_max } => {
                let (start, end) = ordered(["phi_min", "phi_max"], phi_min, phi_max)?;
                (ring(major_radius.abs(), minor_radius.abs(), start, end), theta_max)
            }
            Self::Hyperboloid { point1, point2, theta_max } => {
                if point1 == point2 {
                    return Err(QuadricError::Zero { name: "the length from point1 to point2" });
                }
                (line(point1, point2), theta_max)
            }
            Self::Paraboloid { r_max, z_min, z_max, theta_max } => {
                (parabola(r_max.abs(), z_min, z_max)?, theta_max)
            }
        })
    }

    /// Is the front of its profile, turned counter-clockwise, the inner side? A line's is if it runs down, or outwards
    /// where it is level; all others run the right way.
    fn is_inside_out(&self, profile: &[Homogeneous]) -> bool {
        let (Some(first), Some(last)) = (profile.first(), profile.last()) else { return false };
        let distance = |point: &Homogeneous| point[0] * point[0] + point[1] * point[1];
        let (rise, outwards) = (last[2] - first[2], distance(last) - distance(first));
        let is_arc = matches!(self, Self::Sphere { .. } | Self::Torus { .. });
        !is_arc && (rise < 0.0 || (rise == 0.0 && outwards > 0.0))
    }
}

fn ordered([least, most]: [&'static str; 2], from: f64, to: f64) -> Result<(f64, f64), QuadricError> {
    if from == to {
        Err(QuadricError::Empty { least, most, from, to })
    } else {
        Ok((from.min(to), from.max(to)))
    }
}

fn line(from: [f64; 3], to: [f64; 3]) -> Profile {
    raised(&[from, to].map(|[x, y, z]| [x, y, z, 1.0])).to_vec()
}

/// Part of a half circle from the lower pole to the upper one.
fn meridian(radius: f64, z_min: f64, z_max: f64) -> Result<Profile, QuadricError> {
    let (low, high) = ordered(["z_min", "z_max"], z_min, z_max)?;
    let latitude = |z: f64| libm::asin((z / radius).clamp(-1.0, 1.0)).to_degrees();
    let (start, end) = (latitude(low), latitude(high));
    // Both may be beyond the same pole.
    if start == end {
        return Err(QuadricError::Empty { least: "z_min", most: "z_max", from: z_min, to: z_max });
    }
    Ok(arc(start, end - start).into_iter().map(|[c, s, w]| [radius * c, 0.0, radius * s, w]).collect())
}

fn ring(major: f64, minor: f64, start: f64, end: f64) -> Profile {
    let circle = arc(start, (end - start).min(360.0));
    circle.into_iter().map(|[c, s, w]| [major * w + minor * c, 0.0, minor * s, w]).collect()
}

/// z = `z_max` · (r / `r_max`)²: a quadratic Bézier curve, in whose middle is the product of the radii at its ends.
fn parabola(r_max: f64, z_min: f64, z_max: f64) -> Result<Profile, QuadricError> {
    if z_max == 0.0 {
        return Err(QuadricError::Zero { name: "z_max" });
    }
    if z_min / z_max < 0.0 {
        return Err(QuadricError::Apex { z_min, z_max });
    }
    ordered(["z_min", "z_max"], z_min, z_max)?;
    let (low, high) = ((z_min / z_max).min(1.0), (z_min / z_max).max(1.0));
    let (from, to) = (low.sqrt(), high.sqrt());
    let point = |r: f64, square: f64| [r_max * r, 0.0, z_max * square, 1.0];
    Ok(raised(&[point(from, low), point(0.5 * (from + to), from * to), point(to, high)]).to_vec())
}
