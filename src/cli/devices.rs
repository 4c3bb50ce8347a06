//! `micropoly devices`.

use micropoly::devices::devices_of;
use micropoly::{Backend, Result};

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
