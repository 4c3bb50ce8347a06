//! A tree in a device's memory: built, fitted to primitives that have moved, and asked.

use super::morton::Precision;
use super::query::blocks as leaf_blocks;
use super::sort::{blocks, digits};
use super::tree::node_count;
use crate::abi::{
    AccelFrame, Bounds, Finding, Frustum, Node, Probe, SORT_BITS, SORT_DIGITS, Shared, SortKey, Triangle,
    UNFINISHED,
};
use crate::backend::Device;
use crate::error::PlanError;
use crate::stage::{Items, Stage};

/// Most primitives of a tree: each has six numbers, and those are counted in 32 bits.
pub const MOST_PRIMITIVES: u64 = 1 << 29;

/// A tree, and all that building it takes.
#[derive(Debug)]
pub struct DeviceTree<B> {
    frame: B,
    boxes: B,
    extent: B,
    keys: [B; 2],
    counts: B,
    visits: B,
    /// Entries are [`Node`]: inner ones, the root first, then leaves in the order of their codes.
    pub nodes: B,
    /// Entries are `u32`: the parent of each node.
    pub parents: B,
    about: AccelFrame,
}

impl<B> DeviceTree<B> {
    /// Reserves the buffers of a tree of so many primitives.
    ///
    /// # Errors
    /// [`PlanError::Invalid`] if there are too many; what the device reports.
    pub fn new<D: Device<Buffer = B>>(
        device: &mut D,
        primitives: u64,
        precision: Precision,
    ) -> Result<Self, D::Error> {
        if primitives > MOST_PRIMITIVES {
            let (option, value) = ("number of primitives", primitives);
            return Err(PlanError::Invalid { option, value, least: 0, most: MOST_PRIMITIVES }.into());
        }
        let count = primitives as u32;
        let counts = SORT_DIGITS * blocks(count);
        let about = AccelFrame { count, bits: precision.bits(), counts, ..AccelFrame::default() };
        let entries = primitives.max(1);
        let nodes = u64::from(node_count(count).max(1));
        Ok(Self {
            frame: device.allocate("accel_frame", AccelFrame::LAYOUT, 1)?,
            boxes: device.allocate("boxes", Bounds::LAYOUT, entries)?,
            extent: device.allocate("extent", u32::LAYOUT, 6)?,
            keys: [
                device.allocate("keys", SortKey::LAYOUT, entries)?,
                device.allocate("sorted", SortKey::LAYOUT, entries)?,
            ],
            counts: device.allocate("counts", u32::LAYOUT, u64::from(counts) + 1)?,
            visits: device.allocate("visits", u32::LAYOUT, 6 * entries)?,
            nodes: device.allocate("nodes", Node::LAYOUT, nodes)?,
            parents: device.allocate("parents", u32::LAYOUT, nodes)?,
            about,
        })
    }

    /// Builds the tree over boxes, which are finite; as many as there are primitives.
    ///
    /// # Errors
    /// What the device reports.
    pub fn build<D: Device<Buffer = B>>(&self, device: &mut D, boxes: &[Bounds]) -> Result<(), D::Error> {
        let Self { frame, extent, keys: [keys, _], nodes, parents, about, .. } = self;
        let all = Items::Count(about.count);
        if about.count == 0 {
            return Ok(());
        }
        device.write(&self.boxes, boxes)?;
        device.write(frame, &[*about])?;
        device.clear(extent)?;
        device.dispatch(Stage::AccelExtent, all, &[frame, &self.boxes, extent])?;
        device.dispatch(Stage::AccelCodes, all, &[frame, &self.boxes, extent, keys])?;
        let sorted = self.sort(device)?;
        let every = Items::Count(node_count(about.count));
        device.dispatch(Stage::AccelTree, every, &[frame, sorted, nodes, parents])?;
        self.fit(device)
    }

    /// Sorts the keys; says which buffer has them.
    fn sort<D: Device<Buffer = B>>(&self, device: &mut D) -> Result<&B, D::Error> {
        let Self { frame, keys: [a, b], counts, about, .. } = self;
        let (mut from, mut to) = (a, b);
        let each = Items::Count(blocks(about.count));
        for digit in 0..digits(about.bits) {
            device.write(frame, &[AccelFrame { shift: digit * SORT_BITS, ..*about }])?;
            device.dispatch(Stage::AccelCount, each, &[frame, from, counts])?;
            device.dispatch(Stage::AccelScan, Items::Count(1), &[frame, counts])?;
            device.dispatch(Stage::AccelScatter, each, &[frame, from, counts, to])?;
            (from, to) = (to, from);
        }
        Ok(from)
    }

    fn fit<D: Device<Buffer = B>>(&self, device: &mut D) -> Result<(), D::Error> {
        let Self { frame, boxes, parents, visits, nodes, about, .. } = self;
        let all = Items::Count(6 * about.count);
        device.dispatch(Stage::AccelBoxes, all, &[frame, boxes, parents, visits, nodes])
    }

