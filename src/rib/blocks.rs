//! Requests that begin and end blocks, and objects with their instances.

use super::place::quoted;
use super::reader::{Definition, Phase, Reader};
use super::request::Request;
use super::state::{Attributes, Block, BlockKind};
use crate::error::Result;

impl Reader {
    /// Carries out a request of this kind, or says that it is not.
    pub(super) fn block(&mut self, request: &mut Request) -> Result<bool> {
        match (BlockKind::of(&request.name), request.name.as_str()) {
            (Some((kind, true)), _) => self.begin(kind, request)?,
            (Some((kind, false)), _) => self.end(kind, request)?,
            (None, "ObjectInstance") => self.instance(request)?,
            (None, "Declare") => self.declarations.declare(request)?,
            // They change nothing that is drawn here.
            (None, "version" | "CoordinateSystem" | "Shutter") => {}
            _ => return Ok(false),
        }
        Ok(true)
    }

    fn begin(&mut self, kind: BlockKind, request: &mut Request) -> Result<()> {
        if kind == BlockKind::World && self.phase != Phase::BeforeWorld {
            return self.begin_another_world(request);
        }
        let saved = self.attributes.clone();
        match kind {
            BlockKind::World => self.begin_world(request)?,
            BlockKind::Object => self.begin_object(request)?,
            BlockKind::Motion => self.begin_motion(request),
            BlockKind::Solid => self
                .warnings
                .add(&request.place, "solids are drawn as they are: they are neither joined nor cut"),
            BlockKind::Frame | BlockKind::Attribute | BlockKind::Transform => {}
        }
        let (name, place) = (request.name.clone(), request.place.clone());
        self.blocks.push(Block { kind, name, place, saved });
        Ok(())
    }

    fn begin_another_world(&mut self, request: &Request) -> Result<()> {
        if self.phase == Phase::World {
            return Err(request.wrong("it stands inside of another world", "add a `WorldEnd` before it"));
        }
        self.warnings.add(&request.place, "only the first frame of the file is read");
        self.phase = Phase::Done;
        Ok(())
    }

    fn begin_world(&mut self, request: &Request) -> Result<()> {
        let to_camera = self.attributes.transform;
        self.scene.camera = self.view.camera(to_camera);
        let seen = self.scene.camera.map_or(to_camera, |camera| camera.from_world);
        if !(to_camera.inverse().is_finite() && seen.inverse().is_finite()) {
            let problem = "the transform from the world to the camera cannot be undone";
            return Err(request.wrong(problem, "use no scale of 0 before it"));
        }
        self.place_in_world(to_camera.inverse());
        if self.scene.camera.is_none() {
            let what =
                "the camera is not used: orthographic, as it is without a `Projection`, is not supported";
            self.warnings.add(&request.place, what);
        }
        self.attributes.transform = glam::DAffine3::IDENTITY;
        self.phase = Phase::World;
        Ok(())
    }

    /// Inside of an object transforms are its own, and so are looks.
    fn begin_object(&mut self, request: &mut Request) -> Result<()> {
        if self.definition.is_some() {
            let remedy = "end the other object first, and use it here with `ObjectInstance`";
            return Err(request.wrong("it stands inside of another object", remedy));
        }
        self.definition = Some(Definition { handle: request.handle()?, parts: Vec::new() });
        let Attributes { bases, steps, .. } = self.attributes;
        self.attributes = Attributes { bases, steps, ..Attributes::default() };
        Ok(())
    }

    fn begin_motion(&mut self, request: &Request) {
        self.warnings.add(&request.place, "motion is not supported: things stand where they are at first");
        self.has_moved = false;
    }

    /// Does the request say where something is later in a motion?
    pub(super) fn is_later_motion(&mut self, request: &Request) -> bool {
        let is_open = self.blocks.last().is_some_and(|block| block.kind == BlockKind::Motion);
        is_open && request.name != "MotionEnd" && std::mem::replace(&mut self.has_moved, true)
    }

    fn end(&mut self, kind: BlockKind, request: &Request) -> Result<()> {
        let block = match self.blocks.pop() {
            Some(block) if block.kind == kind => block,
            Some(open) => {
                let problem = format!("{} of line {} has not ended yet", quoted(&open.name), open.place.line);
                return Err(request.wrong(problem, "let blocks end in the order in which they begin"));
            }
            None => return Err(request.wrong("no such block has begun", "remove it, or begin one before")),
        };
        match kind {
            // Moved, not restored: it is what the block is there for.
            BlockKind::Motion => return Ok(()),
            BlockKind::Transform => self.attributes.transform = block.saved.transform,
            _ => self.attributes = block.saved,
        }
        match kind {
            BlockKind::World => self.phase = Phase::AfterWorld,
            BlockKind::Object => self.end_object(),
            _ => {}
        }
        Ok(())
    }

    fn end_object(&mut self) {
        if let Some(Definition { handle, parts }) = self.definition.take() {
            self.definitions.insert(handle, parts);
        }
    }

    fn instance(&mut self, request: &mut Request) -> Result<()> {
        let handle = request.handle()?;
        let Some(parts) = self.definitions.remove(&handle) else {
            let problem = format!("there is no object {}", quoted(&handle));
            return Err(request.wrong(problem, "define it before, between ObjectBegin and ObjectEnd"));
        };
        let added = parts.iter().try_for_each(|part| self.add(request, part.within(&self.attributes)));
        self.definitions.insert(handle, parts);
        added
    }
}
