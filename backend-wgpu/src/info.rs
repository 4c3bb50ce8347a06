//! Which GPUs there are.

/// A GPU, or a program that acts as one, and what it offers.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DeviceInfo {
    /// Its name.
    pub name: String,
    /// The interface to it: Vulkan, Metal or DX12.
    pub backend: String,
    /// Name and version of the driver.
    pub driver: String,
    /// Discrete, integrated, virtual GPU, CPU or other.
    pub kind: String,
    /// Largest buffer that a stage can use, in bytes.
    pub max_binding: u64,
    /// Largest buffer, in bytes.
    pub max_buffer: u64,
    /// Most groups a dimension.
    pub max_groups: u32,
    /// Memory that a group can share, in bytes.
    pub workgroup_storage: u32,
}

/// All GPUs, in the order of their numbers for [`crate::WgpuDevice::open`].
#[must_use]
pub fn devices() -> Vec<DeviceInfo> {
    adapters(&instance()).iter().map(describe).collect()
}

/// Without debugging and without checks of indirect dispatches, whose sizes our own kernel computes.
pub(crate) fn instance() -> wgpu::Instance {
    wgpu::Instance::new(wgpu::InstanceDescriptor {
        backends: wgpu::Backends::PRIMARY,
        flags: wgpu::InstanceFlags::empty(),
        ..wgpu::InstanceDescriptor::new_without_display_handle()
    })
}

pub(crate) fn adapters(instance: &wgpu::Instance) -> Vec<wgpu::Adapter> {
    pollster::block_on(instance.enumerate_adapters(wgpu::Backends::PRIMARY))
}

pub(crate) fn describe(adapter: &wgpu::Adapter) -> DeviceInfo {
    let (info, limits) = (adapter.get_info(), adapter.limits());
    DeviceInfo {
        name: info.name,
        backend: format!("{:?}", info.backend),
        driver: format!("{} {}", info.driver, info.driver_info).trim().to_owned(),
        kind: format!("{:?}", info.device_type),
        max_binding: limits.max_storage_buffer_binding_size,
        max_buffer: limits.max_buffer_size,
        max_groups: limits.max_compute_workgroups_per_dimension,
        workgroup_storage: limits.max_compute_workgroup_storage_size,
    }
}
