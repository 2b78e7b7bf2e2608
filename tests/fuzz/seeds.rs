//! Sound files that mutants are made of, and the kept ones that broke something once.

use crate::targets::{SMALL, small};
use crate::{samples, samples_vtk};
use std::path::{Path, PathBuf};

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// The files of a folder, in the order of their names.
fn files(folder: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let mut paths: Vec<PathBuf> =
        std::fs::read_dir(folder).into_iter().flatten().map(|entry| entry.unwrap().path()).collect();
    paths.retain(|path| path.is_file() && path.file_name().is_some_and(|name| name != "README.md"));
    paths.sort();
    paths.into_iter().map(|path| (path.clone(), std::fs::read(path).unwrap())).collect()
}

/// Seeds of a target: all, and those of the corpus alone.
pub fn of(target: &str) -> (Vec<Vec<u8>>, Vec<Vec<u8>>) {
    let folder = if target == "runs" { "scenes" } else { target };
    let kept: Vec<Vec<u8>> =
        files(&root().join("tests/fuzz/corpus").join(folder)).into_iter().map(|(_, bytes)| bytes).collect();
    let mut all = kept.clone();
    match target {
        "scenes" | "runs" => all.extend(scenes()),
        "sets" => all.extend(SETS.map(|set| set.as_bytes().to_vec())),
        "meshes" => {
            all.extend(samples::all().into_iter().map(|(_, bytes)| bytes));
            let text = samples_vtk::packings().into_iter().next().map(samples_vtk::vtu);
            all.extend(text);
        }
        "snapshots" => {
            let mut simulation = small();
            for _ in 0..2 {
                all.push(simulation.snapshot().unwrap().to_bytes().unwrap());
                simulation.advance(20).unwrap();
            }
        }
        "laws" => {
            let files = files(&root().join("examples"));
            all.extend(
                files.into_iter().filter(|(path, _)| path.extension().is_some_and(|e| e == "wgsl")).map(|(_, b)| b),
            );
        }
        name => panic!("no seeds for {name}"),
    }
    (all, kept)
}

/// All scenes of the repository, with fewer cells: what is tried a million times must be small.
fn scenes() -> Vec<Vec<u8>> {
    let folders = ["scenes", "scenes/accuracy", "scenes/hard", "examples"];
    let found = folders.iter().flat_map(|folder| files(&root().join(folder)));
    let ron = found.filter(|(path, _)| path.extension().is_some_and(|e| e == "ron"));
    let mut scenes: Vec<Vec<u8>> =
        ron.map(|(_, bytes)| smaller(&String::from_utf8(bytes).unwrap()).into_bytes()).collect();
    let reference = include_str!("../../docs/scene.md");
    scenes.extend(
        reference
            .split("```ron\n")
            .skip(1)
            .filter_map(|rest| rest.split("```").next())
            .map(|e| smaller(e).into_bytes()),
    );
    scenes.push(SMALL.as_bytes().to_vec());
    scenes
}

/// The scene with two cells where it has more.
fn smaller(text: &str) -> String {
    let mut out = String::new();
    let mut rest = text;
    let words = ["cells: (", "across: ", "along: ", "through: "];
    while let Some((at, word)) = words.iter().filter_map(|word| Some((rest.find(word)?, word))).min() {
        let values = at + word.len();
        let end = values + rest[values..].find(['\n', ')']).unwrap_or(0);
        out.push_str(&rest[..values]);
        let numbers = rest[values..end].split(',').map(|part| match part.trim().parse::<u32>() {
            Ok(many) => many.min(if *word == "cells: (" { 2 } else { 4 }).to_string(),
            Err(_) => part.to_string(),
        });
        out.push_str(&numbers.collect::<Vec<_>>().join(", "));
        rest = &rest[end..];
    }
    out + rest
}

const SETS: [&str; 8] = [
    "duration=2",
    "bodies.cube.mesh.cells=(3, 3, 3)\nloads[0].acceleration=(0, 0, -20)",
    "output.fields_every=0.01\noutput.energies_every=1e-3",
    "bodies.cube.material=tissue",
    "bodies.\"cube\".scale=0.001\nmaterials.tissue.density=1060",
    "loads[0].curve=Table([(0, 0), (0.1, 1), (0.3, 0.5)])",
    "probes.tip.on=And([Surface(), Not(Plane(normal: (0, 0, 1), at: 0, tolerance: 1e-4))])",
    "materials.\"tissue\".prony=(terms: [(alpha: 0.5, tau: 0.1)])\nanalysis=Static(tolerance: 1e-7, max_steps: 50)",
];
