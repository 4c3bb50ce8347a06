//! An operator changed in any kernel makes a comparison fail; see `conformance/src/trial.rs`.

use std::process::ExitCode;

use micropoly_backend_cpu::CpuDevice;
use micropoly_backend_ocl::{OclDevice, OclError, OpenOptions, Part};
use micropoly_conformance::trial::{self, Allowed, Edit, File};
use micropoly_core::stage::Stage;

/// Mutants of each file.
const MUTANTS_A_FILE: usize = 1;

/// Mutants that nothing can notice.
const ALLOWED: &[Allowed] = &[
    Allowed {
        file: "sides.cl",
        line: "return sqrt(add(add(add(mul(dx, dx), mul(dy, dy)), mul(dz, dz)), LENGTH_TINY));",
        operator: "add(",
        why: "a length is less than a millionth of a pixel either way",
    },
    Allowed {
        file: "flush.cl",
        line: "if (get_global_id(0) == 0) {",
        operator: " == ",
        why: "whoever does it does the same, and doing it twice changes nothing more",
    },
    Allowed {
        file: "arrange_draw.cl",
        line: "grids[HEAD_KINDS + 1u] = 0u;",
        operator: " = 0u;",
        why: "a kernel that looks for grids of its kind finds none",
    },
    Allowed {
        file: "mesh.cl",
        line: "__local float points[3u * POINTS];",
        operator: " * ",
        why: "the array is then too short, and what lies behind it is nobody's on devices without memory protection",
    },
    Allowed {
        file: "arrange_draw.cl",
        line: "grids[HEAD_KINDS] = 0u;",
        operator: " = 0u;",
        why: "a kernel that looks for grids of its kind finds none",
    },
    Allowed {
        file: "arrange_draw.cl",
        line: "if (get_local_id(0) == 0u) {",
        operator: " == ",
        why: "whoever does it does the same, and doing it twice changes nothing more",
    },
    Allowed {
        file: "draw.cl",
        line: "const Extents bounded = {(int)(draw.columns & 0xffffu) * SUBPIXELS, (int)(draw.columns >> 16) * SUBPIXELS - 1,",
        operator: " - ",
        why: "the box is then wider than it must be, and tiles look at draws that show nothing there",
    },
    Allowed {
        file: "draw.cl",
        line: "(int)(draw.rows & 0xffffu) * SUBPIXELS, (int)(draw.rows >> 16) * SUBPIXELS - 1};",
        operator: " - ",
        why: "the box is then higher than it must be, and tiles look at draws that show nothing there",
    },
    Allowed {
        file: "sort_middle.cl",
        line: "if (lane == 0u) {",
        operator: " == ",
        why: "all work-items know the sum, and writing it twice changes nothing more",
    },
    Allowed {
        file: "sort_middle.cl",
        line: "all += sums[other];",
        operator: " += ",
        why: "there seems to be no room for the lists then, and each tile looks at all draws",
    },
    Allowed {
        file: "sort_middle.cl",
        line: "lists[count] = all > LIST_ROOM ? UNLISTED : (uint)all;",
        operator: " > ",
        why: "there seems to be no room for the lists then, and each tile looks at all draws",
    },
    Allowed {
        file: "take.cl",
        line: "if (lane == 0u) {",
        operator: " == ",
        why: "whoever does it does the same, and doing it twice changes nothing more",
    },
    Allowed {
        file: "take.cl",
        line: "const bool safe = is_safe(count + wanted, count - first + wanted, levels, capacity);",
        operator: " - ",
        why: "then every surface is looked at, and the answer is the same",
    },
    Allowed {
        file: "take.cl",
        line: "return saturating_sub(taken + levels, 2u) <= saturating_sub(capacity, count);",
        operator: " <= ",
        why: "then every surface is looked at where none has to be, and the answer is the same",
    },
    Allowed {
        file: "counts.cl",
        line: "return lesser_of(lane * ((count + GROUP - 1u) / GROUP), count);",
        operator: " - ",
        why: "longer runs share out the same work",
    },
    Allowed {
        file: "counts.cl",
        line: "return lesser_of(lane * ((count + GROUP - 1u) / GROUP), count);",
        operator: " / ",
        why: "the first run then has everything",
    },
    Allowed {
        file: "scan.cl",
        line: "const uint from = run_start(lane, taken), to = run_start(lane + 1u, taken);",
        operator: " + ",
        why: "the first run then wraps around and has everything; the others are empty",
    },
    Allowed {
        file: "balance.cl",
        line: "const uint from = run_start(lane, count), to = run_start(lane + 1u, count);",
        operator: " + ",
        why: "the first run then wraps around and has everything; the others are empty",
    },
    Allowed {
        file: "mesh_places.cl",
        line: "const uint from = run_start(lane, count), to = run_start(lane + 1u, count);",
        operator: " + ",
        why: "the first run then wraps around and has everything; the others are empty",
    },
    Allowed {
        file: "dice.cl",
        line: "if (lane == GROUP - 1u) {",
        operator: " == ",
        why: "whoever does it does the same, and doing it twice changes nothing more",
    },
    Allowed {
        file: "dice.cl",
        line: "for (uint column = lane; column <= rate_u(draw); column += GROUP) {",
        operator: " += ",
        why: "there are fewer than work-items, so that the first turn is the only one",
    },
    Allowed {
        file: "dice.cl",
        line: "for (uint row = GROUP - 1u - lane; row <= rate_v(draw); row += GROUP) {",
        operator: " += ",
        why: "there are fewer than work-items, so that the first turn is the only one",
    },
    Allowed {
        file: "draw.cl",
        line: "if (lane == GROUP - 1u) {",
        operator: " == ",
        why: "whoever does it does the same, and doing it twice changes nothing more",
    },
    Allowed {
        file: "draw.cl",
        line: "if (lane == 0u) {",
        operator: " == ",
        why: "whoever does it does the same, and doing it twice changes nothing more",
    },
    Allowed {
        file: "balance.cl",
        line: "if (lane == 0u) {",
        operator: " == ",
        why: "all work-items have the same counts, and writing them twice changes nothing more",
    },
    Allowed {
        file: "border.cl",
        line: "return any >> CORNER_SHIFT == 0u;",
        operator: " >> ",
        why: "then what strayed corners enclose is looked at where it is the surface itself",
    },
    Allowed {
        file: "flat.cl",
        line: "return sqrt(add(square, LENGTH_TINY));",
        operator: "add(",
        why: "a length is less than a millionth of a pixel either way",
    },
    Allowed {
        file: "gregory.cl",
        line: "float largest = 0.0f;",
        operator: " = 0.0f;",
        why: "nothing is smaller where rounding matters, and too much is reckoned with otherwise",
    },
    Allowed {
        file: "gregory.cl",
        line: "for (uint face = 0u; face < 8u; face++) {",
        operator: " = 0u;",
        why: "the other face point of the same inner point is as far away, or what is unknown of it is far more than rounding",
    },
    Allowed {
        file: "half.cl",
        line: "return (patch->kind >> KIND_HALF_SHIFT & ALL_SIDES) != 0u;",
        operator: " & ",
        why: "then every side of every patch is looked at, and none of them is a half",
    },
    Allowed {
        file: "local.cl",
        line: "if (entry == first) {",
        operator: " == ",
        why: "whoever does it does the same, and doing it twice changes nothing more",
    },
    Allowed {
        file: "local.cl",
        line: "if (!is_safe(count, count - first, levels, capacity) && entry < count) {",
        operator: " - ",
        why: "then every surface is looked at, and the answer is the same",
    },
    Allowed {
        file: "tess_evaluate.cl",
        line: "return (uint2)(lesser_of(piece * size, count), lesser_of((piece + 1u) * size, count));",
        operator: " + ",
        why: "the first piece then wraps around and has everything; the others are empty",
    },
    Allowed {
        file: "tess_places.cl",
        line: "const uint from = first + run_start(lane, count), to = first + run_start(lane + 1u, count);",
        operator: " + ",
        why: "the first run then wraps around and has everything; the others are empty",
    },
    Allowed {
        file: "tess_places.cl",
        line: "if (lane == 0u) {",
        operator: " == ",
        why: "all work-items have the same sums, and writing them twice changes nothing more",
    },
    Allowed {
        file: "accel_codes.cl",
        line: "return lesser_of((uint)floor(mul(max(place, 0.0f), cells)), (1u << grid->bits) - 1u);",
        operator: " << ",
        why: "no side is as long as all cells, so that no cell lies beyond the last",
    },
    Allowed {
        file: "accel_codes.cl",
        line: "return lesser_of((uint)floor(mul(max(place, 0.0f), cells)), (1u << grid->bits) - 1u);",
        operator: " - ",
        why: "no side is as long as all cells, so that no cell lies beyond the last",
    },
    Allowed {
        file: "accel_count.cl",
        line: "__local uint own[SORT_DIGITS * GROUP];",
        operator: " * ",
        why: "the array is then too short, and what lies behind it is nobody's on devices without memory protection",
    },
    Allowed {
        file: "accel_extent.cl",
        line: "own[lane] = 0u;",
        operator: " = 0u;",
        why: "no number's bits, put in order, are as low as 1",
    },
    Allowed {
        file: "accel_scan.cl",
        line: "const uint from = run_start(lane, count), to = run_start(lane + 1u, count);",
        operator: " + ",
        why: "the first run wraps around and is then everything; the others are empty",
    },
    Allowed {
        file: "accel_scatter.cl",
        line: "__local uint places[SORT_DIGITS * GROUP];",
        operator: " * ",
        why: "the array is then too short, and what lies behind it is nobody's on devices without memory protection",
    },
    Allowed {
        file: "accel_scatter.cl",
        line: "const uint from = sort_run(accel_frame, lane), to = sort_run(accel_frame, lane + 1u);",
        operator: " + ",
        why: "the first run wraps around and is then everything; the others are empty",
    },
    Allowed { file: "accel_see.cl", line: "if (lane == 0u) {", operator: " == ", why: "all write the same" },
    Allowed {
        file: "accel_tree.cl",
        line: "for (long step = most / 2; step > 0; step /= 2) {",
        operator: " / ",
        why: "longer steps lead nowhere",
    },
    Allowed {
        file: "accel_tree.cl",
        line: "if (index == 0u) {",
        operator: " == ",
        why: "all write the same",
    },
    Allowed {
        file: "accel_walk.cl",
        line: "uint nodes[DEEPEST + 2u];",
        operator: " + ",
        why: "only trees over 2³¹ triangles need all of it",
    },
    Allowed {
        file: "accel_walk.cl",
        line: "float nears[DEEPEST + 2u];",
        operator: " + ",
        why: "only trees over 2³¹ triangles need all of it",
    },
    Allowed {
        file: "accel_walk.cl",
        line: "const bool swapped = second.x < first.x;",
        operator: " < ",
        why: "what is farther is then looked at first: slower, and the answer is the same",
    },
];

