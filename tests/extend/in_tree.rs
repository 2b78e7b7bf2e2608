//! What adding a law, an element or a load inside the tree touches: of each that there is, where its name stands. One
//! Rust file with its `mod`, one WGSL file and one line of a list are all that may have it; beside them stand here
//! those few that are about this law or element alone, and why.

use super::source::code;
use sinew::scene::schema::LOADS;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// Files that name laws or elements of their own accord: what they are, and which names.
const ABOUT: &[(&str, &str, &[&str])] = &[
    (
        "src/backend/cpu/element_kernel.rs",
        "laws with kernels of their own, each by its measurement in docs/performance.md",
        &["NeoHookean", "StableNeoHookean", "MooneyRivlin", "Ogden"],
    ),
    ("src/backend/user_law/energy.rs", "formulas that are these laws", &["NeoHookean", "MooneyRivlin"]),
    ("src/scene/validate/elastic_law.rs", "what to begin with where there is no law", &["neo_hookean"]),
    ("src/materials/corotational.rs", "the law in frames that its word makes, too", &["Linear"]),
    ("src/materials/corotational_frame.rs", "made of the other law, in a frame", &["Linear"]),
    ("src/assembly/frames.rs", "which elements have frames, where others are refused", &["Tet4", "Hex8"]),
    ("systems/nodal_volume.rs", "the system of this element's nodal means", &["Tet4NodalPressure"]),
    ("src/simulation/explain/effects.rs", "what turns that system on", &["Tet4NodalPressure"]),
    ("src/backend/block_kernel.rs", "the stage that reads these means", &["tet4_nodal_pressure"]),
    (
        "src/scene/schema/body.rs",
        "what files with cells of these kinds become where nothing is said",
        &["Tet4", "tet4", "Hex8", "hex8"],
    ),
    (
        "src/scene/validate/geometry.rs",
        "what cells of files may become, and what has no hourglass modes",
        &["Tet4", "Tet4NodalPressure", "Hex8", "Hex8MeanDilatation"],
    ),
    ("src/scene/schema/per_copy.rs", "numbers that go evenly from one to another", &["Linear"]),
    ("src/scene/validate/per_copy.rs", "the word for such numbers", &["Linear"]),
    ("src/observation/guards.rs", "what to take where hourglass modes grow", &["Hex8MeanDilatation"]),
    ("src/elements/tet4_nodal_pressure.rs", "made of the other element", &["Tet4"]),
    ("src/elements/hex8_mean_dilatation.rs", "made of the other element", &["Hex8", "hex8"]),
    ("src/elements/wedge6.rs", "its WGSL is that of several points", &["hex8_mean_dilatation"]),
    ("src/elements/tet10.rs", "its WGSL is that of several points", &["hex8_mean_dilatation"]),
    ("crates/mesh/src/topology/tet10.rs", "made of the cell with its corners alone", &["tet4"]),
    ("crates/mesh/src/measure.rs", "the volume of a tetrahedron", &["tet4"]),
    ("crates/mesh/src/cells.rs", "an iterator over nothing has to have a kind", &["Tet4"]),
    ("crates/cli/src/bench.rs", "what pulls at cubes: the word of a benchmark's load", &["Gravity"]),
    ("crates/cli/src/arguments/suites.rs", "what is measured where nothing is said", &["tet4", "hex8"]),
];

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn text(file: &str) -> String {
    std::fs::read_to_string(root().join(file)).unwrap()
}

/// Files below the engine's folders, by their paths, with their code: no comments, no tests.
fn engine() -> Vec<(String, String)> {
    let folders = ["src", "systems", "crates/mesh/src", "crates/tools/src", "crates/cli/src"];
    let mut waiting: Vec<PathBuf> = folders.iter().map(|folder| root().join(folder)).collect();
    let mut found = Vec::new();
    while let Some(path) = waiting.pop() {
        let name = path.strip_prefix(root()).unwrap().display().to_string();
        if path.is_dir() {
            waiting.extend(std::fs::read_dir(&path).unwrap().map(|entry| entry.unwrap().path()));
        } else if !name.ends_with("tests.rs") && !name.contains("/tests/") {
            found.push((name, code(&std::fs::read_to_string(&path).unwrap())));
        }
    }
    found
}

/// Whether code has a word, or a path, as a whole.
fn has(code: &str, name: &str) -> bool {
    let is_letter = |c: char| c.is_alphanumeric() || c == '_';
    code.match_indices(name)
        .any(|(at, _)| !code[..at].ends_with(is_letter) && !code[at + name.len()..].starts_with(is_letter))
}

/// Files that name a thing and are neither its own nor about it.
fn beside(names: &[&str], own: &[&str]) -> BTreeSet<String> {
    let is_about =
        |file: &str, name: &str| ABOUT.iter().any(|(about, _, names)| *about == file && names.contains(&name));
    let mut found = BTreeSet::new();
    for (file, code) in engine() {
        for name in names.iter().filter(|name| has(&code, name)) {
            if !own.contains(&file.as_str()) && !is_about(&file, name) {
                found.insert(format!("{file} names {name}"));
            }
        }
    }
    found
}

/// Where a name stands once more in the file of a list or of the `mod`, and why.
const MORE: &[(&str, &str, &str)] = &[
    ("src/materials/mod.rs", "ogden", "its terms are public"),
    ("src/materials/mod.rs", "corotational", "how it turns is public"),
    ("src/elements/mod.rs", "hex8", "its shapes are types of their own"),
];

