//! What is too much is refused by name, before anything is made of it.

use crate::good::{GOOD, brief, complaints, with};
use sinew::scene::{Allowed, SceneFile, limits};
use sinew::systems::Registry;
use sinew::{BackendChoice, Error, Options, Simulation};
use std::path::Path;

/// The first complaint about the good scene with a piece replaced: message, then notes.
fn first(old: &str, new: &str) -> String {
    let told = complaints(&with(old, new), &[]);
    let list = told.list();
    let first = list.iter().find(|found| found.severity == sinew::scene::Severity::Error).expect("an error");
    first.notes.iter().fold(first.message.clone(), |text, note| format!("{text} | {note}"))
}

fn many(count: usize, entry: impl Fn(usize) -> String) -> String {
    (0..count).map(entry).collect()
}

#[test]
fn too_many_of_anything_are_refused_by_their_number() {
    let body = |i| format!("\"b{i}\": (mesh: Box(size: (1, 1, 1), cells: (1, 1, 1)), material: \"tissue\"),");
    assert_eq!(first("bodies: {", &format!("bodies: {{{}", many(1000, body))), "1001 bodies; at most 1000 are allowed");
    let material = |i| format!("\"m{i}\": (density: 1, neo_hookean: Moduli(shear: 1, bulk: 1)),");
    let told = first("materials: {", &format!("materials: {{{}", many(1000, material)));
    assert_eq!(told, "1001 materials; at most 1000 are allowed");
    let told = first("loads: [", &format!("loads: [{}", "Gravity(acceleration: (0, 0, 1)),".repeat(10_000)));
    assert_eq!(told, "10001 loads; at most 10000 are allowed");
    let told = first("constraints: [", &format!("constraints: [{}", "Fixed(on: All),".repeat(10_000)));
    assert_eq!(told, "10001 constraints; at most 10000 are allowed");
    let told = first("loads: [", &format!("removal: [{}], loads: [", "(when: At(1)),".repeat(10_001)));
    assert_eq!(told, "10001 removals; at most 10000 are allowed");
    let probe = |i| format!("\"p{i}\": (what: Position, on: All),");
    assert_eq!(
        first("probes: {", &format!("probes: {{{}", many(10_000, probe))),
        "10001 probes; at most 10000 are allowed"
    );
    let regions = format!("material: \"tissue\", regions: [{}]", "(on: All, material: \"tissue\"),".repeat(1001));
    assert_eq!(first("material: \"tissue\"", &regions), "1001 regions; at most 1000 are allowed");
    let terms = format!("density: 1060, prony: (terms: [{}])", "(alpha: 0, tau: 1),".repeat(101));
    assert_eq!(first("density: 1060", &terms), "101 terms; at most 100 are allowed");
}

/// A file name may have 255 bytes: so many letters of four bytes would not fit, though they are few.
#[test]
fn names_are_limited_in_bytes() {
    let told = |count: usize| format!("{count} bytes in a name; at most 100 are allowed");
    for (name, bytes) in [("x".repeat(101), 101), ("ü".repeat(51), 102), ("𝔏".repeat(64), 256)] {
        assert_eq!(first("\"tip\": (what", &format!("\"{name}\": (what")), told(bytes));
        let material = format!("materials: {{\"{name}\": (density: 1, neo_hookean: Moduli(shear: 1, bulk: 1)),");
        assert_eq!(first("materials: {", &material), told(bytes));
        let body =
            format!("bodies: {{\"{name}\": (mesh: Box(size: (1, 1, 1), cells: (1, 1, 1)), material: \"tissue\"),");
        assert_eq!(first("bodies: {", &body), told(bytes));
        let load = format!("loads: [Pressure(on: Set(\"{name}\"), pressure: 1),");
        assert_eq!(first("loads: [", &load), told(bytes));
    }
    assert_eq!(brief(&with("\"tip\": (what", &format!("\"{}\": (what", "ü".repeat(50))), &[]), "");
}

#[test]
fn a_table_of_a_million_points_is_refused_and_one_that_is_allowed_is_not() {
    let table = |count| format!("curve: Table([{}])", many(count, |i| format!("({i},1),")));
    let smooth = "curve: Smooth(end: 0.1)";
    assert_eq!(first(smooth, &table(100_001)), "100001 points in a table; at most 100000 are allowed");
    assert_eq!(brief(&with(smooth, &table(100_000)), &[]), "");
    // three values a point: the text is not even read to its end
    let told = first(smooth, &table(1_000_000));
    assert_eq!(told, "the scene has more than 2000000 values, the most that are allowed");
}

#[test]
fn long_texts_are_refused_unread() {
    let text = format!("{GOOD}{}", " ".repeat(limits::TEXT_BYTES));
    let told = complaints(&text, &[]).to_string();
    assert!(told.contains("more than 16777216 bytes"), "{told}");
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("long.ron");
    std::fs::write(&path, &text).unwrap();
    assert!(SceneFile::load(&path, &[]).unwrap_err().to_string().contains("more than 16777216 bytes"));
    let set = format!("title={}", "x".repeat(limits::SET_BYTES));
    let told = complaints(GOOD, &[&set]).to_string();
    assert!(told.contains("at most 65536 are allowed") && told.len() < 500, "{told}");
    let sets = vec!["duration=1"; limits::SETS + 1];
    assert!(complaints(GOOD, &sets).to_string().contains("--set is given 1001 times; at most 1000 are allowed"));
}

