//! Every stage alone on every device of the backends built in, bit by bit against the CPU with one thread; and
//! the comparison itself: its inputs matter, and it finds a single wrong bit.

mod common;

use common::{devices, report};
use micropoly::devices::{Job, with_device};
use micropoly_backend_cpu::CpuDevice;
use micropoly_conformance::corpus::{ROUNDS, input};
use micropoly_conformance::report::{StageReport, check_stage};
use micropoly_conformance::stages::{first_difference, run_stage};
use micropoly_core::backend::Device;
use micropoly_core::stage::Stage;

fn cpu(threads: usize) -> CpuDevice {
    CpuDevice::new(threads).expect("threads")
}

/// All stages on one device.
struct AllStages;

impl Job for AllStages {
    type Output = Vec<StageReport>;

    fn run<D: Device>(self, mut device: D, _: String) -> Self::Output {
        Stage::ALL.map(|stage| check_stage(&mut cpu(1), &mut device, stage, ROUNDS)).into()
    }
}

#[test]
fn every_stage_gives_the_same_bits_on_every_device() {
    for (entry, _) in devices() {
        for stage in with_device(&entry, 3, AllStages).expect("opens") {
            assert!(stage.agrees(), "{}: {stage:?}", entry.name);
            report(&entry, &format!("stage {}, {} inputs", stage.stage, stage.inputs), "same bits");
        }
    }
}

#[test]
fn inputs_make_every_stage_write_something() {
    for stage in Stage::ALL {
        let wrote = (0..ROUNDS).filter(|&round| {
            let input = input(stage, round);
            let outputs = run_stage(&mut cpu(1), &input).expect("runs");
            outputs
                .iter()
                .zip(&input.buffers)
                .any(|(after, before)| after.as_ref().is_some_and(|a| a != before))
        });
        assert!(wrote.count() as u64 > ROUNDS / 2, "{stage:?}");
    }
}

#[test]
fn a_single_wrong_bit_is_found_and_named() {
    let input = input(Stage::Bound, 1);
    let expected = run_stage(&mut cpu(1), &input).expect("runs");
    let mut found = expected.clone();
    let verdicts = found[6].as_mut().expect("an output");
    verdicts[5 * 7 + 1] ^= 1;
    let difference = first_difference(Stage::Bound, &expected, &found).expect("a difference");
    assert_eq!((difference.buffer, difference.item, difference.field.as_str()), ("verdicts", 7, "columns"));
}
