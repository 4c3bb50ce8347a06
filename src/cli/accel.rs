//! `micropoly accel`: trees over the triangles of a mesh, on the CPU and on any other device.

use std::path::{Path, PathBuf};

use bytesize::ByteSize;
use clap::{Args, Subcommand, value_parser};
use micropoly::Result;
use micropoly::accel::mesh::TriangleMesh;
use micropoly::accel::on_device::{Questions, Times, on_device};
use micropoly::accel::{boxes, build, frustum, query, rays};
use micropoly::core::abi::Triangle;
use micropoly::core::accel::morton::Precision;
use micropoly::devices::{DeviceEntry, meant};

use super::args::{Compared, resolution};
use super::bsp::{self, SortArguments};
use super::devices::compared;

/// Frusta that devices are asked about at once: what the camera sees, narrower and narrower.
const FRUSTA: u32 = 4;
/// Pixels of the image along each of its sides that share a ray.
const COARSE: u32 = 8;

#[derive(Debug, Args)]
pub(crate) struct AccelArguments {
    #[command(subcommand)]
    what: What,
}

#[derive(Debug, Subcommand)]
enum What {
    /// Build the linear bounding volume hierarchy (Karras 2012) on all cores, check it, and say how large and how good it is.
    Build(TreeArguments),
    /// Cut the triangles into a grid of trees (BSP), and put all pieces into the exact order in which the camera that renders
    /// the mesh sees them.
    Sort(SortArguments),
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
    #[command(flatten)]
    others: OtherDevices,
    /// Runs of each; the shortest counts.
    #[arg(long, value_name = "N", default_value = "10", value_parser = value_parser!(u32).range(1..=1000))]
    repeat: u32,
}

/// Devices on which the same is done once more.
#[derive(Debug, Args)]
pub(super) struct OtherDevices {
    /// Do it on these devices, too, and compare: `all`, or those of one backend.
    #[arg(long, value_enum)]
    backend: Option<Compared>,
    /// Number or part of the name of a device of the backend (see `micropoly devices`).
    #[arg(long, value_name = "NUMBER|NAME", requires = "backend")]
    device: Option<String>,
}

pub(crate) fn run(arguments: &AccelArguments) -> Result<()> {
    let (tree, res) = match &arguments.what {
        What::Sort(arguments) => return bsp::run(arguments),
        What::Build(tree) => (tree, None),
        What::Query { tree, res } => (tree, Some(*res)),
    };
    let mesh = load(&tree.mesh)?;
    let boxes = boxes(&mesh.triangles);
    let (lbvh, built) = build(&boxes, tree.bits, tree.repeat)?;
    say!("triangles     {}", built.triangles);
    say!("nodes         {}", built.nodes);
    say!("memory        {}", ByteSize(built.bytes as u64).display().iec());
    say!("depth         {}", built.depth);
    say!("SAH           {:.1}", built.sah);
    say!("build         {:.2} ms", built.milliseconds);
    let mut questions = Questions::default();
    if let Some((width, height)) = res {
        let camera = mesh.camera()?;
        let shape = f64::from(width) / f64::from(height);
        let planes = frustum(&camera, shape);
        questions.frusta =
            (1..=FRUSTA).map(|k| frustum(&camera, shape * f64::from(k) / f64::from(FRUSTA)).into()).collect();
        [questions.rays, questions.points] = rays(&camera, [width, height].map(|size| size.div_ceil(COARSE)));
        let seen = query(&lbvh.nodes, &boxes, &planes, tree.repeat)?;
        say!("visible       {}", seen.visible);
        say!("query         {:.3} ms", seen.milliseconds);
        say!("box by box    {:.3} ms", seen.milliseconds_box_by_box);
    }
    let Some(others) = tree.others.meant()? else { return Ok(()) };
    let triangles: Vec<Triangle> =
        mesh.triangles.iter().map(|corners| Triangle { corners: bytemuck::cast(*corners) }).collect();
    say!("{}", head(&questions));
    for entry in others {
        say!("{}", line(&on_device(&entry, (&triangles, &lbvh), tree.bits, &questions, tree.repeat)?));
    }
    say!("trees and answers are the CPU's, bit by bit");
    Ok(())
}

impl OtherDevices {
    /// The devices that are meant, if a backend is given.
    pub(super) fn meant(&self) -> Result<Option<Vec<DeviceEntry>>> {
        self.backend.map(|backend| meant(compared(backend)?, self.device.as_deref())).transpose()
    }
}

fn head(Questions { frusta, rays, points }: &Questions) -> String {
    let [frusta, rays, points] = [frusta.len(), rays.len(), points.len()];
    format!(
        "{:<40} {:>9} {:>9} {:>12} {:>12} {:>12}",
        "ms on device",
        "build",
        "refit",
        format!("{frusta} frusta"),
        format!("{rays} rays"),
        format!("{points} points")
    )
}

fn line(Times { device, build, refit, frusta, rays, nearest }: &Times) -> String {
    format!("{device:<40.40} {build:>9.2} {refit:>9.2} {frusta:>12.2} {rays:>12.2} {nearest:>12.2}")
}

/// Reads a mesh of triangles, and says what of it is left out.
pub(super) fn load(path: &Path) -> Result<TriangleMesh> {
    let mesh = TriangleMesh::load(path)?;
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