#[cfg(target_os = "linux")]
#[test]
fn a_scene_without_end_is_refused() {
    assert!(SceneFile::load("/dev/zero", &[]).unwrap_err().to_string().contains("more than 16777216 bytes"));
}

#[test]
fn what_is_told_of_long_lines_and_words_is_short() {
    let word = "x".repeat(100_000);
    let told = complaints(&with("Fixed(", &format!("{word}(")), &[]);
    assert!(told.has_errors() && told.to_string().len() < 10_000, "{} bytes", told.to_string().len());
    // all on one line, with more mistakes than are shown: of each of fifty a line of 120 columns and what is below it
    let line = GOOD.replace('\n', " ").replace("loads: [", &format!("loads: [{}", "Gravity(g: 1), ".repeat(5000)));
    let told = complaints(&line, &[]).to_string();
    assert!(told.contains("┌─ cube.ron:1:") && told.contains("unknown field `g`"), "{told}");
    assert!(told.len() < 50 * 1000, "{} bytes", told.len());
}

/// A line is shown around what is wrong in it, and its columns are those of the file.
#[test]
fn a_scene_on_one_line_is_shown_around_each_mistake() {
    let line = with("density", "densty").replace('\n', " ");
    let column = line.find("densty").unwrap() + 1;
    for (text, number) in [(line.clone(), 1), (format!("// all on one line\n{line}"), 2)] {
        let told = complaints(&text, &[]).to_string();
        assert!(told.contains(&format!("┌─ cube.ron:{number}:{column}\n")), "{column} is not in\n{told}");
        let lines: Vec<&str> = told.lines().collect();
        let shown = lines.iter().position(|line| line.contains("densty: ")).expect("the line");
        assert!(lines[shown].contains('…') && lines[shown].chars().count() < 140, "{told}");
        // the mark is below the word
        let at = |line: &str, what: &str| line[..line.find(what).expect(what)].chars().count();
        assert_eq!(at(lines[shown + 1], "^^^"), at(lines[shown], "densty"), "{told}");
    }
}

#[test]
fn mistakes_beyond_number_are_told_and_counted_in_bounds() {
    let told = complaints(&with("loads: [", &format!("loads: [{}", "x,".repeat(300_000))), &[]);
    assert!(told.has_errors() && told.list().len() <= 100_000);
    // what is no RON is given up earlier
    let told = complaints(&with("loads: [", &format!("loads: [{}", "a b ".repeat(300_000))), &[]);
    assert!(told.has_errors() && told.list().len() < 2000, "{}", told.list().len());
}

#[test]
fn elements_are_counted_before_they_are_made() {
    let cells = "cells: (4, 4, 4), elements: Hex8";
    let told = |new: &str| first(cells, new);
    let most = " | at most 100000000 elements are allowed in all bodies together";
    assert_eq!(
        told("cells: (10000, 10000, 10000), elements: Hex8"),
        format!("the mesh would have 1000000000000 elements: 1000000000000 cells{most}")
    );
    assert_eq!(told("cells: (400, 400, 400)"), format!("the mesh would have 384000000 elements: 64000000 cells{most}"));
    let refined = with(cells, cells).replace("material: \"tissue\",", "material: \"tissue\", refine: 9,");
    let told = brief(&refined, &[]);
    let expected = "the mesh would have 8589934592 elements: 64 cells, refined 9 times";
    assert!(told.contains(expected), "{told}");
    let copied = with(cells, cells).replace("material: \"tissue\",", "material: \"tissue\", copies: 100000,");
    let copied = copied.replace("cells: (4, 4, 4)", "cells: (40, 40, 40)");
    let told = brief(&copied, &[]);
    assert!(told.contains("would have 6400000000 elements: 64000 cells, 100000 copies"), "{told}");
    let none = with(cells, cells).replace("material: \"tissue\",", "material: \"tissue\", copies: 0,");
    assert!(brief(&none, &[]).contains("between 1 and 100000"), "{}", brief(&none, &[]));
    let gone =
        with(cells, cells).replace("material: \"tissue\",", "material: \"tissue\", copies: 3, apart: (1e308, 0, 0),");
    let told = brief(&gone, &[]);
    assert!(told.contains("the last copy would stand beyond all numbers"), "{told}");
    assert!(told.contains("`apart` is too large: 1e308"), "{told}");
}

fn allowing(text: &str, elements: u64) -> Result<Simulation, Error> {
    let allowed = Allowed { elements, ..Allowed::default() };
    let scene = SceneFile::from_text_allowing("a.ron", text, Path::new(""), &[], allowed)?;
    Simulation::new(&scene, &Options { backend: BackendChoice::Cpu, threads: 1, ..Options::default() })
}

