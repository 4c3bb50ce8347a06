//! Requests that move things: each is carried out before those that stand before it (RenderMan Interface 3.2, section
//! 4.3).

use glam::{DAffine3, DMat3, DMat4, DVec3};

use super::reader::{Phase, Reader};
use super::request::{MAX_NUMBER, Request};
use crate::error::Result;

impl Reader {
    /// Carries out a request of this kind, or says that it is not.
    pub(super) fn transform(&mut self, request: &mut Request) -> Result<bool> {
        let moved = match request.name.as_str() {
            "Identity" => Some(DAffine3::IDENTITY),
            "Transform" => Some(matrix(request)?),
            "ConcatTransform" => Some(self.attributes.transform * matrix(request)?),
            "Translate" => {
                let by = DVec3::from(request.list::<3>("translation")?);
                Some(self.attributes.transform * DAffine3::from_translation(by))
            }
            "Scale" => {
                let by = DVec3::from(request.list::<3>("scale")?);
                Some(self.attributes.transform * DAffine3::from_scale(by))
            }
            "Rotate" => Some(self.attributes.transform * rotation(request)?),
            "Skew" => Some(self.attributes.transform * skew(request)?),
            _ => None,
        };
        match (moved, request.name.as_str()) {
            (Some(moved), _) => self.attributes.transform = sound(request, moved)?,
            (None, "ReverseOrientation") => self.attributes.is_reversed = !self.attributes.is_reversed,
            (None, "Orientation") => self.attributes.is_reversed = self.orientation(request)?,
            (None, "Sides") => self.sides(request)?,
            _ => return Ok(false),
        }
        request.end()?;
        Ok(true)
    }

    fn orientation(&self, request: &mut Request) -> Result<bool> {
        let is_left_handed = self.to_camera().matrix3.determinant() > 0.0;
        match request.text("orientation")?.as_str() {
            "outside" => Ok(false),
            "inside" => Ok(true),
            "lh" => Ok(!is_left_handed),
            "rh" => Ok(is_left_handed),
            _ => {
                Err(request.wrong("this is no orientation", "use \"outside\", \"inside\", \"lh\" or \"rh\""))
            }
        }
    }

    fn to_camera(&self) -> DAffine3 {
        match (self.phase, &self.scene.camera) {
            (Phase::World, Some(camera)) => camera.from_world * self.attributes.transform,
            _ => self.attributes.transform,
        }
    }

    fn sides(&mut self, request: &mut Request) -> Result<()> {
        if request.number("number of sides")? < 2.0 {
            self.warnings.add(&request.place, "both sides of all surfaces are drawn, whatever `Sides`");
        }
        Ok(())
    }
}

/// Sixteen numbers, row by row; points are rows that stand to the left of it.
fn matrix(request: &mut Request) -> Result<DAffine3> {
    let rows = request.list::<16>("matrix")?;
    let scale = rows[15];
    if [rows[3], rows[7], rows[11]] != [0.0; 3] || scale == 0.0 {
        let problem = "its matrix is one of perspective: its last column is not 0 0 0 1";
        return Err(request.wrong(problem, "use `Projection` for perspective"));
    }
    let columns = rows.map(|number| number / scale);
    Ok(DAffine3::from_mat4(DMat4::from_cols_array(&columns)))
}

/// Degrees, and the axis.
fn rotation(request: &mut Request) -> Result<DAffine3> {
    let [degrees, x, y, z] = request.list("angle and axis")?;
    let axis = direction(request, [x, y, z])?;
    let (sine, cosine) = turn(degrees);
    let column = |v: DVec3| v * cosine + axis.cross(v) * sine + axis * (axis.dot(v) * (1.0 - cosine));
    Ok(DAffine3::from_mat3(DMat3::from_cols(column(DVec3::X), column(DVec3::Y), column(DVec3::Z))))
}

/// Sine and cosine; those of whole quarters of a turn are exact.
fn turn(degrees: f64) -> (f64, f64) {
    let degrees = degrees % 360.0;
    let quarters = degrees / 90.0;
    if quarters.fract() != 0.0 {
        return libm::sincos(degrees.to_radians());
    }
    match (quarters as i32).rem_euclid(4) {
        0 => (0.0, 1.0),
        1 => (1.0, 0.0),
        2 => (0.0, -1.0),
        _ => (-1.0, 0.0),
    }
}

/// Moves points along one axis, so that another one is turned towards it by so many degrees.
fn skew(request: &mut Request) -> Result<DAffine3> {
    let [degrees, a, b, c, x, y, z] = request.list("angle and axes")?;
    let (from, along) = (direction(request, [a, b, c])?, direction(request, [x, y, z])?);
    let between = libm::acos(from.dot(along).clamp(-1.0, 1.0));
    let left = between - degrees.to_radians();
    let across = from - along * from.dot(along);
    let sine = across.length();
    if !(left > 1.0e-6 && left < std::f64::consts::PI - 1.0e-6 && sine > 1.0e-6) {
        let problem = "the angle is as large as that between the axes, or larger";
        return Err(request.wrong(problem, "use a smaller angle, and axes that are not parallel"));
    }
    // As far as `from` has to be moved, for each unit that it reaches across.
    let slope = 1.0 / libm::tan(left) - from.dot(along) / sine;
    let across = across / sine;
    let column = |v: DVec3| v + along * (slope * across.dot(v));
    Ok(DAffine3::from_mat3(DMat3::from_cols(column(DVec3::X), column(DVec3::Y), column(DVec3::Z))))
}

