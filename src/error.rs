//! Errors as a user reads them: where, what, and what to do about it.

use std::error::Error as StdError;
use std::path::{Path, PathBuf};

use micropoly_core::error::PlanError;

/// Why a scene could not be read or rendered.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// A file could not be read.
    #[error("{}: cannot be read: {source}\n  help: check the path and its permissions", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// What the operating system said.
        source: std::io::Error,
    },
    /// A file could not be written.
    #[error("{}: cannot be written: {why}\n  help: check that the folder exists and may be written to", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// What went wrong.
        why: String,
    },
    /// A file does not hold what it should.
    #[error("{}:{line}: {problem}\n  help: {remedy}", path.display())]
    Format {
        /// The file.
        path: PathBuf,
        /// Line, counted from 1.
        line: usize,
        /// What is wrong there.
        problem: String,
        /// What to do about it.
        remedy: String,
    },
    /// A file without lines does not hold what it should.
    #[error("{}: {problem}\n  help: {remedy}", path.display())]
    Content {
        /// The file.
        path: PathBuf,
        /// What is wrong, and with which part of it.
        problem: String,
        /// What to do about it.
        remedy: String,
    },
    /// Scene and options do not go together.
    #[error("{problem}\n  help: {remedy}")]
    Scene {
        /// What is wrong.
        problem: String,
        /// What to do about it.
        remedy: String,
    },
    /// No frame can have such sizes, or the memory budget is too small.
    #[error("{error}\n  help: {help}", error = .0, help = remedy(.0))]
    Plan(PlanError),
    /// A backend is not there.
    #[error("backend {backend} is not available: {why}\n  help: {remedy}")]
    Backend {
        /// Which backend.
        backend: &'static str,
        /// Why not.
        why: String,
        /// What to do about it.
        remedy: &'static str,
    },
    /// A device is there but cannot be used.
    #[error("{backend} device {device} cannot be used: {why}")]
    Refused {
        /// Its backend.
        backend: &'static str,
        /// Its name.
        device: String,
        /// Why not, and what to do about it.
        why: String,
    },
    /// The device failed.
    #[error("the device failed: {0}\n  help: try a smaller --res, --batch or --memory")]
    Device(String),
}

/// Everything that can fail in this crate fails with [`Error`].
pub type Result<T> = std::result::Result<T, Error>;

impl Error {
    pub(crate) fn format(
        path: &Path,
        line: usize,
        problem: impl Into<String>,
        remedy: impl Into<String>,
    ) -> Self {
        Self::Format { path: path.to_owned(), line, problem: problem.into(), remedy: remedy.into() }
    }

    pub(crate) fn content(path: &Path, problem: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self::Content { path: path.to_owned(), problem: problem.into(), remedy: remedy.into() }
    }

    /// What a device reports: either its own error, or that of the plan that ran on it.
    pub(crate) fn on_device(error: &impl StdError) -> Self {
        match error.source().and_then(|source| source.downcast_ref()) {
            Some(&plan) => Self::Plan(plan),
            None => Self::Device(error.to_string()),
        }
    }

    /// An error that no single file is to blame for.
    #[must_use]
    pub fn scene(problem: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self::Scene { problem: problem.into(), remedy: remedy.into() }
    }
}

fn remedy(error: &PlanError) -> String {
    match error {
        PlanError::Invalid { option, least, most, .. } => format!("choose a {option} from {least} to {most}"),
        PlanError::Budget { needed, .. } => format!("use --memory {needed} or more (to render: or a smaller --res)"),
        PlanError::Level { needed, .. } => format!(
            "use --memory {needed} or more (a later level may need more still), or --scheduler adaptive, which needs \
             no more than a fixed amount"
        ),
        PlanError::Tessellation { .. } => "see `micropoly_core::tess::stream::TessInput`".to_owned(),
        PlanError::Unfinished { .. } => "see `micropoly devices`, or use --backend cpu".to_owned(),
        PlanError::BreadthMesh => "choose adaptive, bounded, local or stack".to_owned(),
        PlanError::TooLarge { buffer: "vertices" | "indices", .. } => {
            "choose a larger --micropolygon-size, another device (see `micropoly devices` for limits) or --backend cpu"
                .to_owned()
        }
        PlanError::TooLarge { .. } => {
            "use another device (see `micropoly devices` for limits), --backend cpu, or a smaller scene or --res"
                .to_owned()
        }
        PlanError::Overflow { .. } => "this is a bug: please report it with the scene".to_owned(),
    }
}

/// Line, counted from 1, of a byte offset in a text.
pub(crate) fn line_at(text: &[u8], offset: usize) -> usize {
    1 + text[..offset.min(text.len())].iter().filter(|&&byte| byte == b'\n').count()
}

/// Reads a file.
pub(crate) fn read_bytes(path: &Path) -> Result<Vec<u8>> {
    std::fs::read(path).map_err(|source| Error::Read { path: path.to_owned(), source })
}

/// Reads a text file.
pub(crate) fn read_text(path: &Path) -> Result<String> {
    utf8(path, read_bytes(path)?)
}

/// The text in these bytes, without a byte order mark.
pub(crate) fn utf8(path: &Path, bytes: Vec<u8>) -> Result<String> {
    let text = String::from_utf8(bytes).map_err(|error| {
        let line = line_at(error.as_bytes(), error.utf8_error().valid_up_to());
        Error::format(path, line, "this is not text in UTF-8", "is this the right file?")
    })?;
    Ok(text.strip_prefix('\u{feff}').map_or(text.clone(), str::to_owned))
}
