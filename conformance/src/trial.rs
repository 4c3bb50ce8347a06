//! Runs mutants of a backend's kernels, each in a process of its own: a changed kernel may crash or hang.
//!
//! A test without harness calls [`main`]. Run as it is, it starts itself again for every mutant of a sample, or
//! for all of them where the environment has `MUTANTS=all` (or a number a file); with `MUTANTS_OF` set, only
//! for the files named in it, separated by commas; with `MUTANTS_SHARE` = `k/n` only for every n-th file, from the k-th on;
//! with `MUTANTS_VERBOSE` each is told of as it ends.

use std::collections::BTreeMap;
use std::fmt::Display;
use std::io::Read;
use std::process::{Child, Command, ExitCode, Stdio};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use micropoly_core::backend::Device;
use micropoly_core::stage::Stage;

use crate::corpus::ROUNDS;
use crate::mutation::{Mutant, mutants, sample};
use crate::report::check_stage;

/// Mutants of a stage's own file where the comparison of that stage noticed none.
const MORE: usize = 8;
/// After this long a mutant counts as hanging; kernels that nobody changed are given four times as long.
const PATIENCE: Duration = Duration::from_secs(90);
/// Argument before file and number of a mutant, for the process that runs it.
const ONE: &str = "--mutant";
/// In the place of a file: nothing is changed, and the number is that of a stage.
const CONTROL: &str = "-";
/// What such a process prints before its findings.
const FOUND: &str = "\nfound: ";
/// No mutant is ever seen again.
const NO_CACHES: [(&str, &str); 2] = [("POCL_KERNEL_CACHE", "0"), ("MESA_SHADER_CACHE_DISABLE", "true")];
/// Stages that are opened together, those first that are compiled and run soonest.
const QUICK_TO_SLOW: [&[Stage]; 8] = [
    &[
        Stage::Take,
        Stage::Flush,
        Stage::Scan,
        Stage::Split,
        Stage::Balance,
        Stage::Deal,
        Stage::MeshPlaces,
        Stage::KnownAnswers,
        Stage::Blend,
        Stage::Filter,
    ],
    &[Stage::TessControl, Stage::TessPlaces, Stage::TessEvaluate],
    &[
        Stage::AccelExtent,
        Stage::AccelCodes,
        Stage::AccelCount,
        Stage::AccelScan,
        Stage::AccelScatter,
        Stage::AccelTree,
        Stage::AccelBoxes,
        Stage::AccelSee,
        Stage::AccelFill,
        Stage::AccelRays,
        Stage::AccelNearest,
        Stage::BspSides,
        Stage::BspCells,
        Stage::BspRank,
    ],
    &[Stage::Bound],
    &[Stage::Mesh],
    &[Stage::Local],
    &[Stage::Draw],
    &[Stage::SortLast],
];

/// Gives a kernel file's name and source, takes the source to be built.
pub type Edit<'a> = &'a dyn Fn(&str, &str) -> String;

/// A kernel file.
#[derive(Clone, Debug)]
pub struct File {
    /// Its name.
    pub name: &'static str,
    /// Its contents.
    pub source: &'static str,
    /// The stages whose kernels it is a part of.
    pub stages: Vec<Stage>,
}

/// A mutant that nothing can notice, and why.
#[derive(Clone, Copy, Debug)]
pub struct Allowed {
    /// The file.
    pub file: &'static str,
    /// The line before the change, without the blanks around it.
    pub line: &'static str,
    /// What is changed.
    pub operator: &'static str,
    /// Why that makes no difference.
    pub why: &'static str,
}

/// What became of a mutant.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Fate {
    /// The comparison of this stage noticed: other bits, or an error.
    Noticed(&'static str),
    /// The compiler did not take it, which proves nothing.
    NotCompiled,
    /// It crashed or hung.
    Died,
    /// Nothing noticed.
    Survived,
}

impl Fate {
    fn name(self) -> &'static str {
        match self {
            Self::Noticed(stage) => stage,
            Self::NotCompiled => "not compiled",
            Self::Died => "died",
            Self::Survived => "survived",
        }
    }

    fn of_name(name: &str) -> Option<Self> {
        let noticed = Stage::ALL.into_iter().map(|stage| Self::Noticed(stage.name()));
        noticed.chain([Self::NotCompiled, Self::Survived]).find(|fate| fate.name() == name)
    }
}

