//! What a `.mscene` file says, checked for form but not yet for sense: every number is finite, every patch whole.

use glam::{DAffine3, DQuat, DVec3, Vec3};

use crate::gregory::GregoryPatch;
use crate::shape::BezierPatch;

/// All of a file.
#[derive(Clone, Debug, PartialEq)]
pub struct Mscene {
    /// Meshes, found by their names.
    pub meshes: Vec<Mesh>,
    /// Lights.
    pub lights: Vec<LightEntry>,
    /// Objects: a mesh each, with a place and a colour.
    pub objects: Vec<ObjectEntry>,
    /// Cameras, of which the first is used.
    pub cameras: Vec<CameraEntry>,
}

/// Patches of one type.
#[derive(Clone, Debug, PartialEq)]
pub enum MeshPatches {
    /// 16 points each.
    Bezier(Vec<BezierPatch>),
    /// 20 points each.
    Gregory(Vec<GregoryPatch>),
}

/// Patches with a name.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    /// What objects call it.
    pub name: String,
    /// At least one patch.
    pub patches: MeshPatches,
}

/// Where something stands and how it is turned: first turned, then moved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// Moves by this much.
    pub translation: DVec3,
    /// Of length 1.
    pub rotation: DQuat,
}

impl Placement {
    /// To world space.
    #[must_use]
    pub fn to_world(&self) -> DAffine3 {
        DAffine3::from_rotation_translation(self.rotation, self.translation)
    }

    /// From world space.
    #[must_use]
    pub fn from_world(&self) -> DAffine3 {
        let back = self.rotation.conjugate();
        DAffine3::from_rotation_translation(back, -(back * self.translation))
    }

    /// Towards where something placed like this looks or shines: its own -z, in world space.
    #[must_use]
    pub fn forward(&self) -> DVec3 {
        self.rotation * -DVec3::Z
    }
}

/// A camera.
#[derive(Clone, Debug, PartialEq)]
pub struct CameraEntry {
    /// For messages.
    pub name: String,
    /// It looks along its -z; y is up.
    pub placement: Placement,
    /// Distance of the near plane.
    pub near: f64,
    /// Vertical field of view in degrees.
    pub fovy: f64,
}

/// What kind of light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LightType {
    /// From where it stands, in all directions.
    Point,
    /// Parallel, along its -z.
    Directional,
    /// From a whole sky, brightest along its -z.
    Hemi,
}

/// A light.
#[derive(Clone, Debug, PartialEq)]
pub struct LightEntry {
    /// For messages.
    pub name: String,
    /// Where it stands and shines.
    pub placement: Placement,
    /// Colour times intensity, linear RGB.
    pub colour: Vec3,
    /// What kind.
    pub kind: LightType,
}

/// An object.
#[derive(Clone, Debug, PartialEq)]
pub struct ObjectEntry {
    /// For messages.
    pub name: String,
    /// Where it stands.
    pub placement: Placement,
    /// The name of its mesh.
    pub mesh: String,
    /// Diffuse colour, linear RGB.
    pub colour: Vec3,
}
