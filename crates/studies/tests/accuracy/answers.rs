//! What a study answers: how far the scene as it is written is off, at most, and from which meshes that is told.

use crate::made_up::{MadeUp, Nobody};
use sinew::{Options, SceneFile};
use sinew_studies::accuracy::solver::Solver;
use sinew_studies::accuracy::study::Outcome;
use sinew_studies::accuracy::{Engine, Estimate, Factor, Settings, Study, study};
use std::fs;
use std::time::Instant;

fn run(solver: &mut MadeUp, budget: f64) -> Study {
    let judged_by = Some("tip.uz".to_string());
    let settings = Settings { started: Instant::now(), budget, target: 0.01, judged_by, reference: None };
    study(solver, &settings, &mut Nobody).unwrap()
}

fn meshes(estimate: &Estimate) -> Vec<String> {
    estimate.meshes.iter().map(ToString::to_string).collect()
}

#[test]
fn the_answer_has_the_differences_between_meshes_their_order_and_a_bound() {
    for order in [0.6, 1.0, 1.5, 2.0] {
        let study = run(&mut MadeUp { order, ..MadeUp::default() }, 1e9);
        let answer = &study.estimates[0];
        assert_eq!(
            (answer.quantity.as_str(), meshes(answer)),
            ("tip.uz", ["×1", "×2", "×4"].map(String::from).to_vec())
        );
        assert!((answer.order.unwrap() - order).abs() < 0.02, "{answer:?}");
        // 4 % of the exact value, 1e-4 of the step
        assert!(answer.at_most >= 0.0401 / 1.0401 && answer.about > 0.03 && answer.about < 0.05, "{answer:?}");
        let said = answer.sentence();
        for words in ["off by", "at most", "(meshes ×1, ×2, ×4 differ by", &format!("; order {order:.1})")] {
            assert!(said.contains(words), "{words:?} is not in {said}");
        }
    }
}

#[test]
fn where_time_allows_two_meshes_only_they_bound_the_error() {
    // a mesh takes 6.4 s times the fourth power of its fineness, it says: no time for ×2
    let study = run(&mut MadeUp { seconds: 1e-3, ..MadeUp::default() }, 50.0);
    let answer = &study.estimates[0];
    assert_eq!((meshes(answer), answer.order), (["×1/2", "×1"].map(String::from).to_vec(), None));
    assert!(answer.at_most >= 0.0401 / 1.0401 && answer.at_most < 0.4, "{answer:?}");
    assert!(answer.sentence().contains("two meshes show no order"), "{}", answer.sentence());
    assert!(study.more.clone().unwrap().contains("would add `mesh ×2`"), "{:?}", study.more);
}

#[test]
fn results_that_run_apart_are_told_as_such() {
    // as in a locked mesh, differences grow
    let study = run(&mut MadeUp { order: -0.5, space: -0.02, ..MadeUp::default() }, 1e9);
    let answer = &study.estimates[0];
    assert!(!answer.is_clear && answer.at_most > 0.15, "{answer:?}");
    assert!(answer.sentence().contains("they do not come closer yet"), "{}", answer.sentence());
}

#[test]
fn the_plan_fits_the_time_that_is_left_of_the_budget() {
    let judged_by = Some("tip.uz".to_string());
    // 9.95 s of the 10 s are gone before the study begins
    let Some(started) = Instant::now().checked_sub(std::time::Duration::from_millis(9950)) else { return };
    let settings = Settings { started, budget: 10.0, target: 0.01, judged_by, reference: None };
    let study = study(&mut MadeUp::default(), &settings, &mut Nobody).unwrap();
    assert!(study.predicted > 9.95 && study.predicted <= 10.0, "{}", study.predicted);
    let finer = study.rows.iter().find(|row| row.label == "mesh ×4").unwrap();
    assert!(matches!(finer.outcome, Outcome::LeftOut(_)), "{finer:?}");
}

fn scene(name: &str, text: &str) -> (tempfile::TempDir, SceneFile) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    fs::write(&path, text).unwrap();
    let file = SceneFile::load(&path, &[]).unwrap();
    (folder, file)
}

fn block(cells: &str, probe: &str) -> String {
    format!(
        r#"(duration: 0.01,
        bodies: {{"block": (mesh: Box(size: (0.1, 0.1, 0.1), cells: {cells}, elements: Hex8), material: "tissue")}},
        materials: {{"tissue": (density: 1000, neo_hookean: Young(young: 3000, poisson: 0.45))}},
        constraints: [Fixed(on: Set("z0"))],
        loads: [Gravity(acceleration: (0, 0, -9.81))],
        probes: {{"there": (what: Displacement, on: {probe})}})"#
    )
}

