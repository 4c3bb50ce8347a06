//! Every device of every backend that was built in, and opening one of them.

use micropoly_core::backend::Device;

use crate::backend::Backend;
use crate::error::{Error, Result};

/// A device that may render.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DeviceEntry {
    /// Which backend it belongs to.
    pub backend: Backend,
    /// Its number within the backend.
    pub index: usize,
    /// Its name.
    pub name: String,
    /// Is it a GPU rather than a CPU?
    pub is_gpu: bool,
    /// Driver and limits, as pairs of name and value.
    pub details: Vec<(&'static str, String)>,
}

impl DeviceEntry {
    /// Does its name contain this, in upper or lower case?
    #[must_use]
    pub fn is_called(&self, part: &str) -> bool {
        self.name.to_lowercase().contains(&part.to_lowercase())
    }

    /// Does a user mean it by a number within its backend or a part of a name?
    #[must_use]
    pub fn is_meant(&self, wanted: &str) -> bool {
        wanted.parse::<usize>().map_or_else(|_| self.is_called(wanted), |number| self.index == number)
    }

    /// It could not be opened.
    #[cfg(any(feature = "cpu", feature = "wgpu", feature = "ocl", test))]
    pub(crate) fn refused(&self, why: impl ToString) -> Error {
        let why = why.to_string();
        let help = if why.contains("help: ") { "" } else { "\n  help: use another device, or --backend cpu" };
        Error::Refused {
            backend: self.backend.name(),
            device: self.name.clone(),
            why: format!("{why}{help}"),
        }
    }
}

/// A backend without a device.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Missing {
    /// Which backend.
    pub backend: Backend,
    /// Why, and what to do about it.
    pub why: String,
}

/// Something to do with a device of any kind.
pub trait Job {
    /// What comes of it.
    type Output;

    /// Does it.
    fn run<D: Device>(self, device: D, name: String) -> Self::Output;
}

/// All devices of one backend.
///
/// # Errors
/// [`Missing`] if there are none.
pub fn devices_of(backend: Backend) -> std::result::Result<Vec<DeviceEntry>, Missing> {
    let missing = |why: &str| Err(Missing { backend, why: why.to_owned() });
    match backend {
        #[cfg(feature = "cpu")]
        Backend::Cpu => Ok(vec![cpu_entry()]),
        #[cfg(feature = "wgpu")]
        Backend::Wgpu => found(
            backend,
            micropoly_backend_wgpu::devices().into_iter().enumerate().map(wgpu_entry).collect(),
        ),
        #[cfg(feature = "ocl")]
        Backend::Ocl => match micropoly_backend_ocl::devices() {
            Ok(all) => found(backend, all.into_iter().enumerate().map(ocl_entry).collect()),
            Err(error) => missing(&error.to_string()),
        },
        _ => missing("this program was built without it"),
    }
}

#[cfg(any(feature = "wgpu", feature = "ocl"))]
fn found(backend: Backend, all: Vec<DeviceEntry>) -> std::result::Result<Vec<DeviceEntry>, Missing> {
    if all.is_empty() {
        return Err(Missing { backend, why: backend.driver_help().to_owned() });
    }
    Ok(all)
}

#[cfg(feature = "cpu")]
fn cpu_entry() -> DeviceEntry {
    let cores = std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
    DeviceEntry {
        backend: Backend::Cpu,
        index: 0,
        name: format!("CPU ({})", std::env::consts::ARCH),
        is_gpu: false,
        details: vec![("cores", cores.to_string())],
    }
}

#[cfg(feature = "wgpu")]
fn wgpu_entry((index, info): (usize, micropoly_backend_wgpu::DeviceInfo)) -> DeviceEntry {
    DeviceEntry {
        backend: Backend::Wgpu,
        index,
        is_gpu: info.kind.contains("Gpu"),
        name: info.name,
        details: vec![
            ("interface", info.backend),
            ("driver", info.driver),
            ("kind", info.kind),
            ("largest binding, bytes", info.max_binding.to_string()),
            ("largest buffer, bytes", info.max_buffer.to_string()),
            ("groups a dimension", info.max_groups.to_string()),
            ("group memory, bytes", info.workgroup_storage.to_string()),
        ],
    }
}

#[cfg(feature = "ocl")]
fn ocl_entry((index, info): (usize, micropoly_backend_ocl::DeviceInfo)) -> DeviceEntry {
    DeviceEntry {
        backend: Backend::Ocl,
        index,
        is_gpu: info.is_gpu,
        name: info.name,
        details: vec![
            ("platform", info.platform),
            ("driver", info.driver),
            ("memory, bytes", info.memory.to_string()),
            ("largest buffer, bytes", info.max_allocation.to_string()),
            ("group memory, bytes", info.local_memory.to_string()),
            ("items a group", info.max_work_group.to_string()),
        ],
    }
}

/// All devices of one backend.
///
/// # Errors
/// [`Error::Backend`] if there are none.
pub fn all_of(backend: Backend) -> Result<Vec<DeviceEntry>> {
    devices_of(backend).map_err(|missing| backend.unavailable(missing.why))
}

/// The device of a backend that a user means by a number or a part of a name.
///
/// # Errors
/// [`Error::Backend`] if the backend has no device, [`Error::Scene`] if none of them is meant.
pub fn find(backend: Backend, wanted: Option<&str>) -> Result<DeviceEntry> {
    let meant = meant(all_of(backend)?, wanted)?;
    Ok(meant.into_iter().next().expect("there is one"))
}

/// Those of some devices that a user means by a number or a part of a name; all of them without one.
///
/// # Errors
/// [`Error::Scene`] if none of them is meant.
pub fn meant(devices: Vec<DeviceEntry>, wanted: Option<&str>) -> Result<Vec<DeviceEntry>> {
    let Some(wanted) = wanted else { return Ok(devices) };
    let (meant, others): (Vec<_>, Vec<_>) = devices.into_iter().partition(|entry| entry.is_meant(wanted));
    if meant.is_empty() {
        let name = |entry: &DeviceEntry| format!("{} {} {}", entry.backend.name(), entry.index, entry.name);
        let names: Vec<String> = others.iter().map(name).collect();
        return Err(Error::scene(
            format!("no device is meant by `{wanted}`"),
            format!("choose one of: {}", names.join(", ")),
        ));
    }
    Ok(meant)
}

/// Opens a device and does something with it; `threads` matter to the CPU only.
///
/// # Errors
/// [`Error::Refused`] if it cannot be opened.
pub fn with_device<J: Job>(entry: &DeviceEntry, threads: usize, job: J) -> Result<J::Output> {
    let _ = threads;
    match entry.backend {
        #[cfg(feature = "cpu")]
        Backend::Cpu => {
            let device =
                micropoly_backend_cpu::CpuDevice::new(threads).map_err(|error| entry.refused(error))?;
            Ok(job.run(device, entry.name.clone()))
        }
        #[cfg(feature = "wgpu")]
        Backend::Wgpu => {
            let device = micropoly_backend_wgpu::WgpuDevice::open(entry.index, None)
                .map_err(|error| entry.refused(error))?;
            Ok(job.run(device, entry.name.clone()))
        }
        #[cfg(feature = "ocl")]
        Backend::Ocl => {
            let options = micropoly_backend_ocl::OpenOptions::default();
            let device = micropoly_backend_ocl::OclDevice::open(entry.index, &options)
                .map_err(|error| entry.refused(error))?;
            Ok(job.run(device, entry.name.clone()))
        }
        backend => {
            drop(job);
            Err(backend.unavailable("this program was built without it".to_owned()))
        }
    }
}
