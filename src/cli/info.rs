//! `micropoly info`.

use bytesize::ByteSize;
use micropoly::{Light, Result, sizes_for};

use super::args::{InfoArguments, ProgressStyle};

pub(crate) fn run(arguments: &InfoArguments) -> Result<()> {
    let scene = arguments.scene.load(ProgressStyle::Auto)?;
    let options = arguments.frame.options();
    scene.for_device(&options.frame)?;
    let sizes = sizes_for(&scene, &options)?;
    let (low, high) = scene.bounds();
    let eye = scene.camera.view.inverse().translation;
    let point_lights = scene.lights.iter().filter(|light| matches!(light, Light::Point { .. })).count();
    let (gregory, rational) = (scene.gregory_count(), scene.rational_count());
    let bezier = scene.patch_count() - gregory - rational;
    say!("scene        {}", scene.name);
    say!("objects      {}", scene.objects.len());
    say!("patches      {bezier} bicubic Bézier, {gregory} Gregory, {rational} rational");
    say!(
        "bounds       {:.4} {:.4} {:.4}  to  {:.4} {:.4} {:.4}",
        low.x,
        low.y,
        low.z,
        high.x,
        high.y,
        high.z
    );
    say!("lights       {} directional, {point_lights} point", scene.lights.len() - point_lights);
    say!(
        "camera       at {:.4} {:.4} {:.4}, fov {}°, near {}",
        eye.x,
        eye.y,
        eye.z,
        scene.camera.fov as f32,
        scene.camera.near as f32
    );
    say!(
        "frame        {}x{} pixels, batches of {} surfaces, {} levels",
        sizes.width,
        sizes.height,
        sizes.batch,
        sizes.levels
    );
    say!("stack bound  {} surfaces", sizes.stack_bound().map_or("no".to_owned(), |bound| bound.to_string()));
    say!("memory       {} on the device", ByteSize(sizes.bytes()).display().iec());
    Ok(())
}
