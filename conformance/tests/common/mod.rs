//! The devices that tests run on.
#![allow(dead_code, missing_docs, unreachable_pub)] // each test uses its part

use std::io::Write;

use micropoly::Backend;
use micropoly::devices::{DeviceEntry, devices_of};

/// Every device of every backend, with a number of threads for the CPU, which comes first.
///
/// In CI a backend that was built in but has no device is a failure; elsewhere it is said and left out.
pub fn devices() -> Vec<(DeviceEntry, usize)> {
    let mut all = Vec::new();
    for backend in Backend::ALL {
        match devices_of(backend) {
            Ok(entries) => all.extend(entries.into_iter().map(|entry| (entry, 1))),
            Err(missing) if backend.is_built() && std::env::var_os("CI").is_some() => {
                panic!("{}: {}", backend.name(), missing.why)
            }
            Err(missing) => say(&format!("skipped {}: {}", backend.name(), missing.why)),
        }
    }
    all
}

/// A line of the report that tests leave whether they pass or not.
pub fn report(entry: &DeviceEntry, what: &str, verdict: &str) {
    say(&format!("{:<4} {:<32.32} {what:<48} {verdict}", entry.backend.name(), entry.name));
}

/// Prints past the test runner, which would keep it to itself.
fn say(line: &str) {
    let _ = writeln!(std::io::stdout().lock(), "{line}");
}