/// The stages that a file is a part of; all are built together, so nothing else knows.
fn stages(file: &str) -> Vec<Stage> {
    match file {
        "num.cl" => {
            vec![Stage::KnownAnswers, Stage::Blend, Stage::Filter, Stage::Bound, Stage::Draw, Stage::Mesh]
        }
        "tess_level.cl" | "tess_edges.cl" | "tess_levels.cl" => vec![Stage::TessControl],
        "tess_division.cl" | "tess_topology.cl" | "tess_corner.cl" => {
            vec![Stage::TessControl, Stage::TessEvaluate]
        }
        "tess_strip.cl" | "tess_surface.cl" | "tess_vertex.cl" | "tess_evaluated.cl" => {
            vec![Stage::TessEvaluate]
        }
        "accel_box.cl" => vec![Stage::AccelExtent, Stage::AccelCodes, Stage::AccelBoxes],
        "accel_sort.cl" => vec![Stage::AccelCount, Stage::AccelScatter],
        "accel_query.cl" => vec![Stage::AccelSee, Stage::AccelFill],
        "accel_ray.cl" | "accel_walk.cl" => vec![Stage::AccelRays, Stage::AccelNearest],
        "accel_point.cl" => vec![Stage::AccelNearest],
        "bsp_place.cl" => vec![Stage::BspCells, Stage::BspRank],
        "surface.cl" | "border.cl" => vec![Stage::Split, Stage::Bound, Stage::Draw, Stage::Mesh],
        "counts.cl" => {
            vec![Stage::Take, Stage::Scan, Stage::Balance, Stage::Deal, Stage::Local, Stage::MeshPlaces]
        }
        "take.cl" => vec![Stage::Take, Stage::Bound, Stage::Local],
        "scan.cl" => vec![Stage::Scan, Stage::Local, Stage::MeshPlaces],
        "bezier.cl" | "net.cl" | "gregory.cl" | "rational.cl" | "half.cl" | "instance.cl" => {
            vec![Stage::Bound, Stage::Draw, Stage::Mesh]
        }
        "owner.cl" => vec![Stage::Bound, Stage::Draw, Stage::Mesh],
        "project.cl" => vec![Stage::Bound, Stage::Draw],
        "dice.cl" | "dice_gregory.cl" | "dice_rational.cl" | "dice_any.cl" | "displace.cl" => {
            vec![Stage::Draw, Stage::Mesh]
        }
        "blend.cl" => vec![Stage::Blend, Stage::Draw],
        "sample.cl" => vec![Stage::Draw, Stage::SortLast, Stage::Filter, Stage::Mesh],
        "general.cl" | "grids.cl" => vec![Stage::Draw, Stage::SortLast],
        "weber.cl" | "flat.cl" | "sides.cl" => vec![Stage::Bound],
        _ => {
            let own = Stage::ALL.into_iter().find(|stage| file.strip_suffix(".cl") == Some(stage.name()));
            vec![own.unwrap_or(Stage::Draw)]
        }
    }
}

/// The parts that have the stages are built at once, so that what does not compile is an error here.
fn open(stages: &[Stage], edit: Edit<'_>) -> Result<OclDevice, OclError> {
    let options = OpenOptions { edit: Some(edit), skip_check: true, first: stages, ..OpenOptions::default() };
    OclDevice::open(0, &options)
}

fn main() -> ExitCode {
    let mut all = Part::ALL.map(Part::files).concat();
    all.sort_unstable();
    all.dedup();
    let files: Vec<File> = all
        .into_iter()
        .filter(|(name, _)| *name != "gen.cl")
        .map(|(name, source)| File { name, source, stages: stages(name) })
        .collect();
    trial::main(&files, ALLOWED, MUTANTS_A_FILE, CpuDevice::new(1).expect("threads"), open)
}
