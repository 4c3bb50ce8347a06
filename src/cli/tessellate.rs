//! `micropoly tessellate`.

use std::time::Instant;

use micropoly::Result;
use micropoly::mesh::Mesh;

use super::args::{ProgressStyle, TessellateArguments};
use super::levels;
use super::render::check_folder;

pub(crate) fn run(arguments: &TessellateArguments) -> Result<()> {
    if arguments.levels.are_given() {
        return levels::run(arguments);
    }
    let start = Instant::now();
    let (path, format) = &arguments.output;
    let format = format.ok_or_else(|| levels::needs_levels(&path.display().to_string()))?;
    check_folder(path)?;
    let scene = arguments.scene.load(ProgressStyle::Auto)?;
    let (mesh, notes) = Mesh::of(&scene, &arguments.options())?;
    for note in notes {
        eprintln!("note: {note}");
    }
    mesh.save(path, format)?;
    if mesh.limited > 0 {
        eprintln!(
            "note: {} surfaces are longer than --dice micropolygons and may not be split: beside them the mesh may be open; \
             choose a larger --max-depth or --micropolygon-size",
            mesh.limited
        );
    }
    eprintln!("mesh          {}", path.display());
    eprintln!("patches       {}", scene.patch_count());
    eprintln!("vertices      {}", mesh.positions.len());
    eprintln!("triangles     {}", mesh.triangles.len());
    if arguments.check {
        eprintln!("open edges    {}", mesh.open_edges());
    }
    eprintln!("seconds       {:.3}", start.elapsed().as_secs_f64());
    Ok(())
}