    /// Fits the tree to primitives that have moved: boxes are new, all else stays.
    ///
    /// # Errors
    /// What the device reports.
    pub fn refit<D: Device<Buffer = B>>(&self, device: &mut D, boxes: &[Bounds]) -> Result<(), D::Error> {
        if self.about.count == 0 {
            return Ok(());
        }
        device.write(&self.boxes, boxes)?;
        device.write(&self.frame, &[self.about])?;
        self.fit(device)
    }

    /// Which primitives frusta see, in a new buffer of `u32`: frustum by frustum, each in the order of the leaves. `starts` is one
    /// longer than there are frusta, and becomes where those of each start and where the last ones end.
    ///
    /// # Errors
    /// What the device reports.
    pub fn see<D: Device<Buffer = B>>(
        &self,
        device: &mut D,
        frusta: &[Frustum],
        starts: &mut [u32],
    ) -> Result<B, D::Error> {
        starts.fill(0);
        let (questions, each) = (frusta.len() as u32, leaf_blocks(self.about.count));
        let about = AccelFrame { questions, counts: questions * each, ..self.about };
        let counts = device.allocate("counts", u32::LAYOUT, u64::from(about.counts) + 1)?;
        if about.counts == 0 {
            return device.allocate("seen", u32::LAYOUT, 1);
        }
        let asked = filled(device, "frusta", frusta)?;
        let (frame, nodes, all) = (&self.frame, &self.nodes, Items::Count(about.counts));
        device.write(frame, &[about])?;
        device.dispatch(Stage::AccelSee, all, &[frame, nodes, &asked, &counts])?;
        device.dispatch(Stage::AccelScan, Items::Count(1), &[frame, &counts])?;
        for (block, start) in (0..).step_by(each as usize).zip(starts.chunks_mut(1)) {
            device.read(&counts, block, start)?;
        }
        let room = starts.last().map_or(1, |all| (*all).max(1));
        let seen = device.allocate("seen", u32::LAYOUT, room.into())?;
        device.dispatch(Stage::AccelFill, all, &[frame, nodes, &asked, &counts, &seen])?;
        Ok(seen)
    }

    /// What rays hit first among triangles, whose boxes the tree is built over; `found` is as long as there are rays.
    ///
    /// # Errors
    /// [`PlanError::Unfinished`], and what the device reports.
    pub fn rays<D: Device<Buffer = B>>(
        &self,
        device: &mut D,
        triangles: &B,
        rays: &[Probe],
        found: &mut [Finding],
    ) -> Result<(), D::Error> {
        self.find(device, Stage::AccelRays, triangles, rays, found)
    }

    /// Which triangles are nearest to points.
    ///
    /// # Errors
    /// As [`DeviceTree::rays`].
    pub fn nearest<D: Device<Buffer = B>>(
        &self,
        device: &mut D,
        triangles: &B,
        points: &[Probe],
        found: &mut [Finding],
    ) -> Result<(), D::Error> {
        self.find(device, Stage::AccelNearest, triangles, points, found)
    }

    fn find<D: Device<Buffer = B>>(
        &self,
        device: &mut D,
        stage: Stage,
        triangles: &B,
        probes: &[Probe],
        found: &mut [Finding],
    ) -> Result<(), D::Error> {
        found.fill(Finding::NONE);
        let about = AccelFrame { questions: probes.len() as u32, ..self.about };
        if about.count == 0 || probes.is_empty() {
            return Ok(());
        }
        let asked = filled(device, "probes", probes)?;
        let answers = device.allocate("found", Finding::LAYOUT, probes.len() as u64)?;
        device.write(&self.frame, &[about])?;
        let buffers = [&self.frame, &self.nodes, triangles, &asked, &answers];
        device.dispatch(stage, Items::Count(about.questions), &buffers)?;
        device.read(&answers, 0, found)?;
        if found.iter().any(|found| found.primitive == UNFINISHED) {
            return Err(PlanError::Unfinished { stage: stage.name() }.into());
        }
        Ok(())
    }
}

/// A buffer of triangles, for [`DeviceTree::rays`] and [`DeviceTree::nearest`].
///
/// # Errors
/// What the device reports.
pub fn upload<D: Device>(device: &mut D, triangles: &[Triangle]) -> Result<D::Buffer, D::Error> {
    filled(device, "triangles", triangles)
}

/// A new buffer with something in it.
pub(super) fn filled<D: Device, T: Shared>(
    device: &mut D,
    name: &'static str,
    data: &[T],
) -> Result<D::Buffer, D::Error> {
    let buffer = device.allocate(name, T::LAYOUT, data.len().max(1) as u64)?;
    device.write(&buffer, data)?;
    Ok(buffer)
}
