//! What a RIB file has set so far: the graphics state, and the blocks that save and restore it (RenderMan Interface
//! 3.2, section 4).

use std::sync::Arc;

use glam::DAffine3;

use super::model::{RibBasis, RibGeometry, RibObject, RibSurface};
use super::place::Place;

/// What blocks save and restore.
#[derive(Clone, Debug)]
pub(super) struct Attributes {
    /// From where requests stand now to the world; before `WorldBegin` to the camera.
    pub(super) transform: DAffine3,
    pub(super) looks: Looks,
    pub(super) is_reversed: bool,
    pub(super) bases: [RibBasis; 2],
    pub(super) steps: [usize; 2],
}

impl Default for Attributes {
    fn default() -> Self {
        Self {
            transform: DAffine3::IDENTITY,
            looks: Looks::default(),
            is_reversed: false,
            bases: [RibBasis::Bezier; 2],
            steps: [3; 2],
        }
    }
}

/// Looks, as far as they are set: parts of an object leave the rest to its instances.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Looks {
    pub(super) colour: Option<[f64; 3]>,
    pub(super) opacity: Option<f64>,
    pub(super) surface: Option<RibSurface>,
}

impl Looks {
    /// These, and where they are not set, others.
    pub(super) fn or(self, other: Self) -> Self {
        Self {
            colour: self.colour.or(other.colour),
            opacity: self.opacity.or(other.opacity),
            surface: self.surface.or(other.surface),
        }
    }
}

/// Geometry that may be part of an object.
#[derive(Clone, Debug)]
pub(super) struct Part {
    pub(super) transform: DAffine3,
    pub(super) looks: Looks,
    pub(super) is_reversed: bool,
    pub(super) geometry: Arc<RibGeometry>,
    pub(super) place: Place,
}

impl Part {
    pub(super) fn new(attributes: &Attributes, geometry: RibGeometry, place: Place) -> Self {
        let Attributes { transform, looks, is_reversed, .. } = *attributes;
        Self { transform, looks, is_reversed, geometry: Arc::new(geometry), place }
    }

    /// The same, as part of an instance.
    pub(super) fn within(&self, attributes: &Attributes) -> Self {
        Self {
            transform: attributes.transform * self.transform,
            looks: self.looks.or(attributes.looks),
            is_reversed: self.is_reversed != attributes.is_reversed,
            ..self.clone()
        }
    }

    /// With the looks that RenderMan's state has at first, where none are set.
    pub(super) fn object(self) -> RibObject {
        let Self { transform, looks, is_reversed, geometry, place } = self;
        RibObject {
            to_world: transform,
            colour: looks.colour.unwrap_or([1.0; 3]),
            opacity: looks.opacity.unwrap_or(1.0),
            surface: looks.surface.unwrap_or(RibSurface::DEFAULT),
            is_reversed,
            geometry,
            place,
        }
    }
}

impl RibSurface {
    /// The surface of what has no shader.
    pub const DEFAULT: Self = Self { diffuse: 0.8, specular: 0.0, roughness: 0.1 };
}

/// What begins and ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum BlockKind {
    Frame,
    World,
    Attribute,
    Transform,
    Object,
    Solid,
    Motion,
}

impl BlockKind {
    /// The request that begins or ends a block of this kind, and whether it begins.
    pub(super) fn of(request: &str) -> Option<(Self, bool)> {
        let kind = |name| {
            Some(match name {
                "Frame" => Self::Frame,
                "World" => Self::World,
                "Attribute" => Self::Attribute,
                "Transform" => Self::Transform,
                "Object" => Self::Object,
                "Solid" => Self::Solid,
                "Motion" => Self::Motion,
                _ => return None,
            })
        };
        match (request.strip_suffix("Begin"), request.strip_suffix("End")) {
            (Some(name), _) => kind(name).map(|kind| (kind, true)),
            (_, Some(name)) => kind(name).map(|kind| (kind, false)),
            _ => None,
        }
    }
}

/// A block that has begun.
#[derive(Debug)]
pub(super) struct Block {
    pub(super) kind: BlockKind,
    pub(super) name: String,
    pub(super) place: Place,
    /// The state before it.
    pub(super) saved: Attributes,
}
