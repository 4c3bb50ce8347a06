//! The tessellation stage that WebGPU has not got: a mesh is divided on the GPU, its vertices are moved by a snippet of WGSL, and
//! an ordinary render pipeline draws them there, chunk by chunk. Only counts come back.
//!
//!     cargo run --release --features wgpu --example tess_on_gpu -- scenes/ball.obj out.png

mod gpu;

use std::error::Error;
use std::ops::ControlFlow;

use bytemuck::cast_slice;
use glam::{DMat4, DVec3, DVec4};
use micropoly::Camera;
use micropoly::backend_wgpu::{WgpuBuffer, WgpuDevice, WgpuError, wgpu};
use micropoly::core::abi::{Shared, TESS_LENGTH, TESS_ODD, TESS_PN, TessFrame, TessVertex};
use micropoly::core::tess::stream::{Chunk, TessInput, TessPlan};
use micropoly::tess::TessSource;
use pollster::block_on;

use gpu::{fetched, pipeline, texture};

/// Pixels a side of the picture, and of a segment.
const SIZE: u32 = 720;
const PIXELS: f64 = 6.0;
/// Bytes of vertices and indices on the GPU at any time, and of the patches.
const MEMORY: u64 = 64 << 20;

/// Offsets are those of `TessVertex`.
const ATTRIBUTES: [wgpu::VertexAttribute; 2] = wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3];

/// Evaluation: a point of the PN triangle, moved along its normal by where it is.
const RIPPLES: &str = "
fn evaluated(index: u32, coordinates: vec3<u32>) -> TessVertex {
    var vertex = evaluate(index, coordinates);
    let place = vec3<f32>(vertex.position[0], vertex.position[1], vertex.position[2]);
    let height = 0.004 * sin(90.0 * place.y);
    for (var axis = 0u; axis < 3u; axis++) {
        vertex.position[axis] += height * vertex.normal[axis];
    }
    return vertex;
}
";

const SHADER: &str = "
struct Corner { @builtin(position) clip: vec4<f32>, @location(0) normal: vec3<f32> }

@group(0) @binding(0) var<storage, read> to_clip: mat4x4<f32>;

@vertex
fn corner(@location(0) position: vec3<f32>, @location(1) normal: vec3<f32>) -> Corner {
    return Corner(to_clip * vec4<f32>(position, 1.0), normal);
}

@fragment
fn colour(corner: Corner) -> @location(0) vec4<f32> {
    let light = 0.5 + 0.5 * dot(normalize(corner.normal), normalize(vec3<f32>(0.4, 0.8, 0.6)));
    return vec4<f32>(light * vec3<f32>(0.9, 0.6, 0.35), 1.0);
}
";

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let (Some(mesh), Some(output)) = (arguments.next(), arguments.next()) else {
        return Err("name an .obj file and a PNG file to write".into());
    };
    let source = TessSource::load(mesh.as_ref())?;
    if source.is_bezier {
        return Err("this divides triangles: name an .obj file".into());
    }
    let (low, high) = source.bounds();
    let (middle, radius) = ((low + high) * 0.5, (high - low).length() * 0.5);
    let eye = middle + DVec3::new(0.4, 0.3, 1.0).normalize() * radius * 3.0;
    let camera = Camera::look_at(eye, middle, DVec3::Y, 45.0, radius * 0.01).ok_or("the mesh is nowhere")?;
    // The program's own device, as it has one for its window.
    let adapter = block_on(wgpu::Instance::default().request_adapter(&Default::default()))?;
    let (device, queue) = block_on(adapter.request_device(&Default::default()))?;
    let mut micropoly = WgpuDevice::on(device.clone(), queue.clone())?;
    micropoly.evaluate_tessellation(Some(RIPPLES))?;
    let frame = TessFrame {
        control: TESS_LENGTH,
        evaluation: TESS_PN,
        spacing: TESS_ODD,
        eye: eye.as_vec3().to_array(),
        factor: (camera.focal(SIZE) / PIXELS) as f32,
        ..TessFrame::default()
    };
    let input = TessInput { frame, patches: &source.patches, levels: &[], heights: &[] };
    let plan = TessPlan::new(&input, MEMORY)?;
    let buffers = plan.prepare(&mut micropoly)?;
    let to_clip = projection(&camera) * DMat4::from(camera.view);
    let painter = Painter::new(&device, &queue, to_clip);
    let counts = plan.run(&mut micropoly, &buffers, |micropoly, chunk| painter.draw(micropoly, chunk))?;
    println!("{} triangles in {} chunks on {}", counts.primitives, counts.chunks, micropoly.name());
    let commands = device.create_command_encoder(&Default::default());
    fetched(&device, &queue, commands, &painter.picture)?.save_png(output.as_ref())?;
    Ok(())
}

