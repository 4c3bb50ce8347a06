//! Choice of a backend: what was built in, what is there, and what to say if it is not.

use micropoly_core::backend::Device;

use crate::devices::{DeviceEntry, Job, devices_of, find, with_device};
use crate::error::{Error, Result};
use crate::render::{Progress, RenderOptions, Rendering, Subject, render_from, render_on};
use crate::scene::Scene;
use crate::shot::Shot;

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

    /// The devices that may render, the first that opens is the one; and what a user should be told.
    ///
    /// # Errors
    /// [`Error::Backend`] if there is none, [`Error::Scene`] if `wanted` names none.
    pub fn candidates(self, wanted: Option<&str>) -> Result<(Vec<DeviceEntry>, Vec<String>)> {
        if self != Self::Auto {
            return Ok((vec![find(self, wanted)?], Vec::new()));
        }
        match wanted {
            Some(number) if number.parse::<usize>().is_ok() => Err(Error::scene(
                format!("device number {number} of which backend?"),
                format!("name it, for example --backend wgpu --device {number}; see `micropoly devices`"),
            )),
            Some(name) => Ok((vec![named(name)?], Vec::new())),
            None => gpus_then_cpu(),
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

/// The device of any backend with this in its name.
fn named(name: &str) -> Result<DeviceEntry> {
    let all: Vec<DeviceEntry> =
        Backend::ALL.into_iter().flat_map(|b| devices_of(b).unwrap_or_default()).collect();
    let meant = all.iter().find(|entry| entry.is_called(name)).cloned();
    meant.ok_or_else(|| {
        let names: Vec<&str> = all.iter().map(|entry| entry.name.as_str()).collect();
        Error::scene(format!("no device is called `{name}`"), format!("choose one of: {}", names.join(", ")))
    })
}

/// All GPUs, then the CPU.
fn gpus_then_cpu() -> Result<(Vec<DeviceEntry>, Vec<String>)> {
    let gpus = [Backend::Wgpu, Backend::Ocl].into_iter().flat_map(|b| devices_of(b).unwrap_or_default());
    let mut all: Vec<DeviceEntry> = gpus.filter(|entry| entry.is_gpu).collect();
    let mut notes = Vec::new();
    if all.is_empty() && (Backend::Wgpu.is_built() || Backend::Ocl.is_built()) {
        notes.push("no GPU was found, so the CPU renders".to_owned());
    }
    match devices_of(Backend::Cpu) {
        Ok(cpu) => all.extend(cpu),
        Err(missing) if all.is_empty() => return Err(Backend::Cpu.unavailable(missing.why)),
        Err(_) => {}
    }
    Ok((all, notes))
}

/// Renders a scene; `progress` is told the counts so far, now and then.
///
/// # Errors
/// [`Error::Backend`], [`Error::Refused`], [`Error::Scene`], [`Error::Plan`] or [`Error::Device`].
pub fn render<F: FnMut(&Progress<'_>)>(
    scene: &Scene,
    options: &RenderOptions,
    mut progress: F,
) -> Result<Rendering> {
    let ((backend, rendering), mut notes) = on_first_device(options, |entry| {
        let job = Render { scene, options, progress: &mut progress };
        with_device(entry, options.threads, job).map(|rendering| (entry.backend, rendering))
    })?;
    let rendering = rendering?;
    notes.extend(rendering.notes.iter().cloned());
    Ok(Rendering { backend, notes, ..rendering })
}

/// Renders a scene in one shot after the other, on one device; `each` is given every rendering, by number.
///
/// # Errors
/// As [`render`]; what `each` reports.
pub fn render_frames(
    scene: &Scene,
    options: &RenderOptions,
    shots: &[Shot],
    mut each: impl FnMut(usize, Rendering) -> Result<()>,
) -> Result<Vec<String>> {
    let (done, notes) = on_first_device(options, |entry| {
        let job = RenderFrames { scene, options, shots, backend: entry.backend, each: &mut each };
        with_device(entry, options.threads, job)
    })?;
    done?;
    Ok(notes)
}

/// What `attempt` makes of the first device that the options mean and that opens; and what a user should be told
/// about that.
pub(crate) fn on_first_device<T>(
    options: &RenderOptions,
    attempt: impl FnMut(&DeviceEntry) -> Result<T>,
) -> Result<(T, Vec<String>)> {
    let (candidates, mut notes) = options.backend.candidates(options.device.as_deref())?;
    let (made, refusals) = first_that_opens(&candidates, attempt)?;
    notes.extend(refusals);
    Ok((made, notes))
}

/// What `attempt` makes of the first entry that it does not refuse, and why it refused those before.
fn first_that_opens<T>(
    entries: &[DeviceEntry],
    mut attempt: impl FnMut(&DeviceEntry) -> Result<T>,
) -> Result<(T, Vec<String>)> {
    let mut refusals = Vec::new();
    for (place, entry) in entries.iter().enumerate() {
        match attempt(entry) {
            Ok(done) => return Ok((done, refusals)),
            Err(refusal) if place + 1 == entries.len() => return Err(refusal),
            Err(refusal) => refusals.push(format!("{refusal}; so the next device is tried")),
        }
    }
    Err(Backend::Auto.unavailable("no device was found".to_owned()))
}

/// Rendering a scene, as a job for any device.
struct Render<'a, F> {
    scene: &'a Scene,
    options: &'a RenderOptions,
    progress: F,
}

impl<F: FnMut(&Progress<'_>)> Job for Render<'_, F> {
    type Output = Result<Rendering>;

    fn run<D: Device>(self, mut device: D, name: String) -> Result<Rendering> {
        render_on(&mut device, name, self.scene, self.options, self.progress)
    }
}

/// Rendering a scene in several shots, as a job for any device.
struct RenderFrames<'a, F> {
    scene: &'a Scene,
    options: &'a RenderOptions,
    shots: &'a [Shot],
    backend: Backend,
    each: F,
}

impl<F: FnMut(usize, Rendering) -> Result<()>> Job for RenderFrames<'_, F> {
    type Output = Result<()>;

    fn run<D: Device>(self, mut device: D, name: String) -> Result<()> {
        let Self { scene, options, shots, backend, mut each } = self;
        let patches = scene.device_patches();
        for (number, shot) in shots.iter().enumerate() {
            let subject = Subject { scene, shot: *shot, patches: &patches };
            let rendering = render_from(&mut device, name.clone(), subject, options, |_| {})?;
            each(number, Rendering { backend, ..rendering })?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn entry(backend: Backend, index: usize) -> DeviceEntry {
        DeviceEntry { backend, index, name: format!("device {index}"), is_gpu: true, details: Vec::new() }
    }

    #[test]
    fn a_refused_device_makes_room_for_the_next_and_is_told_of() {
        let entries = [entry(Backend::Wgpu, 0), entry(Backend::Ocl, 1), entry(Backend::Cpu, 2)];
        let refuse = |entry: &DeviceEntry| match entry.backend {
            Backend::Wgpu => Err(entry.refused("it rounds otherwise")),
            _ => Ok(entry.index),
        };
        let (opened, notes) = first_that_opens(&entries, refuse).expect("the second opens");
        assert_eq!(opened, 1);
        assert!(notes.len() == 1 && notes[0].contains("it rounds otherwise"), "{notes:?}");
    }

    #[test]
    fn the_last_refusal_is_the_error() {
        let entries = [entry(Backend::Wgpu, 0)];
        let outcome = first_that_opens(&entries, |entry| Err::<(), _>(entry.refused("broken")));
        assert!(outcome.expect_err("nothing opens").to_string().contains("broken"));
        assert!(first_that_opens(&[], |_| Ok(())).is_err());
    }

    #[test]
    fn a_number_alone_means_no_device() {
        assert!(Backend::Auto.candidates(Some("0")).is_err());
    }
}
