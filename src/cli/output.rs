//! Image files that `render` writes: kinds, names of numbered frames.

use std::path::{Path, PathBuf};

use micropoly::{Error, Film, Precision, Rendering, Result, extension};

/// What an image file holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Png8,
    Png16,
    Exr(Precision),
}

impl Kind {
    /// By the end of its name, and the bits of a value.
    pub(crate) fn of(path: &Path, bits: Option<u32>) -> Result<Self> {
        let is_exr = extension(path) == "exr";
        match (is_exr, bits) {
            (false, None | Some(8)) => Ok(Self::Png8),
            (false, Some(16)) => Ok(Self::Png16),
            (true, None | Some(16)) => Ok(Self::Exr(Precision::Half)),
            (true, Some(32)) => Ok(Self::Exr(Precision::Float)),
            (_, Some(bits)) => {
                let (kind, possible) = if is_exr { ("an EXR", "16 or 32") } else { ("a PNG", "8 or 16") };
                let problem = format!("{kind} file cannot hold {bits} bits a value");
                Err(Error::scene(problem, format!("choose --bits {possible}, or another kind of file")))
            }
        }
    }

    /// Does it need linear values?
    pub(crate) fn needs_film(self) -> bool {
        self != Self::Png8
    }

    /// Writes a rendering to a file.
    pub(crate) fn save(self, rendering: &Rendering, path: &Path) -> Result<()> {
        let film = || -> &Film { rendering.film.as_ref().expect("it was asked for") };
        match self {
            Self::Png8 => rendering.image.save_png(path),
            Self::Png16 => film().save_png16(path),
            Self::Exr(precision) => film().save_exr(path, precision),
        }
    }
}

/// The file of a frame: the last run of # in the name stands for its number, with zeros before it.
pub(crate) fn numbered(path: &Path, frame: u32) -> Option<PathBuf> {
    let name = path.file_name()?.to_str()?;
    let end = name.rfind('#')? + 1;
    let start = name[..end]
        .rfind(|c| c != '#')
        .map_or(0, |at| at + name[at..].chars().next().map_or(1, char::len_utf8));
    let number = format!("{frame:0width$}", width = end - start);
    Some(path.with_file_name(format!("{}{number}{}", &name[..start], &name[end..])))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_are_numbered_in_the_last_run() {
        let name = |path: &str, frame| numbered(Path::new(path), frame);
        assert_eq!(name("a#/b#c###.png", 7), Some("a#/b#c007.png".into()));
        assert_eq!(name("#.png", 1234), Some("1234.png".into()));
        assert_eq!(name("ä##", 5), Some("ä05".into()));
        assert_eq!(name("a#/b.png", 7), None);
    }

    #[test]
    fn kinds_are_told_by_name_and_bits() {
        let kind = |name: &str, bits| Kind::of(Path::new(name), bits).ok();
        assert_eq!(kind("a.png", None), Some(Kind::Png8));
        assert_eq!(kind("a.PNG", Some(16)), Some(Kind::Png16));
        assert_eq!(kind("a.exr", None), Some(Kind::Exr(Precision::Half)));
        assert_eq!(kind("a.exr", Some(32)), Some(Kind::Exr(Precision::Float)));
        assert_eq!((kind("a.png", Some(32)), kind("a.exr", Some(8))), (None, None));
    }
}
