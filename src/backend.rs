//! Choice of a backend: what was built in, what is there, and what to say if it is not.

use micropoly_core::backend::Device;
use micropoly_core::render::Counts;

use crate::devices::{DeviceEntry, Job, devices_of, find, with_device};
use crate::error::{Error, Result};
use crate::render::{RenderOptions, Rendering, render_on};
use crate::scene::Scene;

/// What renders.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Backend {
    /// The first GPU that is there, else the CPU.
    #[default]
    Auto,
    /// The CPU, with rayon.
    Cpu,
    /// A GPU through wgpu.
    Wgpu,
    /// An OpenCL device.
    Ocl,
}

impl Backend {
    /// All backends, the CPU first.
    pub const ALL: [Self; 3] = [Self::Cpu, Self::Wgpu, Self::Ocl];

    /// Its name on the command line and in statistics.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Auto => "auto",
            Self::Cpu => "cpu",
            Self::Wgpu => "wgpu",
            Self::Ocl => "ocl",
        }
    }

    /// Is it part of this build?
    #[must_use]
    pub const fn is_built(self) -> bool {
        match self {
            Self::Auto => true,
            Self::Cpu => cfg!(feature = "cpu"),
            Self::Wgpu => cfg!(feature = "wgpu"),
            Self::Ocl => cfg!(feature = "ocl"),
        }
    }

    /// What a user lacks who has no device for it.
    #[must_use]
    pub const fn driver_help(self) -> &'static str {
        match self {
            Self::Wgpu => {
                "no driver for Vulkan, Metal or Direct3D 12 was found: install the GPU maker's driver, \
                 or on Debian mesa-vulkan-drivers and libvulkan1"
            }
            Self::Ocl => {
                "no OpenCL driver was found: install the GPU maker's driver, or on Debian \
                 pocl-opencl-icd and ocl-icd-libopencl1"
            }
            Self::Auto | Self::Cpu => "this program was built without it",
        }
    }

    /// The device that will render.
    ///
    /// # Errors
    /// [`Error::Backend`] if there is none.
    pub fn choose(self, wanted: Option<&str>) -> Result<DeviceEntry> {
        if self != Self::Auto {
            return find(self, wanted);
        }
        let gpus =
            [Self::Wgpu, Self::Ocl].into_iter().filter_map(|backend| devices_of(backend).ok()).flatten();
        match gpus.into_iter().find(|entry| entry.is_gpu) {
            Some(entry) => Ok(entry),
            None => find(Self::Cpu, wanted),
        }
    }

    pub(crate) fn unavailable(self, why: String) -> Error {
        let remedy = match self {
            Self::Wgpu if !self.is_built() => "use --backend cpu, or build with --features wgpu",
            Self::Ocl if !self.is_built() => "use --backend cpu, or build with --features ocl",
            _ if Self::Cpu.is_built() => "use --backend cpu",
            _ => "build with the feature `cpu`, which is on by default",
        };
        Error::Backend { backend: self.name(), why, remedy }
    }
}

/// Renders a scene; `progress` is told the counts so far, now and then.
///
/// # Errors
/// [`Error::Backend`], [`Error::Scene`], [`Error::Plan`] or [`Error::Device`].
pub fn render<F: FnMut(&Counts)>(scene: &Scene, options: &RenderOptions, progress: F) -> Result<Rendering> {
    let entry = options.backend.choose(options.device.as_deref())?;
    with_device(&entry, options.threads, Render { scene, options, progress })?
}

/// Rendering a scene, as a job for any device.
struct Render<'a, F> {
    scene: &'a Scene,
    options: &'a RenderOptions,
    progress: F,
}

impl<F: FnMut(&Counts)> Job for Render<'_, F> {
    type Output = Result<Rendering>;

    fn run<D: Device>(self, device: D, name: String) -> Result<Rendering> {
        render_on(device, name, self.scene, self.options, self.progress)
    }
}