#[test]
fn a_program_can_allow_fewer_elements() {
    assert!(allowing(GOOD, 64).is_ok());
    let told = allowing(GOOD, 63).err().unwrap().to_string();
    assert!(told.contains("at most 63 elements are allowed"), "{told}");
    // two bodies, each of which is allowed
    let body = "\"a\": (mesh: Box(size: (1, 1, 1), cells: (4, 4, 4), elements: Hex8), material: \"tissue\"),";
    let two = with("bodies: {", &format!("bodies: {{{body}")).replace("Fixed(", "Fixed(body: \"a\", ");
    let two = two.replace("(what:", "(body: \"a\", what:");
    let told = allowing(&two, 127).err().unwrap().to_string();
    assert!(told.contains("128 with the bodies before"), "{told}");
    assert!(allowing(&two, 128).is_ok());
}

#[test]
fn elements_of_files_are_counted_too() {
    let folder = tempfile::tempdir().unwrap();
    let one = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n$EndNodes\n$Elements\n1\n\
               1 4 2 1 1 1 2 3 4\n$EndElements\n";
    std::fs::write(folder.path().join("one.msh"), one).unwrap();
    let mesh = "mesh: Box(size: (0.1, 0.1, 0.1), cells: (4, 4, 4), elements: Hex8)";
    let text = with(mesh, "mesh: File(path: \"one.msh\"), refine: 2");
    let told = |elements| {
        let allowed = Allowed { elements, ..Allowed::default() };
        let scene = SceneFile::from_text_allowing("a.ron", &text, folder.path(), &[], allowed).unwrap();
        Simulation::check(&scene, &Registry::default()).to_string()
    };
    assert!(!told(64).contains("elements"), "{}", told(64));
    assert!(told(63).contains("number of elements is 64; at most 63 are allowed"), "{}", told(63));
}

#[test]
fn outputs_without_end_are_refused() {
    let told = |set: &str| {
        let scene = SceneFile::from_text("a.ron", GOOD, Path::new(""), &[set.to_string()]).unwrap();
        Simulation::check(&scene, &Registry::default()).to_string()
    };
    // 0.5 s are 800 steps: outputs in each of them are no trouble, however often they are asked for
    assert_eq!(told("output.fields_every=1e-9"), "");
    let small = "integration.step=1e-9";
    let many = |sets: &[&str]| {
        let sets: Vec<String> = sets.iter().map(|set| set.to_string()).collect();
        let scene = SceneFile::from_text("a.ron", GOOD, Path::new(""), &sets).unwrap();
        Simulation::check(&scene, &Registry::default()).to_string()
    };
    let told = many(&[small, "output.fields_every=1e-9"]);
    assert!(
        told.contains("a run would write 500000001 VTU files") && told.contains("at most 1000000 are allowed"),
        "{told}"
    );
    let told = many(&[small, "output.energies_every=1e-9", "probes.tip.every=1e-9"]);
    assert!(told.contains("500000001 rows of energies") && told.contains("500000001 rows of a probe"), "{told}");
    assert!(told.contains("at most 100000000 are allowed"), "{told}");
    assert_eq!(many(&[small, "output.energies_every=1e-8"]), "");
    let told = many(&["analysis=Static(max_steps: 1000000001)"]);
    assert!(told.contains("`max_steps` must be at most 1000000000, found 1000000001"), "{told}");
}

/// The table in the reference and the numbers in the code are the same.
#[test]
fn the_reference_lists_the_limits() {
    let reference = include_str!("../../docs/scene.md");
    let (_, table) = reference.split_once("## Limits").unwrap();
    let table = table.split("\n## ").next().unwrap().replace(' ', "");
    for (limit, what) in [
        (limits::TEXT_BYTES as u64, "bytes|text"),
        (limits::SET_BYTES as u64, &*format!("bytes,{}times|one`--set`", limits::SETS)),
        (limits::VALUES as u64, "|values"),
        (sinew::scene::syntax::DEEPEST as u64, "|brackets"),
        (limits::BODIES as u64, "|bodies;materials;regions"),
        (limits::ACTIONS as u64, "|constraints;loads;contacts;attachments;removals;probes;suctions"),
        (limits::TOOLS_OF_A_BODY as u64, "|toolsthatabody"),
        (u64::from(limits::MOST_BURST), "|elementsthatatool"),
        (limits::SYSTEMS as u64, "|systemsofyourown"),
        (limits::TABLE_POINTS as u64, "|pointsofatable"),
        (limits::TERMS as u64, "|termsofviscosity"),
        (limits::NAME_BYTES as u64, "bytes|thenameofabody"),
        (u64::from(limits::MOST_REFINEMENT), "|times"),
        (limits::ELEMENTS, "|elementsofallbodies"),
        (limits::LAW_BYTES, "bytes|alaw"),
        (limits::LAW_WORDS as u64, "|words"),
        (limits::LAW_DECLARATIONS as u64, "|declarations"),
        (limits::LAW_DEPTH as u64, "|operators"),
        (limits::PSEUDO_STEPS, "|pseudo-steps"),
        (limits::FRAMES, "|VTUfiles"),
        (limits::ROWS, "|rows"),
    ] {
        assert!(table.contains(&format!("|{limit}{what}")), "{limit}{what} is not in the reference");
    }
}
