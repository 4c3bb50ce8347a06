//! Which OpenCL devices are there?

use std::sync::{Mutex, PoisonError};

use opencl3::device::{CL_DEVICE_TYPE_ALL, CL_DEVICE_TYPE_GPU, Device};
use opencl3::error_codes::{CL_DEVICE_NOT_FOUND, CL_PLATFORM_NOT_FOUND_KHR, DLOPEN_RUNTIME_LOAD_FAILED};
use opencl3::platform::{Platform, get_platforms};

use crate::error::OclError;

/// One OpenCL device, as reports show it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DeviceInfo {
    /// Name of the platform (the driver package) it belongs to.
    pub platform: String,
    /// Its own name.
    pub name: String,
    /// Is it a GPU rather than a CPU?
    pub is_gpu: bool,
    /// Version of its driver.
    pub driver: String,
    /// Bytes of memory.
    pub memory: u64,
    /// Most bytes that can be reserved in one piece.
    pub max_allocation: u64,
    /// Bytes of memory that a work-group shares.
    pub local_memory: u64,
    /// Largest number of work-items in a work-group.
    pub max_work_group: usize,
}

/// Every device of every platform, in the order of [`crate::OclDevice::open`]'s index.
///
/// # Errors
/// [`OclError::NoDriver`] if there is no OpenCL library or no platform.
pub fn devices() -> Result<Vec<DeviceInfo>, OclError> {
    found()?.iter().map(|(platform, device)| info(platform, device)).collect()
}

/// All devices and their platforms.
///
/// One thread at a time: drivers start when they are first asked, and not all are safe against threads then.
pub(crate) fn found() -> Result<Vec<(Platform, Device)>, OclError> {
    static STARTING: Mutex<()> = Mutex::new(());
    let _alone = STARTING.lock().unwrap_or_else(PoisonError::into_inner);
    let mut all = Vec::new();
    for platform in platforms()? {
        let ids = match platform.get_devices(CL_DEVICE_TYPE_ALL) {
            Ok(ids) => ids,
            Err(code) if code.0 == CL_DEVICE_NOT_FOUND => continue,
            Err(code) => return Err(OclError::driver("listing devices")(code)),
        };
        all.extend(ids.into_iter().map(|id| (platform, Device::new(id))));
    }
    if all.is_empty() { Err(OclError::NoDriver { what: "there is no OpenCL device" }) } else { Ok(all) }
}

fn platforms() -> Result<Vec<Platform>, OclError> {
    get_platforms().map_err(|code| match code.0 {
        DLOPEN_RUNTIME_LOAD_FAILED => OclError::NoDriver { what: "the OpenCL library cannot be loaded" },
        CL_PLATFORM_NOT_FOUND_KHR => OclError::NoDriver { what: "there is no OpenCL driver" },
        _ => OclError::driver("listing platforms")(code),
    })
}

pub(crate) fn info(platform: &Platform, device: &Device) -> Result<DeviceInfo, OclError> {
    let asking = OclError::driver("describing a device");
    Ok(DeviceInfo {
        platform: platform.name().map_err(&asking)?,
        name: device.name().map_err(&asking)?.trim().to_owned(),
        is_gpu: device.dev_type().map_err(&asking)? & CL_DEVICE_TYPE_GPU != 0,
        driver: device.driver_version().map_err(&asking)?,
        memory: device.global_mem_size().map_err(&asking)?,
        max_allocation: device.max_mem_alloc_size().map_err(&asking)?,
        local_memory: device.local_mem_size().map_err(&asking)?,
        max_work_group: device.max_work_group_size().map_err(&asking)?,
    })
}
