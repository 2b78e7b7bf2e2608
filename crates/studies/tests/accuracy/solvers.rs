//! Ways to step in time beside each other.

use crate::made_up::{MadeUp, Nobody};
use sinew::components::Precision;
use sinew::scene::schema::ImplicitScheme;
use sinew::{Options, SceneFile};
use sinew_studies::accuracy::field::FieldReference;
use sinew_studies::accuracy::reference::ReferenceSource;
use sinew_studies::accuracy::solver::Solver;
use sinew_studies::accuracy::study::Outcome;
use sinew_studies::accuracy::{
    Configuration, Digits, Engine, Method, Reference, Row, Settings, Study, Varied, study, tables,
};
use std::collections::BTreeMap;
use std::time::Instant;

const EULER: ImplicitScheme = ImplicitScheme::Euler;
const ALPHA: ImplicitScheme = ImplicitScheme::GeneralizedAlpha { high_frequencies: 0.8 };

fn settings(reference: Option<Reference>, target: f64, judged_by: &str) -> Settings {
    Settings { started: Instant::now(), budget: 60.0, target, judged_by: Some(judged_by.into()), reference }
}

fn row<'a>(study: &'a Study, label: &str) -> &'a Row {
    let labels: Vec<&str> = study.rows.iter().map(|row| row.label.as_str()).collect();
    study.rows.iter().find(|row| row.label == label).unwrap_or_else(|| panic!("no row {label}: {labels:?}"))
}

fn made_up(implicit: f64) -> Study {
    let methods = vec![
        Method::HeavierMasses(4),
        Method::Implicit { scheme: EULER, step: 0.1, linearized: false },
        Method::Implicit { scheme: EULER, step: 0.1, linearized: true },
        Method::Implicit { scheme: ALPHA, step: 0.05, linearized: false },
    ];
    let exactly = Reference::of_values(&BTreeMap::from([("tip.uz".to_string(), -2e-3)]));
    let refuses = vec!["implicit Euler 100 ms, linearised"];
    let mut solver = MadeUp { methods, implicit, space: 1e-3, refuses, ..MadeUp::default() };
    study(&mut solver, &settings(Some(exactly), 0.01, "tip.uz"), &mut Nobody).unwrap()
}

#[test]
fn ways_to_step_are_rows_like_others() {
    let study = made_up(0.05);
    // 10 steps of 4 passes instead of 100; space errs .1 %, a tenth of a second .5 % and a twentieth squared .0125 %
    let euler = row(&study, "implicit Euler 100 ms");
    assert!((euler.errors["tip.uz"].error - 6.001e-3).abs() < 1e-9, "{euler:?}");
    assert!(
        (euler.measured().unwrap().seconds / row(&study, "as written").measured().unwrap().seconds - 0.4).abs() < 1e-9
    );
    let alpha = row(&study, "generalised-α 50 ms");
    assert!((alpha.errors["tip.uz"].error - 1.126e-3).abs() < 1e-9, "{alpha:?}");
    let heavier = row(&study, "masses ×4");
    assert_eq!((heavier.varied, heavier.measured().unwrap().steps), (Varied::Solver, 50));
    assert!(alpha.on_front && !euler.on_front, "half the cells are cheaper than Euler's steps, and better");
    let refused = row(&study, "implicit Euler 100 ms, linearised");
    assert_eq!(refused.outcome, Outcome::Refused("it makes no sense".into()));
    let csv = tables::csv(&study);
    for words in [",solver,", "Solver,Hex8,1,1,f32 compensated,implicit Euler 100 ms,", ",explicit,"] {
        assert!(csv.contains(words), "{words:?} is not in\n{csv}");
    }
}

#[test]
fn advice_says_whether_implicit_steps_pay() {
    let said = made_up(0.05).findings.advice;
    assert!(
        said.iter().any(|one| one.starts_with("Implicit steps pay: implicit Euler 100 ms takes 80 % of the time of")),
        "{said:?}"
    );
    let said = made_up(20.0).findings.advice;
    assert!(
        said.iter()
            .any(|one| one.starts_with("Implicit steps do not pay: the nearest, generalised-α 50 ms, errs 5.1 %")),
        "{said:?}"
    );
}

/// A stiff block of four cells an edge, pressed on its top.
fn block(duration: f64, curve: &str, more: &str) -> SceneFile {
    let text = format!(
        r#"(duration: {duration},
        bodies: {{"block": (mesh: Box(size: (5e-3, 5e-3, 5e-3), cells: (4, 4, 4), elements: Hex8), material: "tissue")}},
        materials: {{"tissue": (density: 1000, neo_hookean: Young(young: 1e5, poisson: 0.45))}},
        constraints: [Fixed(on: Set("z0"))],
        loads: [Traction(on: Surface(normal: (0, 0, 1)), traction: (0, 0, -5e3), curve: {curve})],
        {more})"#
    );
    SceneFile::from_text("block.ron", &text, "".as_ref(), &[]).unwrap()
}

