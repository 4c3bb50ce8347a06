//! Polygons and meshes of them (RenderMan Interface 3.2, section 5.1).

use super::geometry::{Read, points};
use super::model::RibGeometry;
use super::parameters::{Class, Declarations, Parameters};
use super::request::Request;
use crate::cage::Cage;
use crate::error::{Error, Result};

/// `Polygon`: its points in order.
pub(super) fn polygon(request: &mut Request, known: &Declarations) -> Result<Read> {
    let mut parameters = Parameters::of(request, known)?;
    let positions = points(request, &mut parameters)?;
    let count = positions.len() as u32;
    let mesh = Mesh { face_sizes: vec![count], corners: (0..count).collect(), positions };
    mesh.read(request, parameters)
}

/// `GeneralPolygon`: loops of points, of which only one can be drawn.
pub(super) fn general_polygon(request: &mut Request, known: &Declarations) -> Result<Read> {
    let loops = request.indices("numbers of points")?;
    if loops.len() != 1 {
        return Err(holes(request));
    }
    let mut parameters = Parameters::of(request, known)?;
    let positions = points(request, &mut parameters)?;
    let mesh = Mesh { corners: (0..positions.len() as u32).collect(), face_sizes: loops, positions };
    mesh.read(request, parameters)
}

/// `PointsPolygons`: polygons that share points.
pub(super) fn points_polygons(request: &mut Request, known: &Declarations) -> Result<Read> {
    let face_sizes = request.indices("numbers of points")?;
    mesh(request, known, face_sizes)
}

/// `PointsGeneralPolygons`: the same, with loops.
pub(super) fn points_general_polygons(request: &mut Request, known: &Declarations) -> Result<Read> {
    let loops = request.indices("numbers of loops")?;
    if loops.iter().any(|&count| count != 1) {
        return Err(holes(request));
    }
    let face_sizes = request.indices("numbers of points")?;
    if face_sizes.len() != loops.len() {
        let problem = format_args!("it has {} polygons and {} loops", loops.len(), face_sizes.len());
        return Err(request.wrong(problem, "give a number of points for each loop"));
    }
    mesh(request, known, face_sizes)
}

fn mesh(request: &mut Request, known: &Declarations, face_sizes: Vec<u32>) -> Result<Read> {
    let corners = request.indices("points of polygons")?;
    let mut parameters = Parameters::of(request, known)?;
    let positions = points(request, &mut parameters)?;
    Mesh { face_sizes, corners, positions }.read(request, parameters)
}

fn holes(request: &Request) -> Error {
    request.wrong("polygons with holes are not supported", "cut them into polygons of one loop each")
}

/// Faces and their corners.
pub(super) struct Mesh {
    pub(super) face_sizes: Vec<u32>,
    pub(super) corners: Vec<u32>,
    pub(super) positions: Vec<[f64; 3]>,
}

impl Mesh {
    fn read(self, request: &Request, mut parameters: Parameters) -> Result<Read> {
        let cage = self.cage(request, &mut parameters)?;
        Ok((RibGeometry::Polygons(cage), parameters))
    }

    /// The same with texture coordinates, once it is known to be whole.
    pub(super) fn cage(self, request: &Request, parameters: &mut Parameters) -> Result<Cage> {
        self.check(request)?;
        let Self { face_sizes, corners, positions } = self;
        let mut cage = Cage { face_sizes, corners, positions, ..Cage::default() };
        add_texture(&mut cage, request, parameters)?;
        Ok(cage)
    }

    fn check(&self, request: &Request) -> Result<()> {
        if let Some(face) = self.face_sizes.iter().position(|&size| size < 3) {
            let problem = format_args!("polygon {} has {} corners", face + 1, self.face_sizes[face]);
            return Err(request.wrong(problem, "a polygon has 3 corners or more"));
        }
        let claimed: u64 = self.face_sizes.iter().map(|&size| u64::from(size)).sum();
        if claimed != self.corners.len() as u64 || claimed == 0 {
            let problem = format_args!("it has {} corners, and should have {claimed}", self.corners.len());
            return Err(request.wrong(problem, "give a point for each corner of each polygon"));
        }
        let count = self.positions.len();
        if let Some(corner) = self.corners.iter().find(|&&corner| corner as usize >= count) {
            let problem = format_args!("a corner is point {corner}, and there are {count}");
            return Err(request.wrong(problem, "points are counted from 0"));
        }
        Ok(())
    }
}

