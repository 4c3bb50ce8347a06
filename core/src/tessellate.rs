//! A frame as a mesh in the device's own memory: vertices and indices for whoever draws them there.
//!
//! Subdivision runs twice: first to count, so that the buffers are as large as they must be and no larger, then to
//! fill them. Both runs take the same surfaces in the same order.

use crate::abi::{Control, MAX_RATE, MeshPlace, MeshTotals, MeshVertex, Shared};
use crate::backend::Device;
use crate::error::PlanError;
use crate::kernel::mesh::QUAD_INDICES;
use crate::render::{Buffers, Counts, FramePlan};
use crate::schedule::Scheduler;
use crate::stage::{Items, Stage};

/// A mesh in the device's memory.
#[derive(Debug)]
pub struct MeshBuffers<B> {
    /// Entries are [`MeshVertex`].
    pub vertices: B,
    /// Entries are `u32`, three a triangle; a triangle that has collapsed has thrice the same.
    pub indices: B,
    /// How many there are of both.
    pub totals: MeshTotals,
    /// What subdivision came to.
    pub counts: Counts,
}

/// The buffers that both runs need.
struct Meshing<'a, B> {
    places: &'a B,
    totals: &'a B,
    /// Vertices and indices, in the second run.
    mesh: Option<(&'a B, &'a B)>,
}

/// Most draws that are meshed at once: all their vertices and triangles together are counted in 32 bits.
const MOST_DRAWS: u64 = u32::MAX as u64 / (2 * MAX_RATE * MAX_RATE) as u64;

impl FramePlan {
    /// Can this plan make a mesh?
    ///
    /// # Errors
    /// [`PlanError::BreadthMesh`]; [`PlanError::Invalid`] if so many surfaces may be drawn at once that their vertices
    /// cannot be counted.
    pub const fn can_tessellate(&self) -> Result<(), PlanError> {
        let (draws, batch) = (self.draws_at_once(), self.sizes().batch as u64);
        if matches!(self.sizes().scheduler, Scheduler::Breadth) {
            return Err(PlanError::BreadthMesh);
        }
        if draws > MOST_DRAWS {
            let (option, most) = ("batch", batch * MOST_DRAWS / draws);
            return Err(PlanError::Invalid { option, value: batch, least: 1, most });
        }
        Ok(())
    }

    /// Tessellates the frame, whose buffers are [`FramePlan::prepare`]d. With [`crate::abi::FLAG_WHOLE`] the mesh is
    /// whole; its vertices are in the spaces of their objects.
    ///
    /// # Errors
    /// As [`FramePlan::can_tessellate`]; what the device reports; [`PlanError::TooLarge`] if the mesh does not fit the
    /// device's largest buffer, or an index 32 bits.
    pub fn tessellate<D: Device>(
        &self,
        device: &mut D,
        buffers: &mut Buffers<D::Buffer>,
    ) -> Result<MeshBuffers<D::Buffer>, D::Error> {
        self.can_tessellate()?;
        let places = device.allocate("places", MeshPlace::LAYOUT, self.draws_at_once())?;
        let own = device.allocate("totals", MeshTotals::LAYOUT, 1)?;
        let count = Meshing { places: &places, totals: &own, mesh: None };
        let (_, totals) = self.mesh_run(device, buffers, &count)?;
        let triangles = u64::from(totals.triangles);
        let vertices = reserve::<D, MeshVertex>(device, "vertices", u64::from(totals.vertices))?;
        let indices = reserve::<D, u32>(device, "indices", triangles * QUAD_INDICES as u64 / 2)?;
        let fill = Meshing { mesh: Some((&vertices, &indices)), ..count };
        let (counts, totals) = self.mesh_run(device, buffers, &fill)?;
        Ok(MeshBuffers { vertices, indices, totals, counts })
    }

    fn mesh_run<D: Device>(
        &self,
        device: &mut D,
        buffers: &mut Buffers<D::Buffer>,
        meshing: &Meshing<'_, D::Buffer>,
    ) -> Result<(Counts, MeshTotals), D::Error> {
        let mut totals = MeshTotals::default();
        device.write(meshing.totals, &[totals])?;
        let counts = self.run_into(
            device,
            buffers,
            |_| {},
            |device, b| {
                let after = mesh_draws(device, b, meshing)?;
                if after.vertices < totals.vertices || after.triangles < totals.triangles {
                    let (buffer, bytes, limit) = ("vertices", 1 << 32, u64::from(u32::MAX));
                    return Err(PlanError::TooLarge { buffer, bytes, limit }.into());
                }
                totals = after;
                Ok(())
            },
        )?;
        // Whoever draws the mesh need not know what the device still has to submit: a read comes after all of it.
        device.read(meshing.totals, 0, &mut [MeshTotals::default()])?;
        Ok((counts, totals))
    }
}

/// Adds all draws in the draw buffer to the mesh, or only counts them.
fn mesh_draws<D: Device>(
    device: &mut D,
    b: &Buffers<D::Buffer>,
    meshing: &Meshing<'_, D::Buffer>,
) -> Result<MeshTotals, D::Error> {
    let Meshing { places, totals, mesh } = meshing;
    device.dispatch(Stage::MeshPlaces, Items::Count(1), &[&b.control, &b.draws, places, totals])?;
    let (mut control, mut after) = ([Control::default()], [MeshTotals::default()]);
    device.read(&b.control, 0, &mut control)?;
    device.read(totals, 0, &mut after)?;
    let draws = control[0].waiting + control[0].fresh;
    if let (Some((vertices, indices)), 1..) = (mesh, draws) {
        let all = [&b.frame, &b.objects, &b.patches, &b.draws, places, vertices, indices];
        device.dispatch(Stage::Mesh, Items::Count(draws), &all)?;
    }
    Ok(after[0])
}

fn reserve<D: Device, T: Shared>(
    device: &mut D,
    buffer: &'static str,
    entries: u64,
) -> Result<D::Buffer, D::Error> {
    let (bytes, limit) = (entries * T::LAYOUT.size as u64, device.max_buffer_bytes(T::LAYOUT));
    if bytes > limit {
        return Err(PlanError::TooLarge { buffer, bytes, limit }.into());
    }
    device.allocate(buffer, T::LAYOUT, entries.max(1))
}