/// What is wrong with how often a name stands in a file: `times` are right. Texts in quotes, which name shaders, and
/// kinds of cells, which elements are made `of`, are not meant.
fn wrong_count(file: &str, name: &str, times: usize) -> Option<String> {
    let code = code(&text(file));
    let is_meant = |at: &usize| !code[..*at].ends_with('"') && !code[..*at].ends_with(" of ");
    let is_letter = |c: char| c.is_alphanumeric() || c == '_';
    let is_whole = |at: &usize| !code[..*at].ends_with(is_letter) && !code[at + name.len()..].starts_with(is_letter);
    let found = code.match_indices(name).map(|(at, _)| at).filter(is_whole).filter(is_meant).count();
    let right = times + MORE.iter().filter(|(of, more, _)| *of == file && *more == name).count();
    (found != right).then(|| format!("{file} has {name} {found} times, not {right}"))
}

/// Entries `word: Type` of a list, from a line to a line.
fn list(file: &str, from: &str, to: &str) -> Vec<(String, String)> {
    let text = text(file);
    let lines = text.lines().skip_while(|line| !line.contains(from)).skip(1).take_while(|line| !line.contains(to));
    let entries = lines.filter_map(|line| line.trim().strip_suffix(';')?.split_once(": "));
    let entries: Vec<_> = entries.map(|(word, of)| (word.to_owned(), of.to_owned())).collect();
    assert!(entries.len() > 3, "no list in {file}");
    entries
}

#[test]
fn a_law_is_a_rust_file_a_wgsl_file_and_a_line() {
    let (modules, laws) = ("src/materials/mod.rs", "src/materials/elastic.rs");
    let mut wrong = BTreeSet::new();
    for (word, law) in list(laws, "$then! {", "$($more)*") {
        assert!(root().join(format!("shaders/{word}.wgsl")).exists(), "shaders/{word}.wgsl");
        let file = format!("src/materials/{word}.rs");
        // `linear` and `ogden` are words of their own, too; the others are nothing but names of laws
        let names: Vec<&str> = [law.as_str()].into_iter().chain(word.contains('_').then_some(word.as_str())).collect();
        wrong.extend(beside(&names, &[&file, laws, modules]));
        wrong.extend([wrong_count(modules, &word, 1), wrong_count(modules, &law, 0)].into_iter().flatten());
        wrong.extend([wrong_count(laws, &word, 1), wrong_count(laws, &law, 1)].into_iter().flatten());
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn an_element_is_a_rust_file_a_wgsl_file_and_a_line() {
    let (modules, kinds) = ("src/elements/mod.rs", "crates/mesh/src/generators/mod.rs");
    let mut wrong = BTreeSet::new();
    for (stem, rest) in list(kinds, "$then! {", "macro_rules! element_kinds") {
        let words: Vec<&str> = rest.split([',', '"', ' ']).filter(|word| !word.is_empty()).collect();
        let [kind, "of", cell, shader] = words[..] else { panic!("{stem}: {rest}") };
        assert!(root().join(format!("shaders/{shader}.wgsl")).exists(), "shaders/{shader}.wgsl");
        let file = format!("src/elements/{stem}.rs");
        // what a kind of cell is stands in files of its own
        let topology = format!("crates/mesh/src/topology/{}.rs", cell.to_lowercase());
        wrong.extend(beside(&[kind, &stem], &[&file, &topology, modules, kinds, "crates/mesh/src/topology/mod.rs"]));
        wrong.extend([wrong_count(modules, &stem, 1), wrong_count(modules, kind, 0)].into_iter().flatten());
        wrong.extend([wrong_count(kinds, &stem, 1), wrong_count(kinds, kind, 1)].into_iter().flatten());
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn a_load_is_a_rust_file_a_wgsl_file_and_a_line() {
    let (modules, loads) = ("systems/mod.rs", "src/scene/schema/load.rs");
    let mut wrong = BTreeSet::new();
    assert!(LOADS.len() > 3, "{LOADS:?}");
    for (stem, word, _) in LOADS {
        assert!(root().join(format!("shaders/{stem}.wgsl")).exists(), "shaders/{stem}.wgsl");
        // a field of output and a picture are called Pressure, too
        let in_scenes = format!("Load::{word}");
        let name = if *word == "Pressure" { in_scenes.as_str() } else { word };
        wrong.extend(beside(&[name], &[&format!("systems/{stem}.rs"), modules, loads]));
        wrong.extend([wrong_count(modules, stem, 1), wrong_count(modules, word, 0)].into_iter().flatten());
        wrong.extend(wrong_count(loads, word, 1));
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn a_name_that_stands_once_more_is_found() {
    assert_eq!(wrong_count("systems/mod.rs", "gravity", 1), None);
    assert!(wrong_count("systems/mod.rs", "node_pass", 1).is_some());
    assert!(wrong_count("systems/mod.rs", "no_such_thing", 1).is_some());
}

/// A reason for what no file does any more hides the next one that does.
#[test]
fn what_files_are_about_stands_in_them() {
    let engine = engine();
    for (file, why, names) in ABOUT {
        let (_, code) = engine.iter().find(|(name, _)| name == file).unwrap_or_else(|| panic!("{file}: {why}"));
        for name in *names {
            assert!(has(code, name), "{file} does not name {name} ({why})");
        }
    }
    for (file, name, why) in MORE {
        assert!(wrong_count(file, name, 0).is_some(), "{file} does not name {name} once more ({why})");
    }
}