/// From `st`, one at each corner of each face or one at each point.
fn add_texture(cage: &mut Cage, request: &Request, parameters: &mut Parameters) -> Result<()> {
    let Some(parameter) = parameters.take("st") else { return Ok(()) };
    let is_corners = parameter.declaration.class == Class::FaceVarying;
    let texture: Vec<[f64; 2]> = parameter.values()?;
    let expected = if is_corners { cage.corners.len() } else { cage.positions.len() };
    if texture.len() != expected {
        let problem = format_args!("`st` has {} values, and should have {expected}", texture.len());
        return Err(request.wrong(problem, "give one for each point, or a facevarying one for each corner"));
    }
    cage.texture = texture.iter().map(|st| st.map(|number| number as f32)).collect();
    cage.texture_corners =
        if is_corners { (0..cage.corners.len() as u32).collect() } else { cage.corners.clone() };
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rib::tests::{geometry, wrong};

    const SQUARE: &str = "\"P\" [0 0 0  1 0 0  1 1 0  0 1 0]";

    fn cage(request: &str) -> Cage {
        match geometry(request) {
            RibGeometry::Polygons(cage) => cage,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn all_ways_to_write_a_square_give_the_same() {
        let square = cage(&format!("Polygon {SQUARE}"));
        assert_eq!((&square.face_sizes[..], &square.corners[..]), (&[4][..], &[0, 1, 2, 3][..]));
        assert_eq!(square.positions[2], [1.0, 1.0, 0.0]);
        assert_eq!(cage(&format!("GeneralPolygon [4] {SQUARE}")), square);
        assert_eq!(cage(&format!("PointsPolygons [4] [0 1 2 3] {SQUARE}")), square);
        assert_eq!(cage(&format!("PointsGeneralPolygons [1] [4] [0 1 2 3] {SQUARE}")), square);
    }

    #[test]
    fn texture_coordinates_stand_at_points_or_at_corners() {
        let two = |st: &str| cage(&format!("PointsPolygons [3 3] [0 1 2 0 2 3] {SQUARE} {st}"));
        let at_points = two("\"st\" [0 0 1 0 1 1 0 1]");
        assert_eq!((at_points.texture.len(), &at_points.texture_corners), (4, &at_points.corners));
        let at_corners = two("\"facevarying float[2] st\" [0 0 1 0 1 1 0 0 1 1 0 1]");
        assert_eq!((at_corners.texture.len(), &at_corners.texture_corners[..]), (6, &[0, 1, 2, 3, 4, 5][..]));
        assert!(wrong(&format!("Polygon {SQUARE} \"st\" [0 0]")).contains("`st` has 1 values"));
    }

    #[test]
    fn meshes_that_are_not_whole_are_refused() {
        for (request, part) in [
            ("Polygon \"P\" [0 0 0 1 0 0]".to_owned(), "polygon 1 has 2 corners"),
            ("Polygon \"P\" [0 0 0 1 0 0 1]".to_owned(), "`P` has 7 numbers"),
            (format!("PointsPolygons [4] [0 1 2] {SQUARE}"), "3 corners, and should have 4"),
            (format!("PointsPolygons [4 4294967295] [0 1 2] {SQUARE}"), "should have 4294967299"),
            (format!("PointsPolygons [] [] {SQUARE}"), "0 corners"),
            (format!("PointsPolygons [4] [0 1 2 4] {SQUARE}"), "a corner is point 4, and there are 4"),
            (format!("PointsPolygons [4] [0 1 2 -1] {SQUARE}"), "-1 is among its points"),
            (format!("PointsPolygons [4] [0 1 2 1.5] {SQUARE}"), "1.5 is among its points"),
            (format!("GeneralPolygon [3 1] {SQUARE}"), "holes"),
            (format!("PointsGeneralPolygons [2] [3 3] [0 1 2 0 1 2] {SQUARE}"), "holes"),
            (format!("PointsGeneralPolygons [1] [4 4] [0 1 2 3] {SQUARE}"), "1 polygons and 2 loops"),
        ] {
            assert!(wrong(&request).contains(part), "{}", wrong(&request));
        }
    }
}
