//! The command-line program: one file a command.

/// Prints a line to standard output; whoever closed it wants no more.
macro_rules! say {
    ($($what:tt)*) => {
        if std::io::Write::write_fmt(&mut std::io::stdout(), format_args!("{}\n", format_args!($($what)*))).is_err() {
            std::process::exit(0);
        }
    };
}

#[cfg(feature = "cpu")]
mod accel;
mod args;
mod bench;
#[cfg(feature = "cpu")]
mod bench_accel;
mod bench_cage;
mod bench_cull;
mod bench_dicing;
mod bench_raster;
mod bench_tess;
#[cfg(feature = "cpu")]
mod bsp;
mod conform;
mod devices;
mod diff;
mod eval;
mod info;
mod levels;
mod output;
mod plot;
mod progress;
mod render;
mod summary;
mod tess_pattern;
mod tessellate;

use std::process::ExitCode;

use clap::Parser;
use micropoly::Error;

use args::{Arguments, Command};

/// Exit code when a backend is missing, as for wrong arguments.
const UNAVAILABLE: u8 = 2;

/// Exit code when two pictures differ by more than is allowed.
const DIFFERENT: u8 = 3;

/// Runs the program and turns errors into messages and exit codes.
pub(crate) fn main() -> ExitCode {
    let outcome = match Arguments::parse().command {
        Command::Render(arguments) => render::run(&arguments),
        Command::Tessellate(arguments) => tessellate::run(&arguments),
        Command::Info(arguments) => info::run(&arguments),
        Command::Devices => devices::run(),
        Command::Diff(arguments) => match diff::run(&arguments) {
            Ok(false) => return ExitCode::from(DIFFERENT),
            outcome => outcome.map(|_| ()),
        },
        Command::Conform(arguments) => conform::run(&arguments),
        Command::Eval(arguments) => eval::run(&arguments),
        #[cfg(feature = "cpu")]
        Command::Accel(arguments) => accel::run(&arguments),
        Command::TessPattern(arguments) => tess_pattern::run(&arguments),
        #[cfg(feature = "cpu")]
        Command::Bench(arguments) if arguments.bsp => bsp::bench(&arguments),
        #[cfg(feature = "cpu")]
        Command::Bench(ref arguments) if let Some(mesh) = &arguments.accel => {
            bench_accel::run(mesh, arguments)
        }
        Command::Bench(arguments) if arguments.tess => bench_tess::run(&arguments),
        Command::Bench(arguments) if arguments.culling => bench_cull::run(&arguments),
        Command::Bench(arguments) if arguments.cage => bench_cage::run(&arguments),
        Command::Bench(arguments) if arguments.raster => bench_raster::run(&arguments),
        Command::Bench(arguments) if arguments.dicing => bench_dicing::run(&arguments),
        Command::Bench(arguments) => bench::run(&arguments),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            match error {
                Error::Backend { .. } | Error::Refused { .. } => ExitCode::from(UNAVAILABLE),
                _ => ExitCode::FAILURE,
            }
        }
    }
}
