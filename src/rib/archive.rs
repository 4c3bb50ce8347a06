//! Files that a file reads, and parts of a file that it reads again.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use super::lexer::Lexer;
use super::place::quoted;
use super::reader::Reader;
use super::request::Request;
use crate::error::{Result, read_bytes};

/// Deepest nesting of archives.
const MAX_DEPTH: usize = 16;

/// Most bytes of all archives together, counted each time they are read: a few small files can read each other any number
/// of times.
const MAX_BYTES: u64 = 1 << 31;

/// Archives, those that are being read among them.
#[derive(Debug, Default)]
pub(super) struct Archives {
    /// The folder of the file itself.
    folder: PathBuf,
    /// Files that are being read, from the outermost on.
    open: Vec<PathBuf>,
    depth: usize,
    bytes: u64,
    /// Those that stand in a file, between `ArchiveBegin` and `ArchiveEnd`.
    inline: HashMap<String, Lexer>,
}

impl Archives {
    /// Those of this file.
    pub(super) fn new(path: &Path) -> Self {
        let folder = path.parent().unwrap_or(Path::new("")).to_owned();
        Self { folder, open: vec![same(path)], ..Self::default() }
    }

    /// An archive's file: beside the file that names it, or beside the outermost one.
    fn find(&self, request: &Request, name: &str) -> Result<PathBuf> {
        let beside = request.place.path.parent().unwrap_or(Path::new("")).join(name);
        let found = [beside, self.folder.join(name)].into_iter().find(|path| path.is_file());
        found.ok_or_else(|| {
            let problem = format!("there is no file {}", quoted(name));
            request.wrong(problem, "archives are looked for beside the file that names them")
        })
    }

    /// Counts an archive that is about to be read.
    fn enter(&mut self, request: &Request, bytes: u64) -> Result<()> {
        if self.depth == MAX_DEPTH {
            let problem = format!("archives read each other more than {MAX_DEPTH} deep");
            return Err(request.wrong(problem, "let files name what they read more directly"));
        }
        self.bytes = self.bytes.saturating_add(bytes).saturating_add(1 << 10);
        if self.bytes > MAX_BYTES {
            let problem = "all archives together have more than 2 GiB, counted each time they are read";
            return Err(
                request.wrong(problem, "use ObjectBegin and ObjectInstance for what is there many times")
            );
        }
        self.depth += 1;
        Ok(())
    }
}

/// The same for any name of the same file.
fn same(path: &Path) -> PathBuf {
    path.canonicalize().unwrap_or_else(|_| path.to_owned())
}

impl Reader {
    /// Carries out a request of this kind, or says that it is not.
    pub(super) fn archive(&mut self, request: &mut Request, lexer: &mut Lexer) -> Result<bool> {
        match request.name.as_str() {
            "ReadArchive" => {
                let name = request.text("file's name")?;
                self.read_archive(request, &name)?;
            }
            "ArchiveBegin" => self.inline_archive(request, lexer)?,
            "ArchiveEnd" => return Err(request.wrong("no archive has begun", "remove it")),
            "Procedural" => self.procedural(request)?,
            "IfBegin" | "ElseIf" | "Else" | "IfEnd" => {
                let remedy = "let the program that wrote the file leave out what does not apply";
                return Err(request.wrong("conditions are not supported", remedy));
            }
            _ => return Ok(false),
        }
        Ok(true)
    }

    fn read_archive(&mut self, request: &Request, name: &str) -> Result<()> {
        if let Some(part) = self.archives.inline.get(name).cloned() {
            self.archives.enter(request, part.length() as u64)?;
            self.run(part)?;
        } else {
            let path = self.archives.find(request, name)?;
            let file = same(&path);
            if self.archives.open.contains(&file) {
                let problem = format!("{} is being read already: it reads itself", quoted(name));
                return Err(request.wrong(problem, "remove one of the requests that make the circle"));
            }
            let length = path.metadata().map_or(0, |metadata| metadata.len());
            self.archives.enter(request, length)?;
            self.archives.open.push(file);
            self.run(Lexer::new(path.as_path().into(), &read_bytes(&path)?)?)?;
            self.archives.open.pop();
        }
        self.archives.depth -= 1;
        Ok(())
    }

    /// Keeps the part of the file up to the archive's end.
    fn inline_archive(&mut self, request: &mut Request, lexer: &mut Lexer) -> Result<()> {
        let name = request.text("name")?;
        let (start, mut depth) = (lexer.clone(), 1);
        loop {
            let end = lexer.clone();
            let Some(next) = lexer.request()? else {
                return Err(request.wrong("the archive has no end", "close it with `ArchiveEnd`"));
            };
            match next.name.as_str() {
                "ArchiveBegin" => depth += 1,
                "ArchiveEnd" if depth == 1 => {
                    self.archives.inline.insert(name, start.until(&end));
                    return Ok(());
                }
                "ArchiveEnd" => depth -= 1,
                _ => {}
            }
        }
    }

