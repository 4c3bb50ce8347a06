//! A BSP-grid in a device's memory: its pieces are put into order there, eye by eye.

use crate::abi::{AccelFrame, BspFrame, BspNode, BspPlane, Shared, UNFINISHED};
use crate::accel::plan::filled;
use crate::backend::Device;
use crate::error::PlanError;
use crate::stage::{Items, Stage};

/// The lists of a grid that its order is made from.
#[derive(Clone, Copy, Debug)]
pub struct BspLists<'a> {
    /// Last coordinates of slabs of cells, along each axis.
    pub slabs: [&'a [i32]; 3],
    /// Planes of the triangles.
    pub planes: &'a [BspPlane],
    /// First node of each cell, those along z first, then y, then x; and one past the last.
    pub first_nodes: &'a [u32],
    /// First piece of each cell, and one past the last.
    pub first_pieces: &'a [u32],
    /// The nodes of all trees.
    pub nodes: &'a [BspNode],
}

/// A grid, and all that putting its pieces into order takes.
#[derive(Debug)]
pub struct DeviceBsp<'a, B> {
    slabs: [&'a [i32]; 3],
    frame: B,
    planes: B,
    first_nodes: B,
    first_pieces: B,
    nodes: B,
    is_before: B,
    sums: B,
    counts: B,
    places: B,
    /// Entries are `u32`: all pieces, far to near, once they are sorted.
    pub order: B,
    planes_count: u32,
    pieces: u32,
}

impl<'a, B> DeviceBsp<'a, B> {
    /// Brings a grid to a device.
    ///
    /// # Errors
    /// [`PlanError::Invalid`] if the lists are not of as many cells as there are; what the device reports.
    pub fn new<D: Device<Buffer = B>>(device: &mut D, lists: &BspLists<'a>) -> Result<Self, D::Error> {
        let BspLists { slabs, planes, first_nodes, first_pieces, nodes } = *lists;
        let cells: u64 = slabs.iter().map(|ends| ends.len() as u64).product();
        for list in [first_nodes, first_pieces] {
            if list.len() as u64 != cells + 1 {
                let (option, value) = ("number of cells' ends", list.len() as u64);
                return Err(PlanError::Invalid { option, value, least: cells + 1, most: cells + 1 }.into());
            }
        }
        let pieces = first_pieces.last().copied().unwrap_or(0);
        let sums = AccelFrame { counts: cells as u32, ..AccelFrame::default() };
        let room = |entries: usize| entries.max(1) as u64;
        Ok(Self {
            slabs,
            frame: device.allocate("bsp_frame", BspFrame::LAYOUT, 1)?,
            planes: filled(device, "planes", planes)?,
            first_nodes: filled(device, "first_nodes", first_nodes)?,
            first_pieces: filled(device, "first_pieces", first_pieces)?,
            nodes: filled(device, "bsp_nodes", nodes)?,
            is_before: device.allocate("is_before", u32::LAYOUT, room(planes.len()))?,
            sums: filled(device, "accel_frame", &[sums])?,
            counts: device.allocate("counts", u32::LAYOUT, cells + 1)?,
            places: device.allocate("places", u32::LAYOUT, room(nodes.len()))?,
            order: device.allocate("order", u32::LAYOUT, room(pieces as usize))?,
            planes_count: planes.len() as u32,
            pieces,
        })
    }

    /// How many pieces there are.
    #[must_use]
    pub const fn pieces(&self) -> u32 {
        self.pieces
    }

    /// Puts all pieces into the order in which an eye (see [`super::lattice::Lattice::eye`]) sees them, into
    /// [`DeviceBsp::order`].
    ///
    /// # Errors
    /// What the device reports.
    pub fn sort<D: Device<Buffer = B>>(&self, device: &mut D, eye: [i64; 3]) -> Result<(), D::Error> {
        if self.pieces == 0 {
            return Ok(());
        }
        let Self { frame, planes, first_nodes, first_pieces, nodes, .. } = self;
        let Self { is_before, sums, counts, places, order, .. } = self;
        let about = BspFrame::new(self.slabs, self.planes_count, eye);
        let cells = Items::Count(about.cells);
        device.write(frame, &[about])?;
        device.dispatch(Stage::BspSides, Items::Count(about.planes), &[frame, planes, is_before])?;
        device.dispatch(Stage::BspCells, cells, &[frame, first_pieces, counts])?;
        device.dispatch(Stage::AccelScan, Items::Count(1), &[sums, counts])?;
        let buffers = [frame, nodes, first_nodes, first_pieces, is_before, counts, places, order];
        device.dispatch(Stage::BspRank, cells, &buffers)
    }

    /// Reads the order that was found last; it is as long as there are pieces.
    ///
    /// # Errors
    /// [`PlanError::Unfinished`], and what the device reports.
    pub fn read<D: Device<Buffer = B>>(&self, device: &mut D, order: &mut [u32]) -> Result<(), D::Error> {
        device.read(&self.order, 0, order)?;
        if order.contains(&UNFINISHED) {
            return Err(PlanError::Unfinished { stage: Stage::BspRank.name() }.into());
        }
        Ok(())
    }
}
