//! `micropoly accel`: trees over the triangles of a mesh, on the CPU.

use std::path::{Path, PathBuf};

use bytesize::ByteSize;
use clap::{Args, Subcommand, value_parser};
use micropoly::accel::{boxes, build, frustum, query};
use micropoly::core::accel::morton::Precision;
use micropoly::tess::TessSource;
use micropoly::{Error, Result};

use super::args::resolution;

#[derive(Debug, Args)]
pub(crate) struct AccelArguments {
    #[command(subcommand)]
    what: What,
}

#[derive(Debug, Subcommand)]
enum What {
    /// Build the linear bounding volume hierarchy (Karras 2012) on all cores, check it, and say how large and how good it is.
    Build(TreeArguments),
    /// Build it, and find what the camera that renders the mesh sees, with the tree and box by box.
    Query {
        #[command(flatten)]
        tree: TreeArguments,
        /// Size of the image.
        #[arg(long, value_name = "WIDTHxHEIGHT", default_value = "1280x720", value_parser = resolution)]
        res: (u32, u32),
    },
}

#[derive(Debug, Args)]
struct TreeArguments {
    /// Mesh file (.obj).
    mesh: PathBuf,
    /// Bits of Morton codes.
    #[arg(long, value_name = "30|63", default_value = "30", value_parser = precision)]
    bits: Precision,
    /// Runs of each; the shortest counts.
    #[arg(long, value_name = "N", default_value = "10", value_parser = value_parser!(u32).range(1..=1000))]
    repeat: u32,
}

pub(crate) fn run(arguments: &AccelArguments) -> Result<()> {
    let (tree, res) = match &arguments.what {
        What::Build(tree) => (tree, None),
        What::Query { tree, res } => (tree, Some(*res)),
    };
    let mesh = load(&tree.mesh)?;
    let boxes = boxes(&mesh);
    let (lbvh, built) = build(&boxes, tree.bits, tree.repeat)?;
    say!("triangles     {}", built.triangles);
    say!("nodes         {}", built.nodes);
    say!("memory        {}", ByteSize(built.bytes as u64).display().iec());
    say!("depth         {}", built.depth);
    say!("SAH           {:.1}", built.sah);
    say!("build         {:.2} ms", built.milliseconds);
    if let Some((width, height)) = res {
        let planes = frustum(&mesh.camera()?, f64::from(width) / f64::from(height));
        let seen = query(&lbvh.nodes, &boxes, &planes, tree.repeat)?;
        say!("visible       {}", seen.visible);
        say!("query         {:.3} ms", seen.milliseconds);
        say!("box by box    {:.3} ms", seen.milliseconds_box_by_box);
    }
    Ok(())
}

/// A mesh of triangles.
pub(super) fn load(path: &Path) -> Result<TessSource> {
    let mesh = TessSource::load(path)?;
    if mesh.is_bezier {
        return Err(Error::Content {
            path: path.to_owned(),
            problem: "trees are built over triangles, and these are Bézier patches".to_owned(),
            remedy: "give an .obj file, or tessellate it first".to_owned(),
        });
    }
    mesh.notes.iter().for_each(|note| eprintln!("note: {note}"));
    Ok(mesh)
}

fn precision(text: &str) -> std::result::Result<Precision, String> {
    match text {
        "30" => Ok(Precision::Bits30),
        "63" => Ok(Precision::Bits63),
        _ => Err("choose 30 or 63".to_owned()),
    }
}