/// The field of the same mesh stepped as finely as a study does.
fn finely_stepped(engine: &mut Engine<'_>) -> Reference {
    let base = engine.choices().unwrap().base;
    let fine = Configuration { digits: Digits::Double, step: 4, method: Method::Explicit, ..base };
    engine.predict(&fine).unwrap();
    let field = FieldReference::given(engine.solve(&fine).unwrap().field.unwrap(), 0.0);
    let (entries, points) = (BTreeMap::new(), None);
    Reference { source: ReferenceSource::Files, told: "the same mesh".into(), entries, field: Some(field), points }
}

fn studied(file: &SceneFile, target: f64) -> Study {
    let mut engine = Engine::new(file, Options { threads: 1, ..Options::default() }, false, false, || false).up_to(1.0);
    let reference = finely_stepped(&mut engine);
    study(&mut engine, &settings(Some(reference), target, "displacement.over_time"), &mut Nobody).unwrap()
}

fn error(row: &Row) -> f64 {
    row.errors.get("displacement.over_time").unwrap_or_else(|| panic!("{row:?}")).error
}

#[test]
fn slow_loads_are_for_implicit_steps() {
    let pressed = studied(&block(0.1, "Smooth(end: 0.1)", ""), 0.01);
    let (written, euler) = (row(&pressed, "as written"), row(&pressed, "implicit Euler 10 ms"));
    assert!(error(written) < 0.01 && error(euler) < 0.01, "{} {}", error(written), error(euler));
    let heavier = row(&pressed, "masses ×4");
    let [few, many] = [heavier, written].map(|row| row.measured().unwrap_or_else(|| panic!("{row:?}")).steps as f64);
    // half as many, but that a whole number of steps lies between two samples
    assert!(few < 0.6 * many && error(heavier) < 0.01, "{few} {many} {}", error(heavier));
    // of ten frames, each of whose errors is at most the tolerance
    let chosen = ["1e-2", "1e-3"].map(|tolerance| row(&pressed, &format!("generalised-α to {tolerance} in 10 ms")));
    let steps = chosen.map(|row| row.measured().unwrap_or_else(|| panic!("{row:?}")).steps);
    println!("{steps:?} steps, {:?} off", chosen.map(error));
    assert!(error(chosen[0]) < 10.0 * 1e-2 && error(chosen[1]) < 10.0 * 1e-3, "{:?}", chosen.map(error));
    assert!(steps[0] < steps[1], "{steps:?}");
    // both are good enough: which takes less is the machine's affair, and is said with the times of both
    let said = &pressed.findings.advice;
    let compares = |one: &String| one.starts_with("Implicit steps") && one.contains("of the time of");
    assert!(said.iter().any(compares), "{said:?}");
}

#[test]
fn ringing_is_not_for_implicit_steps() {
    let free = studied(&block(0.02, "Step()", ""), 0.1);
    let (written, euler) = (row(&free, "as written"), row(&free, "implicit Euler 2 ms"));
    assert!(error(written) < 0.1 && error(euler) > 0.1, "{} {}", error(written), error(euler));
    let said = &free.findings.advice;
    // those that are chosen by their errors are good enough, and none is cheaper
    assert!(said.iter().any(|one| one.starts_with("Implicit steps do not pay: ")), "{said:?}");
}

#[test]
fn a_scene_of_implicit_steps_has_explicit_ones_beside_them() {
    let file = block(0.1, "Smooth(end: 0.1)", "solver: Implicit(step: 0.01)");
    let mut engine = Engine::new(&file, Options::default(), false, false, || false).up_to(1.0);
    let choices = engine.choices().unwrap();
    let labels: Vec<String> = choices.methods.iter().map(ToString::to_string).collect();
    assert!(labels.contains(&"explicit".to_string()) && !labels.contains(&"implicit Euler 10 ms".into()), "{labels:?}");
    let half = engine.solve(&Configuration { step: 2, ..choices.base.clone() }).unwrap();
    assert_eq!((half.steps, half.time_step), (20, 0.005));
    let explicit = engine.solve(&Configuration { method: Method::Explicit, ..choices.base.clone() }).unwrap();
    let written = engine.solve(&choices.base).unwrap();
    assert!(explicit.steps > 100 * written.steps / 10, "{} {}", explicit.steps, written.steps);
    // reactions are those of the same moments
    let last =
        |solution: &sinew_studies::accuracy::Solution| *solution.channel("reaction.Rz").unwrap().values.last().unwrap();
    assert!((last(&written) / last(&explicit) - 1.0).abs() < 0.01, "{} {}", last(&written), last(&explicit));
    assert!((last(&written) / 0.125 - 1.0).abs() < 0.01, "{}", last(&written));
}

