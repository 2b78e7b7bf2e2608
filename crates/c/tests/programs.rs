//! Programs in C and C++ that use the library: compiled with all warnings as errors, run, and run under valgrind where
//! there is one. `tests/run` installs what is needed.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use sinew::{BackendChoice, Options, SceneFile, Simulation};
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn here(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

/// Where the libraries are that cargo has built with this test.
fn libraries() -> PathBuf {
    std::env::current_exe().unwrap().parent().unwrap().to_path_buf()
}

fn run(command: &mut Command) -> Output {
    // cargo's leads to libraries of earlier builds
    let output = command.env_remove("LD_LIBRARY_PATH").output().unwrap_or_else(|error| panic!("{command:?}: {error}"));
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{command:?}: {}\n{said}", output.status);
    output
}

const C: [&str; 2] = ["cc", "-std=c99"];
const CPP: [&str; 4] = ["c++", "-std=c++11", "-x", "c++"];

/// Compiles a program against the header and the shared library.
fn compile(source: &Path, compiler: &[&str], folder: &Path) -> PathBuf {
    let program = folder.join(format!("{}_{}", source.file_stem().unwrap().display(), compiler[0].len()));
    let mut command = Command::new(compiler[0]);
    command.args(&compiler[1..]).args(["-g", "-Wall", "-Wextra", "-pedantic", "-Werror"]);
    command.arg("-I").arg(here("include")).arg("-I").arg(here("tests/programs")).arg(source);
    // what stands behind it is of no language
    command.args(["-x", "none", "-o"]).arg(&program).arg("-L").arg(libraries()).args(["-lsinew_c", "-lm"]);
    run(command.arg(format!("-Wl,-rpath,{}", libraries().display())));
    program
}

/// Runs a program of this folder in both languages, and what it prints.
fn in_both_languages(name: &str) -> String {
    let folder = tempfile::tempdir().unwrap();
    let source = here("tests/programs").join(name);
    let printed = [&C[..], &CPP[..]].map(|compiler| {
        let program = compile(&source, compiler, folder.path());
        String::from_utf8(run(Command::new(program).current_dir(folder.path())).stdout).unwrap()
    });
    assert_eq!(printed[0], printed[1], "{name} in C and in C++");
    printed[0].clone()
}

#[test]
fn what_is_wrong_is_a_status_and_a_text() {
    in_both_languages("wrong.c");
}

#[test]
fn hands_tools_files_in_memory_and_removal() {
    in_both_languages("hand.c");
}

#[test]
fn the_bits_are_those_of_the_same_calls_in_rust() {
    let printed = in_both_languages("steps.c");
    let check = std::fs::read_to_string(here("tests/programs/check.h")).unwrap();
    let words = check.split("BAR =").nth(1).unwrap().split(';').next().unwrap();
    let lines = words.lines().filter_map(|line| line.trim().strip_prefix('"')?.strip_suffix('"'));
    let text: String = lines.collect::<String>().replace("\\\"", "\"");
    let scene = SceneFile::from_text("scene", &text, Path::new(""), &[]).unwrap_or_else(|wrong| panic!("{wrong}"));
    let options = Options { backend: BackendChoice::Cpu, threads: 1, grabs: true, ..Options::default() };
    let mut simulation = Simulation::new(&scene, &options).unwrap();
    simulation.set_input("weight", 1.5).unwrap();
    simulation.advance_to(0.05).unwrap();
    simulation.advance(40).unwrap();
    let (rest, moved) = (simulation.rest_positions("bar").unwrap(), simulation.displacements("bar").unwrap());
    assert!(moved.iter().any(|u| u.length() > 1e-3), "nothing has moved");
    let places = rest.iter().zip(&moved).flat_map(|(x, u)| (*x + *u).as_vec3().to_array());
    let bits: Vec<String> = places.map(|number| format!("{:08x}", number.to_bits())).collect();
    let of_c: Vec<&str> = printed.lines().collect();
    assert_eq!(of_c, bits);
}

/// Threads and vector registers beyond AVX2 are left out there: valgrind knows neither well.
#[test]
fn valgrind_finds_nothing() {
    if Command::new("valgrind").arg("--version").output().is_err() {
        assert!(std::env::var_os("SINEW_REQUIRE_VALGRIND").is_none(), "valgrind is not there");
        println!("left out: valgrind is not there");
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    for name in ["wrong.c", "hand.c", "steps.c"] {
        let program = compile(&here("tests/programs").join(name), &C, folder.path());
        let mut valgrind = Command::new("valgrind");
        valgrind.args(["--quiet", "--error-exitcode=9", "--leak-check=full", "--errors-for-leak-kinds=definite"]);
        run(valgrind.arg(program).current_dir(folder.path()));
    }
}

/// The first block of C in the page is a program that does what the page says.
#[test]
fn the_example_of_the_page_runs() {
    let page = std::fs::read_to_string(here("../../docs/c.md")).unwrap();
    let example = page.split("```c\n").nth(1).unwrap().split("```").next().unwrap();
    let folder = tempfile::tempdir().unwrap();
    let source = folder.path().join("jelly.c");
    std::fs::write(&source, example).unwrap();
    for compiler in [&C[..], &CPP[..]] {
        let printed = run(&mut Command::new(compile(&source, compiler, folder.path()))).stdout;
        let printed = String::from_utf8(printed).unwrap();
        let shown = page.split("```text\n").nth(1).unwrap().split("```").next().unwrap();
        assert_eq!(printed, shown, "what the page says it prints");
    }
}
