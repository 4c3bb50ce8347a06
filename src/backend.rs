//! Choice of a backend: what was built in, what can render, and what to say if it cannot.

use micropoly_core::render::Counts;

use crate::error::{Error, Result};
use crate::render::{RenderOptions, Rendering};
use crate::scene::Scene;

/// What renders.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Backend {
    /// The best that is there.
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
            Self::Auto | Self::Cpu => cfg!(feature = "cpu"),
            Self::Wgpu => cfg!(feature = "wgpu"),
            Self::Ocl => cfg!(feature = "ocl"),
        }
    }

    /// The backend that will render.
    ///
    /// # Errors
    /// [`Error::Backend`] if it is not there.
    pub fn resolve(self) -> Result<Self> {
        match self {
            Self::Auto | Self::Cpu if self.is_built() => Ok(Self::Cpu),
            _ => Err(self.missing()),
        }
    }

    fn missing(self) -> Error {
        let why = match self {
            Self::Wgpu | Self::Ocl if self.is_built() => "it cannot render yet",
            _ => "this program was built without it",
        };
        let remedy = if Self::Cpu.is_built() {
            "use --backend cpu"
        } else {
            "build with the feature `cpu`, which is on by default"
        };
        Error::Backend { backend: self.name(), why, remedy }
    }
}

/// Renders a scene; `progress` is told the counts so far, now and then.
///
/// # Errors
/// [`Error::Backend`], [`Error::Scene`], [`Error::Plan`] or [`Error::Device`].
pub fn render(scene: &Scene, options: &RenderOptions, progress: impl FnMut(&Counts)) -> Result<Rendering> {
    match options.backend.resolve()? {
        #[cfg(feature = "cpu")]
        Backend::Cpu => {
            let device = micropoly_backend_cpu::CpuDevice::new(options.threads)
                .map_err(|error| Error::Device(error.to_string()))?;
            let name = device.name();
            crate::render::render_on(device, name, scene, options, progress)
        }
        backend => {
            let _ = (scene, progress);
            Err(backend.missing())
        }
    }
}
