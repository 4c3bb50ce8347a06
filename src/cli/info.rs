//! `micropoly info`.

use bytesize::ByteSize;
use micropoly::{Light, Result, Scene, sizes_for};

use super::args::InfoArguments;

pub(crate) fn run(arguments: &InfoArguments) -> Result<()> {
    let scene = Scene::load(&arguments.scene)?;
    let options = arguments.frame.options();
    scene.for_device(&options.frame)?;
    let sizes = sizes_for(&scene, &options)?;
    let (low, high) = scene.bounds();
    let eye = scene.camera.view.inverse().translation;
    let point_lights = scene.lights.iter().filter(|light| matches!(light, Light::Point { .. })).count();
    println!("scene        {}", scene.name);
    println!("objects      {}", scene.objects.len());
    let gregory = scene.gregory_count();
    println!("patches      {} bicubic Bézier, {gregory} Gregory", scene.patch_count() - gregory);
    println!(
        "bounds       {:.4} {:.4} {:.4}  to  {:.4} {:.4} {:.4}",
        low.x, low.y, low.z, high.x, high.y, high.z
    );
    println!("lights       {} directional, {point_lights} point", scene.lights.len() - point_lights);
    println!(
        "camera       at {:.4} {:.4} {:.4}, fov {}°, near {}",
        eye.x, eye.y, eye.z, scene.camera.fov as f32, scene.camera.near as f32
    );
    println!(
        "frame        {}x{} pixels, batches of {} surfaces, {} levels",
        sizes.width, sizes.height, sizes.batch, sizes.levels
    );
    println!("stack bound  {} surfaces", sizes.stack_entries());
    println!("memory       {} on the device", ByteSize(sizes.bytes()).display().iec());
    Ok(())
}