/// The whole test. `open` opens a device on which the stages given can be run, its arithmetic unchecked; `usual` mutants of
/// each file are run where nobody asks for another number.
pub fn main<R: Device, D: Device, E: Display>(
    files: &[File],
    allowed: &[Allowed],
    usual: usize,
    mut reference: R,
    open: impl Fn(&[Stage], Edit<'_>) -> Result<D, E>,
) -> ExitCode {
    let arguments: Vec<String> = std::env::args().collect();
    let Some(place) = arguments.iter().position(|argument| argument == ONE) else {
        return if is_meant(&arguments) { run_all(files, allowed, usual) } else { ExitCode::SUCCESS };
    };
    let (name, number) = (arguments[place + 1].as_str(), arguments[place + 2].parse().unwrap_or(0));
    let fate = match files.iter().find(|file| file.name == name) {
        Some(file) => {
            let mutant = &mutants(file.source)[number];
            let edit = |other: &str, source: &str| {
                if other == name { mutant.source.clone() } else { source.to_owned() }
            };
            fate_of(&mut reference, &file.stages, &edit, open)
        }
        None => fate_of(&mut reference, &[Stage::ALL[number]], &|_, source| source.to_owned(), open),
    };
    println!("{FOUND}{}", fate.name());
    ExitCode::SUCCESS
}

/// Does the name of a test, if there is one among cargo's arguments, mean this one?
fn is_meant(arguments: &[String]) -> bool {
    let mut names = arguments[1..].iter().filter(|argument| !argument.starts_with('-'));
    names.all(|name| "mutation".contains(name.as_str()))
}

/// Runs the corpus of some stages, until one notices.
fn fate_of<R: Device, D: Device, E: Display>(
    reference: &mut R,
    stages: &[Stage],
    edit: Edit<'_>,
    open: impl Fn(&[Stage], Edit<'_>) -> Result<D, E>,
) -> Fate {
    for together in QUICK_TO_SLOW {
        let together: Vec<Stage> = together.iter().copied().filter(|stage| stages.contains(stage)).collect();
        if together.is_empty() {
            continue;
        }
        let mut device = match open(&together, edit) {
            Ok(device) => device,
            Err(error) => {
                println!("{error}");
                return Fate::NotCompiled;
            }
        };
        for stage in together {
            let report = check_stage(reference, &mut device, stage, ROUNDS);
            if !report.agrees() {
                println!("{report:?}");
                return Fate::Noticed(stage.name());
            }
        }
    }
    Fate::Survived
}

/// A mutant to be run, and where it stands among the mutants of its file.
struct Task<'a> {
    file: &'a File,
    number: usize,
    mutant: Mutant,
}

fn run_all(files: &[File], allowed: &[Allowed], usual: usize) -> ExitCode {
    assert_all_are_there(files, allowed);
    let started = Instant::now();
    let mut tasks: Vec<Task<'_>> = files.iter().flat_map(|file| tasks(file, usual)).collect();
    let is_tried = |stage: &Stage| tasks.iter().any(|task| task.file.stages.contains(stage));
    let tried = Stage::ALL.into_iter().filter(is_tried);
    let control = fates(&tried.map(|stage| (CONTROL, stage as usize)).collect::<Vec<_>>());
    assert!(
        control.iter().all(|fate| *fate == Fate::Survived),
        "unchanged kernels are at fault: {control:?}"
    );
    let mut fates = fates_of(&tasks);
    // Where all that was tried crashed, some more may not.
    let more: Vec<Task<'_>> = blind(&fates).flat_map(|stage| further(files, stage, &tasks)).collect();
    fates.extend(fates_of(&more));
    tasks.extend(more);
    print_table(files, &tasks, &fates);
    println!("{} mutants in {:.0} s", tasks.len(), started.elapsed().as_secs_f64());
    let mut blind = blind(&fates).peekable();
    let none_is_blind = blind.peek().is_none();
    blind.for_each(|stage| println!("no mutant was noticed by the comparison of {stage}"));
    match survivors(&tasks, &fates, allowed) {
        0 if none_is_blind => ExitCode::SUCCESS,
        _ => ExitCode::FAILURE,
    }
}

fn fates_of(tasks: &[Task<'_>]) -> Vec<Fate> {
    fates(&tasks.iter().map(|task| (task.file.name, task.number)).collect::<Vec<_>>())
}

/// Stages whose comparison noticed nothing, if all files were tried.
fn blind(fates: &[Fate]) -> impl Iterator<Item = &'static str> {
    let all_files = std::env::var_os("MUTANTS_OF").is_none() && share().is_none();
    let names = Stage::ALL.into_iter().map(Stage::name);
    names.filter(move |&name| all_files && !fates.contains(&Fate::Noticed(name)))
}

/// More mutants of a stage's own file, which have not been run yet.
fn further<'a>(files: &'a [File], stage: &str, done: &[Task<'_>]) -> Vec<Task<'a>> {
    let Some(file) = files.iter().find(|file| file.name.split('.').next() == Some(stage)) else {
        return Vec::new();
    };
    let all: Vec<_> = mutants(file.source).into_iter().enumerate().collect();
    let is_new =
        |number: &usize| !done.iter().any(|task| task.file.name == file.name && task.number == *number);
    let chosen = sample(all, MORE).into_iter().filter(|(number, _)| is_new(number));
    chosen.map(|(number, mutant)| Task { file, number, mutant }).collect()
}

/// `MUTANTS_SHARE`: which of how many shares of the files are tried.
fn share() -> Option<(usize, usize)> {
    let text = std::env::var("MUTANTS_SHARE").ok()?;
    let (which, of) = text.split_once('/')?;
    let (which, of) = (which.parse().ok()?, of.parse().ok()?);
    (of > 0).then_some((which, of))
}

/// Is a file in the share that is tried?
fn is_shared(name: &str) -> bool {
    share().is_none_or(|(which, of)| name.bytes().map(usize::from).sum::<usize>() % of == which % of)
}

/// The mutants of a file that are to be run.
fn tasks(file: &File, usual: usize) -> Vec<Task<'_>> {
    let only = std::env::var("MUTANTS_OF").unwrap_or_default();
    if (!only.is_empty() && !only.split(',').any(|name| name == file.name)) || !is_shared(file.name) {
        return Vec::new();
    }
    let most = match std::env::var("MUTANTS").as_deref() {
        Ok("all") => usize::MAX,
        Ok(number) => number.parse().unwrap_or(usual),
        Err(_) => usual,
    };
    let all: Vec<_> = mutants(file.source).into_iter().enumerate().collect();
    sample(all, most).into_iter().map(|(number, mutant)| Task { file, number, mutant }).collect()
}

/// Runs mutants, given as file and number, as many at once as there are cores.
fn fates(mutants: &[(&str, usize)]) -> Vec<Fate> {
    let next = AtomicUsize::new(0);
    let fates = Mutex::new(vec![Fate::Survived; mutants.len()]);
    let worker = || {
        loop {
            let at = next.fetch_add(1, Ordering::Relaxed);
            let Some(&(file, number)) = mutants.get(at) else { break };
            let fate = run_one(file, number);
            fates.lock().unwrap_or_else(PoisonError::into_inner)[at] = fate;
        }
    };
    std::thread::scope(|scope| {
        for _ in 0..std::thread::available_parallelism().map_or(1, usize::from) {
            scope.spawn(worker);
        }
    });
    fates.into_inner().unwrap_or_else(PoisonError::into_inner)
}

/// Runs one mutant in a process of its own.
fn run_one(file: &str, number: usize) -> Fate {
    let program = std::env::current_exe().expect("a path");
    let child = Command::new(program)
        .args([ONE, file, &number.to_string()])
        .envs(NO_CACHES)
        // Where a driver that fails may leave notes.
        .current_dir(std::env::temp_dir())
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn();
    let patience = if file == CONTROL { 4 * PATIENCE } else { PATIENCE };
    let output = wait(child.expect("starts"), patience);
    let (told, fate) = output.rsplit_once(FOUND).unwrap_or((&output, ""));
    let fate = Fate::of_name(fate.trim()).unwrap_or(Fate::Died);
    if std::env::var_os("MUTANTS_VERBOSE").is_some() {
        println!("{file} {number}: {} {}", fate.name(), told.trim());
    }
    fate
}

/// What a process prints until it ends or has to be ended.
fn wait(mut child: Child, patience: Duration) -> String {
    let mut output = String::new();
    let mut pipe = child.stdout.take().expect("it was asked for");
    let started = Instant::now();
    while child.try_wait().is_ok_and(|status| status.is_none()) {
        if started.elapsed() > patience {
            let _ = child.kill(); // it may have ended by now
        }
        std::thread::sleep(Duration::from_millis(10));
    }
    let _ = pipe.read_to_string(&mut output); // nothing to be read is an answer, too
    output
}

fn print_table(files: &[File], tasks: &[Task<'_>], fates: &[Fate]) {
    println!("{:<20} {:>8} {:>4}  fates", "file", "mutants", "run");
    for file in files {
        let own = tasks.iter().zip(fates).filter(|(task, _)| task.file.name == file.name);
        let mut counts = BTreeMap::new();
        for (_, fate) in own {
            *counts.entry(fate).or_insert(0) += 1;
        }
        let run: usize = counts.values().sum();
        let fates: Vec<String> =
            counts.iter().map(|(fate, count)| format!("{} {count}", fate.name())).collect();
        println!("{:<20} {:>8} {run:>4}  {}", file.name, mutants(file.source).len(), fates.join(", "));
    }
}

/// Prints the survivors; gives the number of those that should not have survived.
fn survivors(tasks: &[Task<'_>], fates: &[Fate], allowed: &[Allowed]) -> usize {
    let mut wrong = 0;
    for (task, _) in tasks.iter().zip(fates).filter(|(_, fate)| **fate == Fate::Survived) {
        let Task { file, mutant, .. } = task;
        let (from, to) = mutant.change;
        let excuse = allowed.iter().find(|allowed| {
            allowed.file == file.name && allowed.line == mutant.text && allowed.operator == from
        });
        wrong += usize::from(excuse.is_none());
        let why = excuse.map_or("NOTHING NOTICED", |excuse| excuse.why);
        println!("{}:{}: {from:?} → {to:?} in `{}`: {why}", file.name, mutant.line, mutant.text);
    }
    wrong
}

/// An excuse for a line that is no longer there is out of date.
fn assert_all_are_there(files: &[File], allowed: &[Allowed]) {
    for Allowed { file: name, line, operator, .. } in allowed {
        let file = files.iter().find(|file| file.name == *name);
        let there = file.is_some_and(|file| {
            mutants(file.source).iter().any(|mutant| mutant.text == *line && mutant.change.0 == *operator)
        });
        assert!(there, "{name} has no line `{line}` with {operator:?}");
    }
}
