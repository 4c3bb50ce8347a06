//! An operator changed in any kernel makes a comparison fail; see `conformance/src/trial.rs`.

use std::process::ExitCode;

use micropoly_backend_cpu::CpuDevice;
use micropoly_backend_wgpu::{WgpuDevice, WgpuError, Which};
use micropoly_conformance::trial::{self, Allowed, Edit, File};
use micropoly_core::stage::Stage;

/// Mutants of each file: a software device takes seconds to compile one.
const MUTANTS_A_FILE: usize = 1;

/// Mutants that nothing can notice.
const ALLOWED: &[Allowed] = &[
    Allowed {
        file: "bound.wgsl",
        line: "return sqrt(add(dot3(d, d), LENGTH_TINY));",
        operator: "add(",
        why: "a length is less than a millionth of a pixel either way",
    },
    Allowed {
        file: "flat.wgsl",
        line: "return sqrt(add(square, LENGTH_TINY));",
        operator: "add(",
        why: "a length is less than a millionth of a pixel either way",
    },
    Allowed {
        file: "weber.wgsl",
        line: "return sqrt(add(add(mul(dx, dx), mul(dy, dy)), LENGTH_TINY));",
        operator: "add(",
        why: "a length is less than a millionth of a pixel either way",
    },
    Allowed {
        file: "take.wgsl",
        line: "if lane == 0u {",
        operator: " == ",
        why: "whoever does it does the same, and doing it twice changes nothing more",
    },
    Allowed {
        file: "take_batch.wgsl",
        line: "if lane == 0u {",
        operator: " == ",
        why: "whoever does it does the same, and doing it twice changes nothing more",
    },
    Allowed {
        file: "take.wgsl",
        line: "let safe = is_safe(count + wanted, count - first + wanted, limits);",
        operator: " - ",
        why: "then every surface is looked at, and the answer is the same",
    },
    Allowed {
        file: "take.wgsl",
        line: "return saturating_sub(taken + limits.levels, 2u) <= saturating_sub(limits.stack_room, count);",
        operator: " <= ",
        why: "then every surface is looked at where none has to be, and the answer is the same",
    },
    Allowed {
        file: "scan_batch.wgsl",
        line: "let run = (taken + RUNS - 1u) / RUNS;",
        operator: " - ",
        why: "longer runs share out the same work",
    },
    Allowed {
        file: "scan_batch.wgsl",
        line: "let run = (taken + RUNS - 1u) / RUNS;",
        operator: " / ",
        why: "the first run is then the whole batch",
    },
    Allowed {
        file: "scan_batch.wgsl",
        line: "let end = umin(first + run, taken);",
        operator: " + ",
        why: "the first run wraps around and is then the whole batch; the others are empty",
    },
    Allowed { file: "local.wgsl", line: "if lane == 0u {", operator: " == ", why: "all read the same" },
    Allowed {
        file: "local.wgsl",
        line: "if lane == 0u && index < arrayLength(&groups) {",
        operator: " == ",
        why: "all write the same",
    },
    Allowed {
        file: "local.wgsl",
        line: "if lane == 0u && index < arrayLength(&groups) {",
        operator: " && ",
        why: "all write the same, and fewer groups than a dimension has are as many as were asked for",
    },
    Allowed { file: "dice_any.wgsl", line: "if lane == 0u {", operator: " == ", why: "all write the same" },
    Allowed {
        file: "draw.wgsl",
        line: "let narrow = atomicLoad(&high_x) - atomicLoad(&low_x) <= NARROW",
        operator: " - ",
        why: "a narrow grid may go through the kernel for any grid; a wide one about the left edge is rare",
    },
    Allowed {
        file: "arrange_draw.wgsl",
        line: "for (var index = lane * RUN; index < (lane + 1u) * RUN && index < most; index++) {",
        operator: " && ",
        why: "draws that are counted twice make a chunk smaller, and its bits are the same",
    },
    Allowed {
        file: "arrange_draw.wgsl",
        line: "entries[lane] += tiles_in(blocks.x, blocks.y);",
        operator: " += ",
        why: "then the draws are looked at one by one, and the answer is the same",
    },
    Allowed {
        file: "arrange_draw.wgsl",
        line: "count += 1u;",
        operator: " += ",
        why: "the corpus has too few draws to fill a list; the test of draws that lists have no room for notices",
    },
    Allowed {
        file: "blocks.wgsl",
        line: "return overlap(samples_between(low, high - 1), whole);",
        operator: " - ",
        why: "a block more than a draw can touch shows nothing of it",
    },
    Allowed {
        file: "blocks.wgsl",
        line: "let blocks = ((columns >> 16u) - (columns & 0xffffu)) * ((rows >> 16u) - (rows & 0xffffu));",
        operator: " - ",
        why: "however a group shares out the samples of a draw, it finds the same",
    },
    Allowed {
        file: "scan_bins.wgsl",
        line: "let run = (bin_count() + RUNS - 1u) / RUNS;",
        operator: " - ",
        why: "longer runs share out the same work",
    },
    Allowed {
        file: "scan_bins.wgsl",
        line: "let run = (bin_count() + RUNS - 1u) / RUNS;",
        operator: " / ",
        why: "the first run then has all bins",
    },
    Allowed {
        file: "mesh_places.wgsl",
        line: "let run = (count + RUNS - 1u) / RUNS;",
        operator: " - ",
        why: "longer runs share out the same work",
    },
    Allowed {
        file: "mesh_places.wgsl",
        line: "let run = (count + RUNS - 1u) / RUNS;",
        operator: " / ",
        why: "the first run is then the whole buffer",
    },
    Allowed {
        file: "mesh_places.wgsl",
        line: "let end = umin(first + run, count);",
        operator: " + ",
        why: "the first run wraps around and is then the whole buffer; the others are empty",
    },
    Allowed {
        file: "tess_places.wgsl",
        line: "let run = (count + RUNS - 1u) / RUNS;",
        operator: " - ",
        why: "longer runs share out the same work",
    },
    Allowed {
        file: "tess_places.wgsl",
        line: "let run = (count + RUNS - 1u) / RUNS;",
        operator: " / ",
        why: "the first run then has all patches",
    },
    Allowed {
        file: "tess_evaluate.wgsl",
        line: "if lane == 0u {",
        operator: " == ",
        why: "all write the same",
    },
    Allowed {
        file: "tess_strip.wgsl",
        line: "for (var bit = MARKS / 2u; bit > 0u; bit /= 2u) {",
        operator: " / ",
        why: "all marks lie before those that are looked at too much",
    },
    Allowed {
        file: "tess_topology.wgsl",
        line: "for (var bit = 1u << (RING_BITS - 1u); bit > 0u; bit /= 2u) {",
        operator: " - ",
        why: "there are no rings beyond the last, so that looking for them finds none",
    },
    Allowed {
        file: "tess_evaluate.wgsl",
        line: "if is_pn && lane == 0u {",
        operator: " == ",
        why: "all write the same",
    },
    Allowed {
        file: "tess_evaluate.wgsl",
        line: "if is_pn && lane == 0u {",
        operator: " && ",
        why: "all write the same, and only PN triangles read it",
    },
    Allowed {
        file: "tess_evaluate.wgsl",
        line: "return vec2<u32>(umin(piece * size, count), umin((piece + 1u) * size, count));",
        operator: " + ",
        why: "the first piece wraps around and is then the whole patch; the others are empty",
    },
    Allowed {
        file: "balance.wgsl",
        line: "let run = (limits.groups + RUNS - 1u) / RUNS;",
        operator: " - ",
        why: "longer runs share out the same work",
    },
    Allowed {
        file: "balance.wgsl",
        line: "let run = (limits.groups + RUNS - 1u) / RUNS;",
        operator: " / ",
        why: "the first run then has all groups",
    },
    Allowed {
        file: "balance.wgsl",
        line: "let end = umin(first + run, limits.groups);",
        operator: " + ",
        why: "the first run wraps around and then has all groups; the others are empty",
    },
    Allowed { file: "balance.wgsl", line: "if lane == 0u {", operator: " == ", why: "all write the same" },
    Allowed {
        file: "balance.wgsl",
        line: "a.held + b.held, a.draws + b.draws, a.processed + b.processed,",
        operator: " + ",
        why: "a run's sum has the wrong sign, and so has the sum of all runs, which puts it right",
    },
    Allowed {
        file: "balance.wgsl",
        line: "a.culled + b.culled, a.limited + b.limited, a.micropolygons + b.micropolygons,",
        operator: " + ",
        why: "a run's sum has the wrong sign, and so has the sum of all runs, which puts it right",
    },
    Allowed {
        file: "balance.wgsl",
        line: "a.peak + b.peak,",
        operator: " + ",
        why: "a run's sum has the wrong sign, and so has the sum of all runs, which puts it right",
    },
    Allowed {
        file: "known_answers.wgsl",
        line: "if item < arrayLength(&questions) && item < arrayLength(&answers) {",
        operator: " && ",
        why: "there are as many answers as questions",
    },
    Allowed {
        file: "arrange.wgsl",
        line: "let wanted = (control.taken + ITEM_GROUP - 1u) / ITEM_GROUP;",
        operator: " - ",
        why: "a group too many has nothing to do",
    },
    Allowed {
        file: "arrange.wgsl",
        line: "let wanted = (control.taken + ITEM_GROUP - 1u) / ITEM_GROUP;",
        operator: " / ",
        why: "groups too many have nothing to do",
    },
    Allowed {
        file: "arrange.wgsl",
        line: "groups[1] = (wanted + MOST_GROUPS - 1u) / MOST_GROUPS;",
        operator: " - ",
        why: "a row of groups too many has nothing to do",
    },
    Allowed {
        file: "deal.wgsl",
        line: "const RUN: u32 = LOCAL_STACK / GROUP;",
        operator: " / ",
        why: "the first run is then all of the stack, and in the others there is nothing",
    },
    Allowed {
        file: "accel_box.wgsl",
        line: "if word < 3u {",
        operator: " < ",
        why: "both corners lie one behind the other, so that either is found from the other on devices without memory protection",
    },
    Allowed {
        file: "accel_boxes.wgsl",
        line: "if word < 3u {",
        operator: " < ",
        why: "both corners lie one behind the other, so that either is found from the other on devices without memory protection",
    },
    Allowed {
        file: "accel_codes.wgsl",
        line: "return umin(u32(floor(mul(max(place, 0.0), cells))), (1u << accel_frame.bits) - 1u);",
        operator: " << ",
        why: "no side is as long as all cells, so that no cell lies beyond the last",
    },
    Allowed {
        file: "accel_codes.wgsl",
        line: "return umin(u32(floor(mul(max(place, 0.0), cells))), (1u << accel_frame.bits) - 1u);",
        operator: " - ",
        why: "no side is as long as all cells, so that no cell lies beyond the last",
    },
    Allowed {
        file: "accel_scan.wgsl",
        line: "let run = (count + RUNS - 1u) / RUNS;",
        operator: " - ",
        why: "longer runs share out the same work",
    },
    Allowed {
        file: "accel_scan.wgsl",
        line: "let run = (count + RUNS - 1u) / RUNS;",
        operator: " / ",
        why: "the first run then has all counts",
    },
    Allowed {
        file: "accel_scan.wgsl",
        line: "let end = umin(first + run, count);",
        operator: " + ",
        why: "the first run wraps around and is then everything; the others are empty",
    },
    Allowed {
        file: "accel_scatter.wgsl",
        line: "let end = run_start(block, lane + 1u);",
        operator: " + ",
        why: "the first run wraps around and is then everything; the others are empty",
    },
    Allowed {
        file: "accel_tree.wgsl",
        line: "if index == 0u {",
        operator: " == ",
        why: "all write the same",
    },
    Allowed {
        file: "accel_tree.wgsl",
        line: "} else if index < 2u * count - 1u {",
        operator: " - ",
        why: "what lies behind the last node is nobody's",
    },
    Allowed {
        file: "accel_tree.wgsl",
        line: "for (var step = most / 2; step > 0; step /= 2) {",
        operator: " / ",
        why: "longer steps lead nowhere",
    },
    Allowed {
        file: "accel_tree.wgsl",
        line: "while high - low > 1u {",
        operator: " - ",
        why: "the loop has found it, and runs on until the driver cuts it",
    },
    Allowed { file: "accel_see.wgsl", line: "if lane == 0u {", operator: " == ", why: "all write the same" },
    Allowed {
        file: "accel_see.wgsl",
        line: "if lane == 0u && block < accel_frame.counts {",
        operator: " == ",
        why: "all write the same",
    },
    Allowed {
        file: "accel_see.wgsl",
        line: "if lane == 0u && block < accel_frame.counts {",
        operator: " && ",
        why: "all write the same, and there is a group too much only beyond 65,535",
    },
    Allowed {
        file: "accel_walk.wgsl",
        line: "const STACK_ROOM: u32 = DEEPEST + 2u;",
        operator: " + ",
        why: "only trees over 2³¹ triangles need all of it",
    },
    Allowed {
        file: "accel_walk.wgsl",
        line: "if second.x < first.x {",
        operator: " < ",
        why: "what is farther is then looked at first: slower, and the answer is the same",
    },
    Allowed {
        file: "accel_walk.wgsl",
        line: "height = 0u;",
        operator: " = 0u;",
        why: "the root is then looked at once more",
    },
];

