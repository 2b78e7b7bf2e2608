//! Tables of an earlier run as a reference.

#[path = "../../../../tests/fuzz/mutate.rs"]
mod mutate;

use sinew_studies::accuracy::files::read;
use sinew_studies::accuracy::reference::ReferenceQuantity;
use std::fs;
use std::path::PathBuf;

fn folder(files: &[(&str, &str)]) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in files {
        fs::write(folder.path().join(name), text).unwrap();
    }
    let path = folder.path().to_path_buf();
    (folder, path)
}

const PROBE: &str = "time (s),ux (m),uy (m),uz (m)\n0,0,0,0\n0.5,1,0,-1\n1,3,0,-4\n";
const NODES: &str = "id,X,Y,Z,ux,uy,uz,fx,fy,fz,mass\n0,0,0,0,0,0,0,0,0,0,1\n7,1,0,0,0,0,0.5,0,0,0,1\n";

#[test]
fn probes_and_nodes_of_a_folder_are_a_reference() {
    let (_keep, path) =
        folder(&[("probe_tip.csv", PROBE), ("nodes.csv", NODES), ("energy.csv", "x\n"), ("note.txt", "")]);
    let reference = read(&[path], 1.0, 4).unwrap();
    let end = &reference.entries["tip.uz"];
    assert_eq!((end.values.as_slice(), end.scale), (&[-4.0][..], Some(5.0)), "measured against the length (3, 0, -4)");
    let course = &reference.entries["tip.uz.over_time"];
    assert_eq!(course.values, [0.0, -0.5, -1.0, -2.5, -4.0]);
    assert!(course.uncertainty > 0.0, "straight lines between rows are no knowledge");
    let points = &reference.points.unwrap().bodies[""];
    assert_eq!((points.len(), points[1].1.z), (2, 0.5));
}

#[test]
fn what_is_wrong_with_a_table_is_told_with_its_file() {
    for (name, text, words) in [
        ("probe_a.csv", "time (s),ux (m)\n0,0\n0.5,1\n", "ends at 0.5 s and the scene at 1 s"),
        ("probe_a.csv", "time (s),ux (m)\n0,0\n0,1\n1,1\n", "times must grow"),
        ("probe_a.csv", "time (s),ux (m)\n0,0\n1,NaN\n", "row 2 has something else than numbers"),
        ("probe_a.csv", "ux (m)\n0\n", "the first column must be `time (s)`"),
        ("probe_a.csv", "time (s),ux (m)\n", "no rows"),
        ("nodes.csv", "id,X,Y,Z\n0,0,0,0\n", "the column `ux` is missing"),
    ] {
        let (_keep, path) = folder(&[(name, text)]);
        let wrong = read(&[path.join(name)], 1.0, 4).unwrap_err();
        assert!(wrong.contains(words) && wrong.contains(name), "{wrong}");
    }
    let (_keep, path) = folder(&[("energy.csv", "")]);
    assert!(read(std::slice::from_ref(&path), 1.0, 4).unwrap_err().contains("holds no probe_NAME.csv"));
    assert!(read(&[path.join("energy.csv")], 1.0, 4).unwrap_err().contains("wanted are probe_NAME.csv"));
    assert!(read(&[path.join("probe_gone.csv")], 1.0, 4).unwrap_err().contains("probe_gone.csv"));
}

/// What hostile tables are made of.
const TABLES: [&str; 3] = [
    "time (s),ux (m),uy (m),uz (m)\n0,0,0,0\n0.5,0,0,-1e-3\n1,0,0,-2e-3\n",
    "time (s),Rx (N)\n0,0\n0.1,1\n0.2,2\n0.3,3\n0.4,4\n0.5,5\n1,6\n",
    "id,X,Y,Z,ux,uy,uz,fx,fy,fz,mass\n0,0,0,0,0,0,0,0,0,0,1\n1,1,0,0,0.1,0,0,0,0,0,1\n",
];

/// How many hostile tables; `SINEW_FUZZ` asks for more.
const HOSTILE: usize = 500;

#[test]
fn hostile_tables_are_read_or_refused() {
    let kept = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/accuracy/references");
    let kept = fs::read_dir(kept).unwrap().map(|entry| fs::read(entry.unwrap().path()).unwrap());
    let corpus: Vec<Vec<u8>> = TABLES.map(|table| table.as_bytes().to_vec()).into_iter().chain(kept).collect();
    let asked = std::env::var("SINEW_FUZZ").ok().and_then(|text| text.parse().ok()).unwrap_or(HOSTILE);
    let (mut read_whole, mut refused) = (0, 0);
    for seed in 0..asked {
        let bytes = mutate::mutant(&mut fastrand::Rng::with_seed(seed as u64), &corpus);
        let (_keep, path) = folder(&[]);
        for (name, samples) in [("probe_tip.csv", 0), ("probe_tip.csv", 10), ("nodes.csv", 0)] {
            let file = path.join(name);
            fs::write(&file, &bytes).unwrap();
            match read(&[file], 1.0, samples) {
                Err(error) => {
                    assert!(error.len() > 10, "seed {seed}: refused without a word");
                    refused += 1;
                }
                Ok(found) => {
                    let finite = |entry: &ReferenceQuantity| entry.values.iter().all(|value| value.is_finite());
                    assert!(found.entries.values().all(finite), "seed {seed}: a reference that is no number");
                    read_whole += 1;
                }
            }
        }
    }
    assert!(read_whole > 0 && refused > 0, "{read_whole} read, {refused} refused: mutants do not try anything");
}
