//! The shape of the code: imports run one way, wgpu lives in one place, files stay small, a system is where its name
//! says.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod source;

use source::code;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// All files of an ending below some folders, by path from the root, with their texts.
fn files(folders: &[&str], ending: &str) -> BTreeMap<String, String> {
    let mut found = BTreeMap::new();
    let mut waiting: Vec<PathBuf> = folders.iter().map(|folder| root().join(folder)).collect();
    while let Some(path) = waiting.pop() {
        if path.is_dir() {
            waiting.extend(std::fs::read_dir(&path).unwrap().map(|entry| entry.unwrap().path()));
        } else if path.extension().is_some_and(|e| e == ending) {
            let name = path.strip_prefix(root()).unwrap().display().to_string();
            found.insert(name, std::fs::read_to_string(&path).unwrap());
        }
    }
    assert!(!found.is_empty(), "nothing in {folders:?}");
    found
}

/// Modules of the crate that code names: `crate::x`, and the first words of `crate::{x, y::z}`.
fn imports(code: &str) -> Vec<String> {
    let word = |text: &str| text.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect::<String>();
    let mut names = Vec::new();
    for part in code.split("crate::").skip(1) {
        let Some(list) = part.strip_prefix('{') else {
            names.push(word(part));
            continue;
        };
        let (mut depth, mut start) = (0, true);
        for (at, c) in list.char_indices() {
            if start && !c.is_whitespace() {
                names.push(word(&list[at..]));
                start = false;
            }
            match c {
                '{' => depth += 1,
                '}' if depth == 0 => break,
                '}' => depth -= 1,
                ',' if depth == 0 => start = true,
                _ => {}
            }
        }
    }
    names
}

/// The parts in the order of the table in ARCHITECTURE.md: each may name those before it, and no other.
fn parts() -> Vec<String> {
    let text = std::fs::read_to_string(root().join("ARCHITECTURE.md")).unwrap();
    let rows = text.lines().skip_while(|line| !line.starts_with("| folder |")).skip(2);
    let folders = rows.take_while(|line| line.starts_with('|')).filter_map(|line| line.split('|').nth(1));
    folders.flat_map(|cell| cell.split('`').skip(1).step_by(2)).map(str::to_owned).collect()
}

/// The name by which others import a part.
fn module(part: &str) -> &str {
    part.rsplit('/').next().unwrap()
}

/// What the crate gives out under its own name, with the part that it is of: `crate::Simulation` is `simulation`'s.
fn given_out() -> BTreeMap<String, String> {
    let root = code(&std::fs::read_to_string(root().join("src/lib.rs")).unwrap());
    let mut found = BTreeMap::new();
    for path in root.split("pub use ").skip(1).filter_map(|rest| rest.split(';').next()) {
        // what the prelude has again is in the list already
        let Some((part, names)) = path.split_once("::").filter(|(part, _)| *part != "crate") else { continue };
        let names = names.split(|c: char| !c.is_alphanumeric() && c != '_').filter(|name| !name.is_empty());
        found.extend(names.map(|name| (name.to_owned(), part.to_owned())));
    }
    assert!(found.get("Simulation").is_some_and(|part| part == "simulation"), "{found:?}");
    found
}

/// Modules and crates of the repository that code names.
fn named(code: &str) -> Vec<String> {
    let parts = parts();
    let crates = parts.iter().filter(|part| part.starts_with("crates/")).map(|part| module(part));
    let crates = crates.filter(|name| code.contains(&format!("sinew_{name}::")));
    let given_out = given_out();
    let modules = imports(code).into_iter().map(|name| given_out.get(&name).cloned().unwrap_or(name));
    modules.chain(crates.map(String::from)).collect()
}

/// What a part names that stands behind it.
fn named_too_early(parts: &[String], part: &str, code: &str) -> Vec<String> {
    let place = parts.iter().position(|other| other == part).unwrap();
    let later = |name: &String| parts[place + 1..].iter().any(|other| module(other) == name);
    named(code).into_iter().filter(later).collect()
}

