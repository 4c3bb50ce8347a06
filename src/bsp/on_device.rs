//! The same order on any device: it is compared with the CPU's, and times are taken.

use std::time::Instant;

use micropoly_backend_cpu::BspGrid;
use micropoly_core::accel::bsp::plan::DeviceBsp;
use micropoly_core::backend::Device;
use serde::Serialize;

use super::elapsed;
use crate::devices::{DeviceEntry, Job, with_device};
use crate::error::{Error, Result};

/// Milliseconds on a device, the shortest of all runs.
#[derive(Clone, Debug, Serialize)]
pub struct Times {
    /// Name of the device.
    pub device: String,
    /// To bring the grid there.
    pub upload: f64,
    /// To put its pieces into order for an eye.
    pub sort: f64,
    /// To read the order.
    pub read: f64,
}

/// Brings a grid to a device and puts its pieces into order there for an eye (see
/// [`micropoly_core::accel::bsp::lattice::Lattice::eye`]), `repeat` times; and compares that with the order that the CPU found.
///
/// # Errors
/// What the device reports; [`Error::Device`] if a piece is in another place.
pub fn on_device(
    entry: &DeviceEntry,
    grid: &BspGrid,
    (eye, order): ([i64; 3], &[u32]),
    repeat: u32,
) -> Result<Times> {
    with_device(entry, 0, Measure { grid, eye, order, repeat })?
}

struct Measure<'a> {
    grid: &'a BspGrid,
    eye: [i64; 3],
    order: &'a [u32],
    repeat: u32,
}

impl Job for Measure<'_> {
    type Output = Result<Times>;

    fn run<D: Device>(self, mut device: D, name: String) -> Self::Output {
        let upload = f64::INFINITY;
        let mut times = Times { device: name, upload, sort: upload, read: upload };
        let mut found = vec![0; self.order.len()];
        for _ in 0..self.repeat.max(1) {
            found.fill(0);
            self.once(&mut device, &mut found, &mut times).map_err(|error| Error::on_device(&error))?;
            if found != self.order {
                return Err(Error::Device(format!("the order of {} is not the CPU's", times.device)));
            }
        }
        Ok(times)
    }
}

impl Measure<'_> {
    fn once<D: Device>(
        &self,
        device: &mut D,
        found: &mut [u32],
        times: &mut Times,
    ) -> std::result::Result<(), D::Error> {
        let planes = self.grid.words();
        let start = Instant::now();
        let grid = DeviceBsp::new(device, &self.grid.lists(&planes))?;
        wait(device, &grid)?;
        times.upload = elapsed(start).min(times.upload);
        // Kernels are compiled when they are first needed, and memory is there when it is first written.
        grid.sort(device, self.eye)?;
        wait(device, &grid)?;
        let start = Instant::now();
        grid.sort(device, self.eye)?;
        wait(device, &grid)?;
        times.sort = elapsed(start).min(times.sort);
        let start = Instant::now();
        grid.read(device, found)?;
        times.read = elapsed(start).min(times.read);
        Ok(())
    }
}

/// Waits until all that was dispatched is done.
fn wait<D: Device>(device: &mut D, grid: &DeviceBsp<'_, D::Buffer>) -> std::result::Result<(), D::Error> {
    device.read(&grid.order, 0, &mut [0_u32])
}