fn direction(request: &Request, vector: [f64; 3]) -> Result<DVec3> {
    let unit = DVec3::from(vector).try_normalize();
    unit.ok_or_else(|| request.wrong("its axis has no length", "use another one, for example 0 0 1"))
}

/// Refuses transforms that lead beyond what can be drawn.
fn sound(request: &Request, transform: DAffine3) -> Result<DAffine3> {
    if transform.to_cols_array().iter().all(|number| number.abs() <= MAX_NUMBER) {
        return Ok(transform);
    }
    Err(request.wrong("with it a transform has a number beyond 1e12", "use smaller numbers"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rib::tests::{read, wrong};

    /// Where the first object has a point.
    fn placed(requests: &str, point: [f64; 3]) -> [f64; 3] {
        let scene = read(&format!("{requests}\nSphere 1 -1 1 360"));
        scene.objects[0].to_world.transform_point3(point.into()).into()
    }

    #[test]
    fn later_requests_are_carried_out_first() {
        assert_eq!(placed("Translate 1 0 0 Scale 2 2 2", [1.0, 0.0, 0.0]), [3.0, 0.0, 0.0]);
        assert_eq!(placed("Scale 2 2 2 Translate [1 0 0]", [1.0, 0.0, 0.0]), [4.0, 0.0, 0.0]);
        assert_eq!(placed("Translate 9 9 9 Identity Translate 1 0 0", [0.0; 3]), [1.0, 0.0, 0.0]);
    }

    #[test]
    fn rotations_turn_each_axis_to_the_next_one() {
        assert_eq!(placed("Rotate 90 0 0 1", [1.0, 0.0, 0.0]), [0.0, 1.0, 0.0]);
        assert_eq!(placed("Rotate 90 2 0 0", [0.0, 1.0, 0.0]), [0.0, 0.0, 1.0]);
        assert_eq!(placed("Rotate -270 0 1 0", [0.0, 0.0, 1.0]), [1.0, 0.0, 0.0]);
        let [x, y, z] = placed("Rotate 30 0 0 1", [2.0, 0.0, 5.0]);
        assert!((x - 3.0_f64.sqrt()).abs() < 1e-12 && (y - 1.0).abs() < 1e-12 && z == 5.0);
    }

    #[test]
    fn matrices_have_their_translation_in_the_last_row() {
        let matrix = "[0 1 0 0  -1 0 0 0  0 0 1 0  5 6 7 1]";
        assert_eq!(placed(&format!("Translate 1 0 0 Transform {matrix}"), [1.0, 0.0, 0.0]), [5.0, 7.0, 7.0]);
        assert_eq!(
            placed(&format!("Translate 1 0 0 ConcatTransform {matrix}"), [1.0, 0.0, 0.0]),
            [6.0, 7.0, 7.0]
        );
        assert!(wrong("Transform [1 0 0 1 0 1 0 0 0 0 1 0 0 0 0 1]").contains("perspective"));
        assert!(wrong("Transform [1 0 0 1]").contains("has 4 numbers"));
    }

    #[test]
    fn a_skew_turns_the_first_axis_and_moves_points_along_the_second() {
        let near = |a: [f64; 3], b: [f64; 3]| {
            assert!((DVec3::from(a) - DVec3::from(b)).length() < 1e-12, "{a:?} is not {b:?}");
        };
        near(placed("Skew 45 0 1 0 1 0 0", [0.0, 2.0, 0.0]), [2.0, 2.0, 0.0]);
        near(placed("Skew 45 0 1 0 1 0 0", [3.0, 0.0, 1.0]), [3.0, 0.0, 1.0]);
        // Axes that are not at right angles: 1 1 0 comes to lie at 15 degrees from x.
        near(
            placed("Skew 30 1 1 0 1 0 0", [1.0, 1.0, 0.0]),
            [1.0 / libm::tan(15.0_f64.to_radians()), 1.0, 0.0],
        );
        assert!(wrong("Skew 90 0 1 0 1 0 0").contains("angle"));
    }

    #[test]
    fn the_orientation_is_said_of_space_as_it_is_or_relative_to_the_camera() {
        let reversed = |requests: &str| read(&format!("{requests} Sphere 1 -1 1 360")).objects[0].is_reversed;
        assert!(!reversed(""));
        assert!(reversed("ReverseOrientation"));
        assert!(!reversed("ReverseOrientation ReverseOrientation"));
        assert!(reversed("Orientation \"inside\""));
        assert!(!reversed("Orientation \"lh\""));
        assert!(reversed("Orientation \"rh\""));
        assert!(!reversed("Scale 1 1 -1 Orientation \"rh\""));
    }

    #[test]
    fn transforms_that_cannot_be_are_refused() {
        assert!(wrong("Rotate 10 0 0 0").contains("no length"));
        assert!(wrong("Scale 1e9 1 1 Scale 1e9 1 1").contains("beyond 1e12"));
        assert!(wrong("Translate 1 2").contains("has 2 numbers"));
        assert!(wrong("Translate 1 2 3 4").contains("no argument"));
        assert!(wrong("Scale 0 1 1 WorldBegin").contains("undone"));
    }
}
