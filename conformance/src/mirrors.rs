//! Do device kernels mirror core file by file and name by name? Told by their texts.

use std::path::Path;

use micropoly_core::stage::Stage;

/// Files that mirror every function of core's by its name; in the others the division of labour differs.
const BY_NAME: [&str; 5] = ["bezier", "known_answers", "num", "project", "split"];

/// The word that a text starts with.
#[must_use]
pub fn first_word(text: &str) -> String {
    text.chars().take_while(|&c| c.is_alphanumeric() || c == '_').collect()
}

/// Checks the kernel files of a backend, given as name and source; for tests.
///
/// Every stage has a file of its name, every file names what of core it mirrors, or that it mirrors nothing,
/// and where a file mirrors core by name, no function is missing. `function_of` gives the name of the function
/// that starts on a line.
///
/// # Panics
/// When one of these does not hold.
pub fn assert_mirrors(files: &[(&str, &str)], extension: &str, function_of: impl Fn(&str) -> Option<String>) {
    for stage in Stage::ALL {
        let kernel = |source: &str| source.contains(&format!("stage_{}(", stage.name()));
        let is_there = files.iter().any(|&(name, source)| {
            name.strip_suffix(extension) == Some(&format!("{}.", stage.name())) || kernel(source)
        });
        assert!(is_there, "no kernel of stage {}", stage.name());
    }
    for (name, source) in files.iter().filter(|(name, _)| !name.starts_with("gen.")) {
        let head: String = source.lines().take_while(|line| line.starts_with("//")).collect();
        assert!(head.contains("irrors ") || head.contains("No mirror in core"), "{name}: {head}");
        for path in
            head.split([' ', ':', ',']).filter(|word| word.starts_with("core/") && word.ends_with(".rs"))
        {
            let core = read(path).unwrap_or_else(|| panic!("{name} mirrors {path}, which is not there"));
            let stem = name.split('.').next().unwrap_or_default();
            if BY_NAME.contains(&stem) {
                assert_functions(name, source, &core, &function_of);
            }
        }
    }
}

fn read(path: &str) -> Option<String> {
    std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(path)).ok()
}

fn assert_functions(name: &str, source: &str, core: &str, function_of: impl Fn(&str) -> Option<String>) {
    let found: Vec<String> = source.lines().filter_map(function_of).collect();
    for function in core.lines().filter_map(|line| line.split_once("fn ")).map(|(_, rest)| first_word(rest)) {
        assert!(found.contains(&function), "{name} has no function {function}");
    }
}
