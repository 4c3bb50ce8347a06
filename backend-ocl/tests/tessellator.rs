//! The tessellator on OpenCL gives the CPU's bits: stage by stage, all pairs of levels, and with a caller's own steps.
//!
//! Runs on every OpenCL device there is; without one it fails, since nothing would be tested.

use std::sync::Arc;

use micropoly_backend_cpu::CpuDevice;
use micropoly_backend_ocl::{OclDevice, OclError, OpenOptions, devices};
use micropoly_conformance::report::check_stage;
use micropoly_core::abi::{
    TESS_COORDINATES, TESS_EQUAL, TESS_GIVEN, TESS_ISOLINES, TESS_LENGTH, TESS_PN, TESS_QUADS,
    TESS_STADLBAUER, TESS_TRIANGLES, TESS_UNIT, TessFrame, TessLevels, TessPatch, TessTotals, TessVertex,
};
use micropoly_core::backend::Device;
use micropoly_core::kernel::tess_evaluate::corners;
use micropoly_core::num::{add, float, max, mul, sub};
use micropoly_core::stage::Stage;
use micropoly_core::tess::stream::{TessInput, TessPlan};

/// Everything that an OpenCL compiler may be told to break.
const HOSTILE: &str = "-cl-fast-relaxed-math -cl-mad-enable -cl-denorms-are-zero";
/// The tessellator's stages.
const STAGES: [Stage; 3] = [Stage::TessControl, Stage::TessPlaces, Stage::TessEvaluate];
/// Inputs a stage.
const INPUTS: u64 = 40;
/// Bytes of a tessellation's buffers.
const MEMORY: u64 = 64 << 20;

fn tessellator() -> OpenOptions<'static> {
    OpenOptions { first: &STAGES, ..OpenOptions::default() }
}

/// Opens every device there is.
fn opened(options: &OpenOptions<'_>) -> Vec<OclDevice> {
    let count = devices().unwrap_or_else(|error| panic!("this test needs an OpenCL device: {error}")).len();
    (0..count)
        .map(|index| OclDevice::open(index, options).unwrap_or_else(|error| panic!("{error}")))
        .collect()
}

fn cpu() -> CpuDevice {
    CpuDevice::new(1).expect("threads")
}

#[test]
fn stages_have_the_bits_of_the_cpu() {
    let barrier = OpenOptions { barrier: true, ..tessellator() };
    let hostile = OpenOptions { build_options: HOSTILE.to_owned(), skip_check: true, ..barrier.clone() };
    for options in [tessellator(), barrier, hostile] {
        for mut device in opened(&options) {
            for stage in STAGES {
                let report = check_stage(&mut cpu(), &mut device, stage, INPUTS);
                assert!(report.agrees(), "{}, {options:?}: {report:?}", device.name());
            }
        }
    }
}
