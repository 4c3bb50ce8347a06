//! `micropoly accel sort` and `micropoly bench --bsp`: triangles in the exact order in which an eye sees them.

use std::path::{Path, PathBuf};

use bytesize::ByteSize;
use clap::{Args, value_parser};
use micropoly::accel::mesh::TriangleMesh;
use micropoly::bsp::on_device::{Times, on_device};
use micropoly::bsp::{OneTree, Row, cut, eye, measure, pieces, sort};
use micropoly::cage::generate::{Layout, torus_cage};
use micropoly::core::accel::bsp::polygon::MOST_SLABS;
use micropoly::mesh::Format;
use micropoly::{Error, Result};
use micropoly_backend_cpu::BspOptions;

use super::accel::{OtherDevices, load};
use super::args::{BenchArguments, from_zero, mesh_path};
use super::render::write_json;

#[derive(Debug, Args)]
pub(crate) struct SortArguments {
    /// Mesh file (.obj).
    mesh: PathBuf,
    /// Cells of the grid along each axis. [default: chosen from the number of triangles]
    #[arg(long, value_name = "N", value_parser = value_parser!(u32).range(1..=i64::from(MOST_SLABS)))]
    bsp_grid: Option<u32>,
    /// Do not cut triangles that reach beyond a plane by no more than this share of the mesh's longest side; 0 is exact.
    #[arg(long, value_name = "SHARE", default_value = "0", value_parser = from_zero)]
    bsp_tolerance: f64,
    /// Planes that are tried for each node of many triangles; of few all are, unless this is 1.
    #[arg(long, value_name = "N", default_value_t = BspOptions::default().candidates,
          value_parser = value_parser!(u32).range(1..=1024))]
    candidates: u32,
    /// Write the pieces, far to near, as a mesh (.obj, .ply or .glb); or `none`.
    #[arg(short, long, value_name = "FILE", value_parser = mesh_path, default_value = "none")]
    output: (PathBuf, Option<Format>),
    #[command(flatten)]
    others: OtherDevices,
    /// Runs of each; the shortest counts.
    #[arg(long, value_name = "N", default_value = "10", value_parser = value_parser!(u32).range(1..=1000))]
    repeat: u32,
}

/// Sorts for the camera that renders the mesh.
pub(crate) fn run(arguments: &SortArguments) -> Result<()> {
    let mesh = load(&arguments.mesh)?;
    let options = BspOptions {
        grid: arguments.bsp_grid,
        tolerance: arguments.bsp_tolerance,
        candidates: arguments.candidates,
        ..BspOptions::default()
    };
    let (grid, cut) = cut(&mesh.triangles, &options, 0, arguments.repeat)?;
    let camera = mesh.camera()?;
    let (order, sorted) = sort(&grid, &mesh.triangles, &camera, arguments.repeat)?;
    let [x, y, z] = cut.grid;
    say!("triangles     {}, {} of them without area", cut.triangles, cut.degenerate);
    say!("grid          {x}x{y}x{z}, growth {:.2}", cut.grid_growth);
    say!("pieces        {}, growth {:.2}", cut.pieces, cut.growth);
    say!("nodes         {}", cut.nodes);
    say!("memory        {}", ByteSize(cut.bytes as u64).display().iec());
    say!("build         {:.2} ms", cut.milliseconds);
    say!("sort          {:.3} ms", sorted.milliseconds);
    say!("by centroids  {:.3} ms, a radix sort, not exact", sorted.radix_milliseconds);
    if let (path, Some(format)) = &arguments.output {
        pieces::mesh(&grid, &order.pieces).save(path, *format)?;
    }
    let Some(others) = arguments.others.meant()? else { return Ok(()) };
    let eye = eye(&grid, &camera)?;
    say!("{:<40} {:>9} {:>9} {:>9}", "ms on device", "upload", "sort", "read");
    for entry in others {
        let Times { device, upload, sort, read } =
            on_device(&entry, &grid, (eye, &order.pieces), arguments.repeat)?;
        say!("{device:<40.40} {upload:>9.2} {sort:>9.3} {read:>9.3}");
    }
    say!("the order is the CPU's, bit by bit");
    Ok(())
}

/// The table of Imre 2016, Table 6.1.
pub(crate) fn bench(arguments: &BenchArguments) -> Result<()> {
    say!(
        "{:<9} {:>9} {:>9} {:>9} {:>7} {:>7} {:>9} {:>7} {:>9} {:>9} {:>9}",
        "grid",
        "tolerance",
        "triangles",
        "pieces",
        "growth",
        "memory",
        "build ms",
        "faster",
        "sort ms",
        "radix ms",
        "of radix"
    );
    let mut tables = Vec::new();
    for (name, mesh) in meshes(&arguments.scenes)? {
        say!("{name}");
        let table = measure(&name, &mesh, arguments.repeat, |row, naive| say!("{}", line(row, naive)))?;
        let OneTree { growth, milliseconds } = table.naive;
        say!("builds are so many times faster than one naive tree: {milliseconds:.1} ms, growth {growth:.2}");
        tables.push(table);
    }
    match &arguments.json {
        Some(path) => write_json(path, &tables),
        None => Ok(()),
    }
}

fn line(Row { cut, sorted, .. }: &Row, naive: &OneTree) -> String {
    let [x, y, z] = cut.grid;
    format!(
        "{:<9} {:>9} {:>9} {:>9} {:>7.2} {:>7} {:>9.1} {:>7.1} {:>9.3} {:>9.3} {:>9.2}",
        format!("{x}x{y}x{z}"),
        cut.tolerance,
        cut.triangles,
        cut.pieces,
        cut.growth,
        ByteSize(cut.bytes as u64).display().iec_short(),
        cut.milliseconds,
        naive.milliseconds / cut.milliseconds,
        sorted.milliseconds,
        sorted.radix_milliseconds,
        sorted.milliseconds / sorted.radix_milliseconds
    )
}

/// The meshes that a user names, or a built-in one.
fn meshes(files: &[PathBuf]) -> Result<Vec<(String, TriangleMesh)>> {
    if files.is_empty() {
        let torus = TriangleMesh::of_mesh(&torus_cage(70_000, Layout::Triangles));
        let torus = torus.map_err(|error| Error::scene(error.to_string(), "report it"))?;
        return Ok(vec![("torus".to_owned(), torus)]);
    }
    let named = |path: &PathBuf| Ok((Path::display(path).to_string(), load(path)?));
    files.iter().map(named).collect()
}