    /// Of procedures only the one that reads an archive; the bounds that follow are not needed.
    fn procedural(&mut self, request: &mut Request) -> Result<()> {
        let kind = request.text("procedure")?;
        let arguments = request.texts("arguments")?;
        match (kind.as_str(), arguments.first()) {
            ("DelayedReadArchive", Some(name)) => self.read_archive(request, name),
            _ => {
                let what = format!("procedure {} is not supported and ignored", quoted(&kind));
                self.warnings.add(&request.place, what);
                Ok(())
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rib::{RibScene, load, tests};

    /// Writes files and reads the first one.
    fn files(contents: &[(&str, &str)]) -> Result<RibScene> {
        let folder = tempfile::tempdir().expect("a folder");
        for (name, text) in contents {
            let path = folder.path().join(name);
            std::fs::create_dir_all(path.parent().expect("a folder")).expect("written");
            std::fs::write(path, text).expect("written");
        }
        load(&folder.path().join(contents[0].0))
    }

    #[test]
    fn archives_are_found_beside_the_file_that_names_them_and_share_its_state() {
        let scene = files(&[
            ("main.rib", "Color 1 0 0 Translate 1 0 0\nReadArchive \"parts/a.rib\""),
            ("parts/a.rib", "Translate 0 1 0 ReadArchive \"b.rib\"\nReadArchive \"c.rib\""),
            ("parts/b.rib", "\nSphere 1 -1 1 360"),
            ("c.rib", "Disk 0 1 360"),
        ])
        .expect("readable");
        assert_eq!(scene.objects.len(), 2);
        assert_eq!(scene.objects[0].to_world.translation, glam::DVec3::new(1.0, 1.0, 0.0));
        assert_eq!((scene.objects[0].colour, scene.objects[0].place.line), ([1.0, 0.0, 0.0], 2));
        assert!(scene.objects[0].place.path.ends_with("parts/b.rib"));
    }

    #[test]
    fn archives_that_are_not_there_or_read_themselves_are_refused() {
        let error = |contents: &[(&str, &str)]| files(contents).expect_err("refused").to_string();
        assert!(
            error(&[("a.rib", "\nReadArchive \"b.rib\"")])
                .contains("a.rib:2: `ReadArchive`: there is no file")
        );
        let circle = [("a.rib", "ReadArchive \"b.rib\""), ("b.rib", "ReadArchive \"./a.rib\"")];
        assert!(error(&circle).contains("reads itself"));
        assert!(error(&[("a.rib", "ReadArchive \".\"")]).contains("there is no file"));
    }

    #[test]
    fn the_depth_of_archives_is_limited() {
        let chain = |length: usize| -> Vec<(String, String)> {
            let next = |index: usize| format!("ReadArchive \"{}.rib\"", index + 1);
            let text = |index| if index == length { "Sphere 1 -1 1 360".to_owned() } else { next(index) };
            (0..=length).map(|index| (format!("{index}.rib"), text(index))).collect()
        };
        let read = |length| {
            let chain = chain(length);
            let contents: Vec<_> = chain.iter().map(|(name, text)| (name.as_str(), text.as_str())).collect();
            files(&contents)
        };
        assert!(read(MAX_DEPTH).is_ok());
        assert!(read(MAX_DEPTH + 1).expect_err("refused").to_string().contains("16 deep"));
    }

    #[test]
    fn inline_archives_are_read_where_they_are_named() {
        let scene = tests::read(
            "ArchiveBegin \"ball\"\nSphere 1 -1 1 360\nArchiveEnd\nTranslate 1 0 0 ReadArchive \"ball\"\nReadArchive \"ball\"",
        );
        assert_eq!(scene.objects.len(), 2);
        assert_eq!(scene.objects[1].place.line, 2);
        let own = "ArchiveBegin \"x\" ReadArchive \"x\" ArchiveEnd ReadArchive \"x\"";
        assert!(tests::wrong(own).contains("16 deep"));
        assert!(tests::wrong("ArchiveBegin \"x\" Sphere 1 -1 1 360").contains("no end"));
    }

    #[test]
    fn delayed_archives_are_read_and_other_procedures_warned_about() {
        let scene = files(&[
            ("a.rib", "Procedural \"DelayedReadArchive\" [\"b.rib\"] [0 1 0 1 0 1]\nProcedural \"RunProgram\" [\"x\" \"\"] [0 1]"),
            ("b.rib", "Sphere 1 -1 1 360"),
        ])
        .expect("readable");
        assert_eq!(scene.objects.len(), 1);
        assert!(scene.warnings[0].contains("`RunProgram`"), "{:?}", scene.warnings);
    }
}
