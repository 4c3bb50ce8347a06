//! Transparency in order needs the CPU backend, which is not built in: nothing can be made that could be drawn.

use micropoly_core::abi::{Colour, Frame, Object, Sample};
use micropoly_core::camera::Camera;

use crate::error::{Error, Result};
use crate::render::Ordering;
use crate::scene::Scene;

pub(crate) enum Ordered {}

impl Ordered {
    pub(crate) fn new(_: &Scene, _: f64, _: Ordering, _: usize) -> Result<Self> {
        let remedy = "build with the feature cpu, or use --transparency layers";
        Err(Error::scene("transparency in order is worked out on the CPU, which is not built in", remedy))
    }

    pub(crate) fn move_to(&mut self, _: &Scene, _: f64) -> Result<()> {
        match *self {}
    }

    pub(crate) fn seconds(&self) -> f64 {
        match *self {}
    }

    pub(crate) fn note(&self) -> String {
        match *self {}
    }

    pub(crate) fn draw(
        &mut self,
        _: &Camera,
        _: &Frame,
        _: &[Object],
        _: (&mut [Sample], &mut [Colour]),
    ) -> Result<()> {
        match *self {}
    }
}
