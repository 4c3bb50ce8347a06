//! Files of geometry (`.bpt`, `.obj`) become shapes.

use std::path::Path;

use crate::cage::{Boundary, Cage, Options, convert};
use crate::error::{Error, Result};
use crate::nurbs::Nurbs;
use crate::obj::{self, FreeForm, Obj};
use crate::shape::{RationalPatch, Shape};
use crate::{bpt, polygon};

/// How geometry is read that can be read in several ways.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Reading {
    /// How often a Catmull-Clark cage is refined around what is not regular.
    pub cage: Options,
    /// How its surface ends, if not as the file says.
    pub boundary: Option<Boundary>,
    /// Are polygons drawn as they are, not as a cage?
    pub polygons: bool,
}

/// Told from time to time which share of a large file has been read.
pub type ReadProgress<'a> = &'a (dyn Fn(f32) + Sync);

/// Reads a file; what of it is not drawn is noted.
///
/// # Errors
/// [`Error::Read`], or [`Error::Format`] with the line.
pub(crate) fn read(
    path: &Path,
    reading: &Reading,
    progress: ReadProgress<'_>,
    notes: &mut Vec<String>,
) -> Result<Shape> {
    if path.extension().is_some_and(|extension| extension == "bpt") {
        return bpt::load(path).map(Shape::of_bezier);
    }
    let mut file = obj::load(path)?;
    notes.append(&mut file.warnings);
    shape_of(path, file, reading, progress)
}

/// Can a file of this name be read?
pub(crate) fn is_known(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension == "bpt" || extension == "obj")
}

/// The shape of an OBJ file: its cage and its surfaces.
fn shape_of(path: &Path, file: Obj, reading: &Reading, progress: ReadProgress<'_>) -> Result<Shape> {
    let mut shape = match &file.cage {
        Some(cage) if reading.polygons => polygons(path, cage)?,
        Some(cage) => of_cage(path, cage, reading, progress)?,
        None => Shape::default(),
    };
    let surfaces = surfaces(path, &file.surfaces)?;
    shape.is_polygons &= surfaces.patch_count() == 0;
    shape.bezier.extend(surfaces.bezier);
    shape.rational = surfaces.rational;
    if shape.patch_count() == 0 {
        let problem = "no face of the mesh has a surface";
        return Err(Error::format(path, 1, problem, "remove holes, or choose another boundary"));
    }
    Ok(shape)
}

fn of_cage(path: &Path, cage: &Cage, reading: &Reading, progress: ReadProgress<'_>) -> Result<Shape> {
    let own;
    let cage = match reading.boundary {
        Some(boundary) if boundary != cage.boundary => {
            own = Cage { boundary, ..cage.clone() };
            &own
        }
        _ => cage,
    };
    let patches = convert(cage, &reading.cage, progress).map_err(|error| error.in_file(path, cage))?;
    Ok(patches.into())
}

fn polygons(path: &Path, cage: &Cage) -> Result<Shape> {
    polygon::polygons(cage).map(Shape::of_polygons).map_err(|error| error.in_file(path, cage))
}

/// All free-form surfaces: of one kind, since they may share borders.
fn surfaces(path: &Path, surfaces: &[FreeForm]) -> Result<Shape> {
    let mut patches: Vec<RationalPatch> = Vec::new();
    for surface in surfaces {
        let nurbs = Nurbs {
            degree: surface.degree,
            knots: surface.spline_knots(),
            points: surface.points.clone(),
            range: surface.range,
        };
        let own = nurbs.patches().map_err(|error| {
            Error::format(
                path,
                surface.line,
                error.to_string(),
                "correct the surface's knots, range or weights",
            )
        })?;
        patches.extend(own);
    }
    Ok(Shape::of_rational(patches))
}