#[test]
fn what_implicit_steps_refuse_is_a_row_for_each_formula() {
    let more = r#"tools: {"plate": (shape: Plane())}, contacts: [Tool(tool: "plate")]"#;
    let file = block(0.1, "Smooth(end: 0.1)", more);
    let mut engine = Engine::new(&file, Options::default(), false, false, || false).up_to(1.0);
    let choices = engine.choices().unwrap();
    let implicit: Vec<Method> = choices.methods.iter().copied().filter(|method| method.is_implicit()).collect();
    assert_eq!(implicit.len(), 3, "{implicit:?}");
    let told = engine.predict(&Configuration { method: implicit[0], ..choices.base }).unwrap_err();
    assert!(format!("{told:?}").contains("the kinematic law corrects explicit steps"), "{told:?}");
}

/// The number of steps is known before; what they take is only as good as the machine is quiet.
#[test]
fn an_implicit_run_is_predicted_from_a_few_steps() {
    let file = block(0.5, "Smooth(end: 0.5)", "");
    let mut engine =
        Engine::new(&file, Options { threads: 1, ..Options::default() }, false, false, || false).up_to(1.0);
    let base = engine.choices().unwrap().base;
    let method = Method::Implicit { scheme: EULER, step: 0.005, linearized: false };
    let configuration = Configuration { method, ..base };
    let predicted = engine.predict(&configuration).unwrap();
    let solution = engine.solve(&configuration).unwrap();
    assert_eq!((predicted.steps, solution.steps), (100, 100));
    assert!(predicted.seconds > 0.0 && predicted.seconds.is_finite(), "{predicted:?}");
}

/// A bar that sags, and a block squeezed to four tenths: how many passes over all forces each search for rest takes,
/// counted by itself, and the one that a study goes by.
#[test]
fn rest_is_found_by_the_search_that_takes_fewer_passes() {
    let bar = "(duration: 1, analysis: Static(METHOD tolerance: 1e-8),
        bodies: {\"b\": (mesh: Box(size: (0.1, 0.03, 0.03), cells: (8, 2, 2), elements: Hex8MeanDilatation), material: \"m\")},
        materials: {\"m\": (density: 1000, neo_hookean: Young(young: 3e4, poisson: 0.45))},
        constraints: [Fixed(on: Set(\"x0\"))], loads: [Gravity(acceleration: (0, 0, -2))])";
    let squeezed = "(duration: 1, analysis: Static(METHOD tolerance: 1e-3),
        bodies: {\"b\": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (3, 3, 3), elements: Tet4), material: \"m\")},
        materials: {\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.49))},
        constraints: [Fixed(on: Set(\"z0\")), Prescribed(on: Set(\"z1\"), displacement: (0, 0, -0.06))])";
    let mut by = std::collections::BTreeSet::new();
    for (scene, precision) in [(bar, Precision::F64), (squeezed, Precision::F32)] {
        let options = Options { precision, threads: 1, ..Options::default() };
        let file =
            |method: &str| SceneFile::from_text("block", &scene.replace("METHOD", method), "".as_ref(), &[]).unwrap();
        let passes = ["", "method: Newton,"].map(|method| {
            let mut simulation = sinew::Simulation::new(&file(method), &options).unwrap();
            simulation.finish().unwrap();
            simulation.step_count() + simulation.implicit_steps().map_or(0, |took| took.passes)
        });
        println!("relaxation {}, Newton {}", passes[0], passes[1]);
        let expected = if passes[1] < passes[0] { "Newton" } else { "relaxation" };
        for method in ["", "method: Newton,"] {
            let file = file(method);
            let mut engine = Engine::new(&file, options.clone(), false, false, || false).up_to(1.0);
            let choices = engine.choices().unwrap();
            assert_eq!(choices.base.method.to_string(), expected, "{:?}", choices.notes);
            // the other one is a row
            assert_eq!(choices.methods.len(), 1);
            assert_ne!(choices.methods[0].to_string(), expected);
            let note = choices.notes.iter().find(|note| note.starts_with("rest by"));
            assert!(note.is_some_and(|note| note.contains(&format!("rest by {expected}"))), "{:?}", choices.notes);
        }
        by.insert(expected);
    }
    assert_eq!(by.len(), 2, "neither is the cheaper one always");
}
