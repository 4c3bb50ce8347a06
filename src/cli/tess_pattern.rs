//! `micropoly tess-pattern`: what the tessellator makes of levels, line by line, to be compared with drivers.

use std::io::{Read, Write};
use std::path::PathBuf;

use clap::Args;
use micropoly::tess::pattern::{ask, questions};
use micropoly::{Error, Result};

use super::args::BackendChoice;
use super::levels::ProfileChoice;

#[derive(Debug, Args)]
pub(crate) struct TessPatternArguments {
    /// Whose rule places points.
    #[arg(long, value_enum, default_value_t = ProfileChoice::D3d11)]
    profile: ProfileChoice,
    /// What to tessellate on. The answers do not depend on it.
    #[arg(long, value_enum, default_value_t = BackendChoice::Cpu)]
    backend: BackendChoice,
    /// Number or part of the name of a device of the backend (see `micropoly devices`).
    #[arg(long, value_name = "N|NAME")]
    device: Option<String>,
}

pub(crate) fn run(arguments: &TessPatternArguments) -> Result<()> {
    let mut text = String::new();
    let name = PathBuf::from("standard input");
    let unread = |source| Error::Read { path: name.clone(), source };
    std::io::stdin().lock().read_to_string(&mut text).map_err(unread)?;
    let questions = questions(&text, &name)?;
    let mut out = std::io::BufWriter::new(std::io::stdout().lock());
    let unwritten =
        |error: std::io::Error| Error::Write { path: "standard output".into(), why: error.to_string() };
    let (backend, device) = (arguments.backend.into(), arguments.device.as_deref());
    let notes = ask(backend, device, &questions, arguments.profile.into(), |answers| {
        for answer in answers {
            serde_json::to_writer(&mut out, answer).map_err(|error| unwritten(error.into()))?;
            out.write_all(b"\n").map_err(unwritten)?;
        }
        Ok(())
    })?;
    notes.iter().for_each(|note| eprintln!("note: {note}"));
    out.flush().map_err(unwritten)
}
