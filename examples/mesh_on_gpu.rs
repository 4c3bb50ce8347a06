//! Tessellates a scene on a GPU and draws the triangles there with an ordinary render pipeline: vertices and indices
//! never leave the GPU's memory.
//!
//!     cargo run --release --features wgpu --example mesh_on_gpu -- scenes/teapot.toml mesh.png

mod gpu;

use std::error::Error;

use bytemuck::cast_slice;
use micropoly::backend_wgpu::{WgpuBuffer, WgpuDevice, wgpu};
use micropoly::core::abi::{Frame, MeshVertex, Object, Patch, Shared};
use micropoly::core::render::FramePlan;
use micropoly::core::tessellate::MeshBuffers;
use micropoly::{DeviceScene, FrameOptions, Image, Scene};
use pollster::block_on;

use gpu::{fetched, pipeline, texture};

/// Positions are in the space of their objects, so each vertex looks up its object.
const SHADER: &str = "
struct View { scale: vec2<f32>, near: f32, light: vec3<f32> }
@group(0) @binding(0) var<storage, read> view: View;
@group(0) @binding(1) var<storage, read> object_of: array<u32>; // a patch
@group(0) @binding(2) var<storage, read> objects: array<array<vec4<f32>, 4>>; // three rows, and a colour

struct Corner { @builtin(position) clip: vec4<f32>, @location(0) normal: vec3<f32>, @location(1) colour: vec3<f32> }

@vertex
fn corner(
    @location(0) position: vec3<f32>, @location(1) normal: vec3<f32>,
    @location(2) uv: vec2<f32>, @location(3) patch_id: u32,
) -> Corner {
    let object = objects[object_of[patch_id]];
    let point = vec4<f32>(position, 1.0);
    let eye = vec3<f32>(dot(object[0], point), dot(object[1], point), dot(object[2], point));
    let turned = vec3<f32>(dot(object[0].xyz, normal), dot(object[1].xyz, normal), dot(object[2].xyz, normal));
    return Corner(vec4<f32>(eye.xy * view.scale, view.near, -eye.z), turned, object[3].xyz);
}

@fragment
fn colour(corner: Corner, @builtin(front_facing) front: bool) -> @location(0) vec4<f32> {
    let side = select(-1.0, 1.0, front);
    let light = max(dot(normalize(corner.normal) * side, view.light), 0.0);
    return vec4<f32>(corner.colour * (0.2 + 0.8 * light), 1.0);
}
";

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let (Some(scene), Some(output)) = (arguments.next(), arguments.next()) else {
        return Err("name a scene and a PNG file to write".into());
    };
    let options = FrameOptions { size: 2.0, bound: 32.0, whole: true, ..FrameOptions::default() };
    let seen = Scene::load(scene)?.for_device(&options)?;
    // The program's own device, as it has one for its window.
    let adapter = block_on(wgpu::Instance::default().request_adapter(&Default::default()))?;
    let (device, queue) = block_on(adapter.request_device(&Default::default()))?;
    let mut micropoly = WgpuDevice::on(device.clone(), queue.clone())?;
    let mesh = tessellated(&mut micropoly, &seen)?;
    micropoly.submit();
    println!(
        "{} vertices and {} triangles on {}",
        mesh.totals.vertices,
        mesh.totals.triangles,
        micropoly.name()
    );
    let image = drawn(&device, &queue, &seen, &mesh)?;
    image.save_png(output.as_ref())?;
    Ok(())
}

fn tessellated(
    device: &mut WgpuDevice,
    seen: &DeviceScene,
) -> Result<MeshBuffers<WgpuBuffer>, Box<dyn Error>> {
    let patches = seen.patch_count as u32;
    let records = seen.patches.len() as u32;
    let plan = FramePlan::new(seen.frame, patches, seen.objects.len() as u32, 4096)?;
    let sizes = micropoly::core::memory::Sizes { records, ..*plan.sizes() };
    let plan = FramePlan::with_sizes(seen.frame, sizes)?;
    let mut buffers = plan.prepare(device, &seen.objects, &seen.patches)?;
    Ok(plan.tessellate(device, &mut buffers)?)
}

fn drawn(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    seen: &DeviceScene,
    mesh: &MeshBuffers<WgpuBuffer>,
) -> Result<Image, Box<dyn Error>> {
    let Frame { width, height, .. } = seen.frame;
    let pipeline = pipeline(device, SHADER, MeshVertex::LAYOUT.size, &ATTRIBUTES, None);
    let bindings = bindings(device, queue, &pipeline, seen);
    let size = wgpu::Extent3d { width, height, depth_or_array_layers: 1 };
    let picture = texture(device, size, wgpu::TextureFormat::Rgba8UnormSrgb);
    let depth = texture(device, size, wgpu::TextureFormat::Depth32Float);
    let mut commands = device.create_command_encoder(&Default::default());
    {
        let views = (picture.create_view(&Default::default()), depth.create_view(&Default::default()));
        let mut pass = commands.begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &views.0,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color::BLACK),
                    store: wgpu::StoreOp::Store,
                },
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &views.1,
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(0.0),
                    store: wgpu::StoreOp::Discard,
                }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &bindings, &[]);
        pass.set_vertex_buffer(0, mesh.vertices.raw().slice(..));
        pass.set_index_buffer(mesh.indices.raw().slice(..), wgpu::IndexFormat::Uint32);
        pass.draw_indexed(0..3 * mesh.totals.triangles, 0, 0..1);
    }
    fetched(device, queue, commands, &picture)
}

/// Offsets are those of `MeshVertex`.
const ATTRIBUTES: [wgpu::VertexAttribute; 4] =
    wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3, 2 => Float32x2, 3 => Uint32];

fn bindings(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    pipeline: &wgpu::RenderPipeline,
    seen: &DeviceScene,
) -> wgpu::BindGroup {
    let Frame { focal, centre_x, centre_y, near, light_vector: [[x, y, z, _], ..], .. } = seen.frame;
    let view = [focal / centre_x, focal / centre_y, near, 0.0, x, y, z, 0.0];
    let object_of: Vec<u32> = seen.patches.iter().map(|patch: &Patch| patch.object).collect();
    let object = |object: &Object| {
        let mut rows = [0.0; 16];
        rows[..12].copy_from_slice(&object.to_eye);
        rows[12..15].copy_from_slice(&object.colour);
        rows
    };
    let objects: Vec<[f32; 16]> = seen.objects.iter().map(object).collect();
    let buffers = [cast_slice(&view), cast_slice(&object_of), cast_slice(&objects)].map(|bytes: &[u8]| {
        let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST;
        let size = bytes.len() as u64;
        let buffer = device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size,
            usage,
            mapped_at_creation: false,
        });
        queue.write_buffer(&buffer, 0, bytes);
        buffer
    });
    let mut entries = Vec::new();
    for (place, buffer) in (0..).zip(&buffers) {
        entries.push(wgpu::BindGroupEntry { binding: place, resource: buffer.as_entire_binding() });
    }
    let layout = pipeline.get_bind_group_layout(0);
    device.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout: &layout, entries: &entries })
}
