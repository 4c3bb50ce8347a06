//! Carries out the requests of a file, one after the other.

use std::collections::HashMap;
use std::path::Path;

use glam::DAffine3;

use super::archive::Archives;
use super::lexer::Lexer;
use super::model::{RibGeometry, RibLight, RibScene};
use super::parameters::{Declarations, Parameters};
use super::place::quoted;
use super::request::Request;
use super::state::{Attributes, Block, Part};
use super::view::View;
use super::warnings::Warnings;
use crate::error::Result;

/// Most objects, instances among them: a small file can have an object of objects of objects.
const MAX_OBJECTS: usize = 2_000_000;

/// A light, and whether it is on.
#[derive(Debug)]
pub(super) struct Lamp {
    pub(super) light: RibLight,
    pub(super) handle: String,
    pub(super) is_on: bool,
}

/// An object that is being defined.
#[derive(Debug)]
pub(super) struct Definition {
    pub(super) handle: String,
    pub(super) parts: Vec<Part>,
}

/// Where in a file it is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Phase {
    /// Transforms lead to the camera.
    #[default]
    BeforeWorld,
    /// Transforms lead to the world.
    World,
    /// The world is complete.
    AfterWorld,
    /// What follows belongs to another frame.
    Done,
}

/// What is known so far.
#[derive(Debug, Default)]
pub(super) struct Reader {
    pub(super) phase: Phase,
    pub(super) attributes: Attributes,
    pub(super) blocks: Vec<Block>,
    pub(super) declarations: Declarations,
    pub(super) view: View,
    pub(super) scene: RibScene,
    pub(super) lamps: Vec<Lamp>,
    pub(super) parts: Vec<Part>,
    pub(super) definition: Option<Definition>,
    pub(super) definitions: HashMap<String, Vec<Part>>,
    pub(super) archives: Archives,
    pub(super) warnings: Warnings,
    /// Parts of objects and of the scene.
    part_count: usize,
    /// Has the motion block that is open had its request?
    pub(super) has_moved: bool,
}

impl Reader {
    /// For a file of this name.
    pub(super) fn new(path: &Path) -> Self {
        Self { archives: Archives::new(path), ..Self::default() }
    }

    /// All requests of a file or an archive.
    pub(super) fn run(&mut self, mut lexer: Lexer) -> Result<()> {
        while self.phase != Phase::Done
            && let Some(mut request) = lexer.request()?
        {
            if !self.is_later_motion(&request) {
                self.carry_out(&mut request, &mut lexer)?;
            }
        }
        Ok(())
    }

    /// What was read.
    pub(super) fn finish(mut self, end: &Lexer) -> Result<RibScene> {
        if let Some(block) = self.blocks.last().filter(|_| self.phase != Phase::Done) {
            let problem = format!("the block that {} begins here has no end", quoted(&block.name));
            return Err(block.place.wrong(problem, "is the file cut short?"));
        }
        if self.parts.is_empty() {
            let remedy = "add geometry: patches, polygons, subdivision meshes, quadrics or curves";
            return Err(end.place().wrong("the file draws nothing", remedy));
        }
        self.scene.objects = self.parts.into_iter().map(Part::object).collect();
        self.scene.lights = self.lamps.into_iter().filter(|lamp| lamp.is_on).map(|lamp| lamp.light).collect();
        self.scene.warnings = self.warnings.into_list();
        Ok(self.scene)
    }

    fn carry_out(&mut self, request: &mut Request, lexer: &mut Lexer) -> Result<()> {
        let known = self.block(request)?
            || self.transform(request)?
            || self.shading(request)?
            || self.view(request)?
            || self.geometry(request)?
            || self.archive(request, lexer)?;
        if known {
            return Ok(());
        }
        if !request.name.starts_with(|letter: char| letter.is_ascii_uppercase()) {
            return Err(request.wrong("this is no request", "is this a RIB file?"));
        }
        self.warnings.ignored(request);
        Ok(())
    }

    /// What is left of a request's arguments, as parameters.
    pub(super) fn parameters(&self, request: &mut Request) -> Result<Parameters> {
        Parameters::of(request, &self.declarations)
    }

    /// Warns about parameters that nobody has taken.
    pub(super) fn leave(&mut self, request: &Request, parameters: Parameters) {
        for parameter in parameters.rest() {
            let what = format!("parameter {} of {}", quoted(&parameter.name), quoted(&request.name));
            self.warnings.add(&parameter.place, format!("{what} is not used"));
        }
    }

    /// Adds geometry to the scene, or to the object that is being defined.
    pub(super) fn draw(&mut self, request: &Request, geometry: RibGeometry) -> Result<()> {
        let part = Part::new(&self.attributes, geometry, request.place.clone());
        self.add(request, part)
    }

    /// Adds a part.
    pub(super) fn add(&mut self, request: &Request, part: Part) -> Result<()> {
        self.part_count += 1;
        if self.part_count > MAX_OBJECTS {
            let problem = format!("with this the scene has more than {MAX_OBJECTS} objects");
            return Err(request.wrong(problem, "join them, for example in a PointsPolygons, or draw fewer"));
        }
        match &mut self.definition {
            Some(definition) => definition.parts.push(part),
            None if part.looks.opacity == Some(0.0) => {
                self.warnings.add(&part.place, "what has an opacity of 0 is not drawn");
            }
            None => self.parts.push(part),
        }
        Ok(())
    }

    /// From camera space, in which requests before `WorldBegin` are, to world space.
    pub(super) fn place_in_world(&mut self, from_camera: DAffine3) {
        for part in &mut self.parts {
            part.transform = from_camera * part.transform;
        }
        for lamp in &mut self.lamps {
            lamp.light.kind = lamp.light.kind.moved(from_camera);
        }
    }
}