/// From the space of the eye to that of the picture; nearer depths are larger, down to 0 at infinity.
fn projection(camera: &Camera) -> DMat4 {
    let scale = camera.focal(SIZE) / (0.5 * f64::from(SIZE));
    DMat4::from_cols(DVec4::X * scale, DVec4::Y * scale, -DVec4::W, DVec4::Z * camera.near)
}

/// Draws chunks, one over the other.
struct Painter {
    pipeline: wgpu::RenderPipeline,
    bindings: wgpu::BindGroup,
    picture: wgpu::Texture,
    depth: wgpu::Texture,
}

impl Painter {
    fn new(device: &wgpu::Device, queue: &wgpu::Queue, to_clip: DMat4) -> Self {
        let back = Some(wgpu::Face::Back);
        let pipeline = pipeline(device, SHADER, TessVertex::LAYOUT.size, &ATTRIBUTES, back);
        let columns = to_clip.as_mat4().to_cols_array();
        let view = device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: size_of_val(&columns) as u64,
            usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        queue.write_buffer(&view, 0, cast_slice(&columns));
        let bindings = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &pipeline.get_bind_group_layout(0),
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: view.as_entire_binding() }],
        });
        let size = wgpu::Extent3d { width: SIZE, height: SIZE, depth_or_array_layers: 1 };
        let picture = texture(device, size, wgpu::TextureFormat::Rgba8UnormSrgb);
        let depth = texture(device, size, wgpu::TextureFormat::Depth32Float);
        Self { pipeline, bindings, picture, depth }
    }

    /// The buffers of the chunk are this pipeline's vertex and index buffers.
    fn draw(
        &self,
        micropoly: &mut WgpuDevice,
        chunk: &Chunk<'_, WgpuBuffer>,
    ) -> Result<ControlFlow<()>, WgpuError> {
        micropoly.submit(); // what makes the chunk comes first
        let is_first = chunk.before == 0;
        let mut commands = micropoly.device().create_command_encoder(&Default::default());
        {
            let views =
                (self.picture.create_view(&Default::default()), self.depth.create_view(&Default::default()));
            let mut pass = commands.begin_render_pass(&wgpu::RenderPassDescriptor {
                color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                    view: &views.0,
                    depth_slice: None,
                    resolve_target: None,
                    ops: kept(is_first, wgpu::Color::BLACK),
                })],
                depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                    view: &views.1,
                    depth_ops: Some(kept(is_first, 0.0)),
                    stencil_ops: None,
                }),
                ..Default::default()
            });
            pass.set_pipeline(&self.pipeline);
            pass.set_bind_group(0, &self.bindings, &[]);
            pass.set_vertex_buffer(0, chunk.vertices.raw().slice(..));
            pass.set_index_buffer(chunk.indices.raw().slice(..), wgpu::IndexFormat::Uint32);
            pass.draw_indexed(0..3 * chunk.totals.primitives, 0, 0..1);
        }
        micropoly.queue().submit([commands.finish()]);
        Ok(ControlFlow::Continue(()))
    }
}

/// The first chunk is drawn on nothing, the others on those before.
fn kept<V>(is_first: bool, nothing: V) -> wgpu::Operations<V> {
    let load = if is_first { wgpu::LoadOp::Clear(nothing) } else { wgpu::LoadOp::Load };
    wgpu::Operations { load, store: wgpu::StoreOp::Store }
}