/// Every file with the stages of all kernels that it is a part of.
fn files() -> Vec<File> {
    let mut files: Vec<File> = Vec::new();
    for kernel in Which::ALL {
        for &(name, source) in kernel.files().iter().filter(|(name, _)| *name != "gen.wgsl") {
            match files.iter_mut().find(|file| file.name == name) {
                Some(file) => file.stages.extend(kernel.stages()),
                None => files.push(File { name, source, stages: kernel.stages().to_vec() }),
            }
        }
    }
    files
}

/// Opens a device with the kernels of some stages alone, which takes less time.
fn open(stages: &[Stage], edit: Edit<'_>) -> Result<WgpuDevice, WgpuError> {
    let is_left_out = |name: &str| {
        let own = Which::ALL.into_iter().find(|kernel| kernel.files().last().is_some_and(|f| f.0 == name));
        own.is_some_and(|kernel| kernel.stages().iter().all(|stage| !stages.contains(stage)))
    };
    let edit = |name: &str, source: &str| {
        if is_left_out(name) { String::new() } else { edit(name, source) }
    };
    WgpuDevice::open_unchecked(0, Some(&edit))
}

fn main() -> ExitCode {
    trial::main(&files(), ALLOWED, MUTANTS_A_FILE, CpuDevice::new(1).expect("threads"), open)
}
