//! What a RIB file says, checked for form: every number is finite, every list as long as it should be.

use std::sync::Arc;

use glam::DAffine3;

use super::camera::RibCamera;
use super::place::Place;
use crate::cage::Cage;

/// All of a file, and of the archives it reads.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RibScene {
    /// The camera; without one the file does not say from where it is seen.
    pub camera: Option<RibCamera>,
    /// The lights that are on.
    pub lights: Vec<RibLight>,
    /// What is to be drawn.
    pub objects: Vec<RibObject>,
    /// Colour where nothing is, linear RGB.
    pub background: Option<[f64; 3]>,
    /// What was not understood or cannot be drawn as it should, once each.
    pub warnings: Vec<String>,
}

/// Geometry with its place and looks.
#[derive(Clone, Debug, PartialEq)]
pub struct RibObject {
    /// Object space to world space.
    pub to_world: DAffine3,
    /// Colour, linear RGB.
    pub colour: [f64; 3],
    /// Share of what is behind it that it hides: above 0, to 1.
    pub opacity: f64,
    /// How it reflects light.
    pub surface: RibSurface,
    /// Is its front the side from which v runs upwards where u runs to the *left*? Said of object space as it is written,
    /// with x to the right where y runs upwards and z towards the eye.
    pub is_reversed: bool,
    /// Its geometry; instances have the same one.
    pub geometry: Arc<RibGeometry>,
    /// Its request.
    pub place: Place,
}

/// How a surface reflects light: the shares of the standard shaders (RenderMan Interface 3.2, appendix A.1). Light from
/// everywhere is reflected as diffuse light is, whatever `Ka`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RibSurface {
    /// `Kd`: share of diffuse light.
    pub diffuse: f64,
    /// `Ks`: strength of the highlight.
    pub specular: f64,
    /// `roughness`: how wide the highlight is.
    pub roughness: f64,
}

/// A light.
#[derive(Clone, Debug, PartialEq)]
pub struct RibLight {
    /// What kind.
    pub kind: RibLightKind,
    /// Colour times intensity, linear RGB.
    pub colour: [f64; 3],
    /// Its request.
    pub place: Place,
}

/// Kinds of light, in world space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RibLightKind {
    /// From everywhere.
    Ambient,
    /// Parallel.
    Distant {
        /// Direction from the scene to the light; need not be unit.
        to_light: [f64; 3],
    },
    /// From a point; its brightness falls with the square of the distance, and is that of its colour at distance 1.
    Point {
        /// Where it stands.
        position: [f64; 3],
    },
}

/// Geometry, in object space.
#[derive(Clone, Debug, PartialEq)]
pub enum RibGeometry {
    /// `Patch` and `PatchMesh`.
    Patches(RibPatches),
    /// `NuPatch`.
    NuPatch(RibNuPatch),
    /// `SubdivisionMesh`.
    Subdivision(Cage),
    /// `Polygon`, `PointsPolygons`, and those of general polygons that have no holes.
    Polygons(Cage),
    /// The seven quadrics.
    Quadric(RibQuadric),
    /// `Curves`.
    Curves(RibCurves),
}

/// Cubic bases.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum RibBasis {
    /// Bernstein's polynomials.
    #[default]
    Bezier,
    /// Uniform B-splines.
    BSpline,
    /// Through all points but the first and the last.
    CatmullRom,
    /// Points and tangents in turn.
    Hermite,
    /// Coefficients of u³, u², u and 1.
    Power,
}

/// A mesh of patches. A single patch is one too: 4 × 4 points, or 2 × 2.
#[derive(Clone, Debug, PartialEq)]
pub struct RibPatches {
    /// Bilinear or bicubic?
    pub is_linear: bool,
    /// Along u and v; of bicubic ones only.
    pub bases: [RibBasis; 2],
    /// From a patch to its neighbour, in points; along u and v; of bicubic ones only.
    pub steps: [usize; 2],
    /// Number of points along u and v.
    pub counts: [usize; 2],
    /// Is it closed, along u and v?
    pub is_periodic: [bool; 2],
    /// x, y, z and weight, not multiplied by it; u runs fastest.
    pub points: Vec<[f64; 4]>,
}

/// A surface of non-uniform B-splines.
#[derive(Clone, Debug, PartialEq)]
pub struct RibNuPatch {
    /// Number of points along u and v.
    pub counts: [usize; 2],
    /// Degree + 1, along u and v.
    pub orders: [usize; 2],
    /// Knots along u and v: as many as points and order together.
    pub knots: [Vec<f64>; 2],
    /// First and last parameter to be drawn, along u and v.
    pub ranges: [[f64; 2]; 2],
    /// x, y, z and weight, not multiplied by it; u runs fastest.
    pub points: Vec<[f64; 4]>,
}

/// The quadrics; angles in degrees (RenderMan Interface 3.2, section 5.3).
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(missing_docs)] // As the RenderMan Interface names them.
pub enum RibQuadric {
    Sphere { radius: f64, z_min: f64, z_max: f64, theta_max: f64 },
    Cone { height: f64, radius: f64, theta_max: f64 },
    Cylinder { radius: f64, z_min: f64, z_max: f64, theta_max: f64 },
    Hyperboloid { point1: [f64; 3], point2: [f64; 3], theta_max: f64 },
    Paraboloid { r_max: f64, z_min: f64, z_max: f64, theta_max: f64 },
    Disk { height: f64, radius: f64, theta_max: f64 },
    Torus { major: f64, minor: f64, phi_min: f64, phi_max: f64, theta_max: f64 },
}

/// Curves of one kind.
#[derive(Clone, Debug, PartialEq)]
pub struct RibCurves {
    /// Straight lines or cubic curves?
    pub is_linear: bool,
    /// Of cubic ones only.
    pub basis: RibBasis,
    /// From a segment to the next, in points; of cubic ones only.
    pub step: usize,
    /// Are they closed?
    pub is_periodic: bool,
    /// The curves.
    pub curves: Vec<RibCurve>,
}

/// A curve.
#[derive(Clone, Debug, PartialEq)]
pub struct RibCurve {
    /// Its points.
    pub points: Vec<[f64; 3]>,
    /// Its width: one, or one at each end of a segment, which neighbours share.
    pub widths: Vec<f64>,
}
