//! `micropoly devices`, and the devices that `--backend` means.

use micropoly::devices::{DeviceEntry, all_of, devices_of};
use micropoly::{Backend, Error, Result};

use super::args::Compared;

pub(crate) fn run() -> Result<()> {
    for backend in Backend::ALL {
        match devices_of(backend) {
            Ok(all) => {
                for entry in all {
                    say!("{:<5} {:>2}  {}", backend.name(), entry.index, entry.name);
                    for (name, value) in entry.details {
                        say!("           {name:<28} {value}");
                    }
                }
            }
            Err(missing) => say!("{:<5}  -  {}", backend.name(), missing.why),
        }
    }
    Ok(())
}

/// The devices of one backend or of all; says which backends have none.
pub(super) fn compared(choice: Compared) -> Result<Vec<DeviceEntry>> {
    if let Some(backend) = choice.only() {
        return all_of(backend);
    }
    let mut all = Vec::new();
    for backend in Backend::ALL {
        match devices_of(backend) {
            Ok(entries) => all.extend(entries),
            Err(missing) => say!("{}: {}", backend.name(), missing.why),
        }
    }
    if all.is_empty() {
        return Err(Error::scene(
            "no backend has a device",
            "build with the feature `cpu`, which is on by default",
        ));
    }
    Ok(all)
}