#[test]
fn imports_run_one_way() {
    let parts = parts();
    let folders = |of: &'static str| {
        let entries = std::fs::read_dir(root().join(of)).unwrap().map(|entry| entry.unwrap().path());
        entries.filter(|path| path.is_dir()).map(move |path| format!("{of}/{}", path.file_name().unwrap().display()))
    };
    let mut all: Vec<String> = folders("src").chain(folders("crates")).chain(["systems".to_owned()]).collect();
    let mut told = parts.clone();
    all.sort();
    told.sort();
    assert_eq!(told, all, "the folders of the table in ARCHITECTURE.md and those there are");
    let mut wrong = Vec::new();
    for part in &parts {
        for (file, text) in files(&[part], "rs") {
            // what has a crate of its own has modules of its own
            if part.starts_with("crates/") && !file.starts_with(&format!("{part}/src")) {
                continue;
            }
            let early = named_too_early(&parts, part, &code(&text));
            wrong.extend(early.iter().map(|name| format!("{file} names {name}, which comes after {part}")));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn an_import_that_runs_the_other_way_is_found() {
    let parts = parts();
    let backend = "use crate::{math::Real, evaluation::{BlockView, ElementState}};";
    assert_eq!(named_too_early(&parts, "src/backend", backend), ["evaluation"]);
    assert_eq!(named_too_early(&parts, "src/evaluation", backend), [""; 0]);
    let through_the_root = "use crate::{Simulation, math::Real, SceneFile};";
    assert_eq!(named_too_early(&parts, "src/backend", through_the_root), ["simulation"]);
    let pictures = "use sinew::mesh::Mesh;\nuse sinew_studies::hard::CASES;";
    assert_eq!(named_too_early(&parts, "crates/pictures", pictures), ["studies"]);
    let below = "pub use sinew_tools::Shape;";
    assert_eq!(named_too_early(&parts, "src/math", below), ["tools"]);
}

/// Comments of code and scenes, and prose of pages that is no table, no code and no lone link.
#[test]
fn prose_is_wrapped_at_120() {
    let mut wrong = Vec::new();
    for ending in ["rs", "wgsl", "ron", "md"] {
        let folders: &[&str] = match ending {
            "md" => &["docs", "benches", "ARCHITECTURE.md", "CHANGELOG.md", "README.md"],
            _ => &["src", "systems", "shaders", "scenes", "tests", "crates", "benches", "examples"],
        };
        for (file, text) in files(folders, ending) {
            let mut is_code = false;
            for (number, line) in text.lines().enumerate() {
                let line_start = line.trim_start();
                let text = line_start.trim_start_matches(['/', '!', ' ']);
                is_code ^= text.starts_with("```");
                let is_prose = match ending {
                    "md" => !line_start.starts_with(['|', '#', '!', '<', '[']),
                    _ => line_start.starts_with("//") && !text.starts_with('|'),
                };
                if is_prose && !is_code && line.chars().count() > 120 && line_start.contains(' ') {
                    wrong.push(format!("{file}:{}", number + 1));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "over 120 columns: {}", wrong.join(", "));
}

#[test]
fn wgpu_is_known_in_one_place() {
    for (file, text) in files(&["src", "systems", "crates"], "rs") {
        let known = code(&text).contains("wgpu");
        // the viewer's window and its pictures are drawn with it, too
        let may = ["src/backend/gpu/", "crates/view/"].iter().any(|place| file.starts_with(place));
        assert!(!known || may, "{file} knows wgpu");
    }
}

/// Longer files, and why.
const LONG: &[(&str, &str)] = &[];

#[test]
fn files_are_at_most_400_lines() {
    let mut long = Vec::new();
    for ending in ["rs", "wgsl"] {
        for (file, text) in files(&["src", "systems", "shaders", "tests", "benches", "examples", "crates"], ending) {
            let lines = text.lines().count();
            if lines > 400 {
                long.push((file, lines));
            }
        }
    }
    for (file, lines) in &long {
        assert!(LONG.iter().any(|(name, _)| name == file), "{file} has {lines} lines");
    }
    for (name, _) in LONG {
        assert!(long.iter().any(|(file, _)| file == name), "{name} is short or gone by now: take it off the list");
    }
}

/// Paths in backticks that begin with a folder of the repository.
#[test]
fn what_is_said_of_the_architecture_is_there() {
    let text = std::fs::read_to_string(root().join("ARCHITECTURE.md")).unwrap();
    let top: Vec<String> = std::fs::read_dir(root())
        .unwrap()
        .map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned())
        .collect();
    let is_path = |words: &&str| {
        let first = words.split('/').next().unwrap_or_default();
        words.contains('/') && !words.contains(' ') && top.iter().any(|name| name == first)
    };
    let paths: Vec<&str> = text.split('`').skip(1).step_by(2).filter(is_path).collect();
    let missing: Vec<&&str> = paths.iter().filter(|path| !root().join(path).exists()).collect();
    assert!(paths.len() > 30 && missing.is_empty(), "{} paths, not there: {missing:?}", paths.len());
    let linked = text.split("](").skip(1).filter_map(|rest| rest.split([')', '#']).next());
    let broken: Vec<&str> = linked.filter(|link| !root().join(link).exists()).collect();
    assert!(broken.is_empty(), "links to nowhere: {broken:?}");
}

#[test]
fn every_system_is_a_file_of_its_name_and_a_line_of_the_step() {
    let registry = sinew::systems::Registry::default();
    let names: Vec<String> = registry.systems().iter().map(|system| system.name.clone()).collect();
    let step = std::fs::read_to_string(root().join("systems/mod.rs")).unwrap();
    let listed: Vec<&str> = step
        .lines()
        .filter_map(|line| line.strip_prefix("//! "))
        .skip_while(|line| !line.starts_with("```"))
        .skip(1)
        .take_while(|line| !line.starts_with("```"))
        .filter(|line| !line.starts_with(' '))
        .filter_map(|line| line.split_whitespace().next())
        .collect();
    // loads are listed where scenes have their words
    let loads: Vec<&str> = sinew::scene::schema::LOADS.iter().map(|(file, ..)| *file).collect();
    let place = listed.iter().position(|name| *name == "(loads)").unwrap();
    let whole = [&listed[..place], &loads, &listed[place + 1..]].concat();
    assert_eq!(whole, names, "the step's list at the top of systems/mod.rs, with that of src/scene/schema/load.rs");
    let stems: Vec<String> = files(&["systems"], "rs")
        .into_keys()
        .map(|file| file.trim_start_matches("systems/").trim_end_matches(".rs").to_string())
        .filter(|stem| {
            ![
                "mod",
                "host_forces",
                "node_pass",
                "node_shares",
                "node_slices",
                "node_slopes",
                "node_stages",
                "node_system",
                "node_views",
                "own_load",
                "patch_pass",
                "registry",
                "repeat",
                "rows",
                "runs_on",
                "stage",
                "system",
            ]
            .contains(&stem.as_str())
                && !stem.contains('/')
        })
        .collect();
    for stem in &stems {
        assert!(names.contains(stem), "systems/{stem}.rs is no system of the step");
    }
    for name in &names {
        assert!(stems.contains(name), "the system {name} has no file systems/{name}.rs");
        let on_a_gpu = registry.get(name).is_some_and(|system| system.device.is_some());
        let shader = root().join(format!("shaders/{name}.wgsl"));
        assert_eq!(on_a_gpu, shader.exists(), "whether the system {name} has kernels, and a file shaders/{name}.wgsl");
    }
}

/// Columns are declared in several files, each with what it is about: none is forgotten where all are listed, and the
/// simulation keeps no lists of its own of them.
#[test]
fn columns_are_listed_where_they_are_declared_alone() {
    let name = |line: &str| {
        let (_, rest) = line.strip_prefix("    ")?.split_once(") = \"")?;
        rest.contains("\", ").then(|| rest.split('"').next().unwrap().to_owned())
    };
    let mut declared: Vec<String> =
        files(&["src/components"], "rs").values().flat_map(|text| text.lines().filter_map(name)).collect();
    let mut listed: Vec<String> =
        sinew::components::all_columns().iter().map(|column| column.name.to_owned()).collect();
    declared.sort();
    listed.sort();
    assert!(declared.len() > 40);
    assert_eq!(declared, listed);
    // what stands in the brackets of a constant
    let is_list = |text: &str| {
        let constants = text.split("const ").skip(1).filter_map(|rest| rest.split_once("= ["));
        let mut lists =
            constants.filter(|(before, _)| !before.contains('{')).filter_map(|(_, list)| list.split(']').next());
        lists.any(|list| list.contains("::NAME"))
    };
    assert!(
        is_list("const READ: [&str; 2] = [A::NAME, B::NAME];")
            && !is_list("const N: u8 = 1;\nfn f() {\n    let a = [A::NAME];")
    );
    let kept: Vec<String> =
        files(&["src/simulation"], "rs").into_iter().filter(|(_, text)| is_list(text)).map(|(file, _)| file).collect();
    assert!(kept.is_empty(), "lists of columns: {kept:?}");
}

/// Each crate below sinew with its version and features, as a build of some packages has them.
fn features(edges: &str, packages: &[&str]) -> Vec<String> {
    features_or_reason(edges, packages).unwrap()
}

/// The same; what cargo says where it cannot tell.
fn features_or_reason(edges: &str, packages: &[&str]) -> Result<Vec<String>, String> {
    let tree = ["tree", "--offline", "--prefix", "none", "--no-dedupe", "--format", "{p} {f}", "--edges", edges];
    let packages = packages.iter().flat_map(|package| ["--package", package]);
    let mut cargo = std::process::Command::new(env!("CARGO"));
    let output = cargo.args(tree).args(packages).current_dir(root()).output().unwrap();
    if !output.status.success() {
        return Err(String::from_utf8_lossy(&output.stderr).into_owned());
    }
    let text = String::from_utf8(output.stdout).unwrap();
    let mut lines: Vec<String> =
        text.lines().map(|line| line.trim_end_matches(" (*)").trim_end().to_string()).collect();
    lines.sort();
    lines.dedup();
    Ok(lines)
}

/// Cargo compiles a crate once for each set of features: those of tests and examples must be those of a build for use.
#[test]
fn tests_and_examples_use_the_crates_of_a_build() {
    let (build, tests) = (features("normal,build", &[]), features("normal,build,dev", &[]));
    assert!(build.len() > 100 && tests.len() > build.len(), "{build:?}");
    let others: Vec<&String> = build.iter().filter(|line| !tests.contains(line)).collect();
    assert!(others.is_empty(), "with other features for tests (pin those in Cargo.toml): {others:?}");
}

/// What embeds sinew, as its tests build it, and the crates below it that nothing else has.
const EMBEDDING: &[(&[&str], &[&str])] = &[
    (&["sinew-c", "sinew-cli"], &["sinew-c "]),
    (&["sinew-python"], &["sinew-python ", "inventory ", "pyo3", "target-lexicon "]),
];

/// What embeds sinew is built (`crates/c/tests/run`, `crates/python/tests/run`) of crates that are compiled already.
#[test]
fn what_embeds_sinew_uses_the_crates_of_a_build() {
    let tests = features("normal,build,dev", &[]);
    for (packages, of_its_own) in EMBEDDING {
        let built = match features_or_reason("normal,build,dev", packages) {
            Ok(built) => built,
            // who tests the engine need not have fetched what embeds it
            Err(said) if said.contains("--offline") => {
                eprintln!("left out: {packages:?}, whose crates are not there");
                continue;
            }
            Err(said) => panic!("{said}"),
        };
        let is_its_own = |line: &&String| of_its_own.iter().any(|name| line.starts_with(name));
        let others: Vec<&String> = built.iter().filter(|line| !tests.contains(line) && !is_its_own(line)).collect();
        assert!(built.len() > 100 && others.is_empty(), "{packages:?} has crates with other features: {others:?}");
    }
}

/// The crate as it is published holds what it is compiled from, and that is under a megabyte and a half:
/// nothing else has slipped in.
#[test]
fn the_package_is_small_and_whole() {
    let place = tempfile::tempdir().unwrap();
    let package = |more: &[&str]| {
        let arguments = ["package", "--package", "sinew", "--offline", "--allow-dirty", "--quiet"];
        let mut cargo = std::process::Command::new(env!("CARGO"));
        let output = cargo.args(arguments).args(more).current_dir(root()).output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8(output.stdout).unwrap()
    };
    // with the crates that it stands on, for a registry has those first
    let below = ["--package", "sinew-mesh", "--package", "sinew-tools"];
    // the lock file is the whole workspace's, with all its front ends: nobody needs it who depends on the crate
    let bare = ["--exclude-lockfile", "--no-verify", "--target-dir", place.path().to_str().unwrap()];
    package(&[&below[..], &bare].concat());
    let packed = place.path().join(format!("package/sinew-{}.crate", env!("CARGO_PKG_VERSION")));
    let bytes = std::fs::metadata(&packed).unwrap().len();
    assert!(bytes > 500_000 && bytes < 3 << 19, "{bytes} B");
    let list = package(&["--list"]);
    for ending in ["rs", "wgsl"] {
        let of_tests = |file: &&String| file.contains("/tests/") || file.ends_with("/tests.rs");
        for file in files(&["src", "systems", "shaders"], ending).keys().filter(|file| !of_tests(file)) {
            assert!(list.lines().any(|line| line == file), "{file} is not in the package");
        }
    }
}