#[test]
fn no_mesh_lacks_the_nodes_that_the_scene_speaks_of() {
    let list = |cells: &str, probe: &str| {
        let (_keep, file) = scene("block.ron", &block(cells, probe));
        let choices = Engine::new(&file, Options::default(), false, false, || false).choices().unwrap();
        choices.meshes.iter().map(ToString::to_string).collect::<Vec<_>>()
    };
    let top = r#"Set("z1")"#;
    assert_eq!(list("(4, 4, 4)", top), ["×1/4", "×1/2", "×1", "×2", "×4", "×8"]);
    // a node at a quarter of the height is no node of two layers of cells
    let quarter = "Sphere(center: (0.05, 0.05, 0.025), radius: 1e-6)";
    assert_eq!(list("(4, 4, 4)", quarter), ["×1", "×2", "×4", "×8"]);
    // cells that cannot be halved, and no thirds or halves more of them
    assert_eq!(list("(6, 6, 6)", top), ["×1/2", "×1", "×2", "×4", "×8"]);
    assert_eq!(list("(3, 3, 3)", top), ["×1", "×2", "×4", "×8"]);
}

#[test]
fn a_single_layer_of_cells_is_told_from_meshes_with_more() {
    let (_keep, file) = scene("block.ron", &block("(8, 8, 2)", r#"Set("z1")"#));
    let choices = Engine::new(&file, Options::default(), false, false, || false).choices().unwrap();
    assert_eq!(choices.single_layers, [Factor::new(1, 2)]);
}

#[test]
fn a_mesh_from_a_file_says_that_its_surface_stays_flat() {
    let text = |mesh: &str| {
        format!(
            r#"(duration: 0.001, bodies: {{"organ": (mesh: {mesh}, material: "tissue")}},
            materials: {{"tissue": (density: 1000, neo_hookean: Young(young: 3000, poisson: 0.45))}},
            constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: 0, tolerance: 1e-3))])"#
        )
    };
    let unseen = |mesh: &str| {
        let (folder, _) = scene("first.ron", &text("Box(size: (1, 1, 1), cells: (1, 1, 1))"));
        let lens = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/meshes/lens_814.msh");
        fs::copy(lens, folder.path().join("lens.msh")).unwrap();
        let path = folder.path().join("organ.ron");
        fs::write(&path, text(mesh)).unwrap();
        let file = SceneFile::load(&path, &[]).unwrap();
        Engine::new(&file, Options::default(), false, false, || false).choices().unwrap().unseen
    };
    let said = unseen(r#"File(path: "lens.msh")"#);
    assert!(said.len() == 1 && said[0].contains("the flat faces of organ's mesh"), "{said:?}");
    // a generator makes finer meshes round
    assert!(unseen("Ellipsoid(radii: (0.01, 0.01, 0.01), across: 4)").is_empty());
}

/// Bringing bodies to rest takes more steps on a finer mesh, of more elements, and is done again wherever a run is.
#[test]
fn the_way_to_rest_before_the_first_step_is_a_part_of_what_is_predicted() {
    let text = block("(4, 4, 4)", r#"Set("z1")"#).replace("duration: 0.01,", "duration: 0.001, start: Equilibrium(),");
    let (_keep, file) = scene("block.ron", &text);
    let mut engine = Engine::new(&file, Options::default(), false, false, || false);
    let base = engine.choices().unwrap().base;
    let solution = engine.solve(&base).unwrap();
    assert!(solution.preload > solution.seconds, "{} s of {} s", solution.preload, solution.seconds);
    let mut finer = base.clone();
    finer.mesh = Factor::new(2, 1);
    let cost = engine.predict(&finer).unwrap();
    // eight times the elements, twice the steps: to find the step, and for each of three runs, which are as short as
    // that
    assert!(cost.seconds >= 4.0 * 16.0 * solution.preload, "{} s for {} s", cost.seconds, solution.preload);
    // what is at rest from the beginning has none of it
    let (_keep, file) = scene("block.ron", &text.replace("start: Equilibrium(),", ""));
    let mut engine = Engine::new(&file, Options::default(), false, false, || false);
    let base = engine.choices().unwrap().base;
    assert_eq!(engine.solve(&base).unwrap().preload, 0.0);
}
