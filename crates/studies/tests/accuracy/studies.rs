//! Whole studies of a made-up solver.

use crate::made_up::{MadeUp, Nobody};
use sinew_studies::accuracy::study::Outcome;
use sinew_studies::accuracy::{Reference, Refusal, Row, Settings, Study, TargetVerdict, Varied, study, tables};
use std::collections::BTreeMap;
use std::time::Instant;

fn settings() -> Settings {
    Settings { started: Instant::now(), budget: 1e9, target: 0.01, judged_by: None, reference: None }
}

fn run(solver: &mut MadeUp, settings: &Settings) -> Study {
    study(solver, settings, &mut Nobody).unwrap()
}

fn exactly(value: f64) -> Option<Reference> {
    Some(Reference::of_values(&BTreeMap::from([("tip.uz".to_string(), value)])))
}

fn row<'a>(study: &'a Study, label: &str) -> &'a Row {
    study.rows.iter().find(|row| row.label == label).unwrap_or_else(|| panic!("no row {label}: {:#?}", study.rows))
}

fn order(study: &Study, of: &str) -> f64 {
    study.findings.orders.iter().find(|order| order.of == of).unwrap_or_else(|| panic!("{:?}", study.findings)).order
}

#[test]
fn a_solver_of_known_order_gets_that_order_back() {
    for known in [1.0, 1.5, 2.0] {
        let mut solver = MadeUp { order: known, time: 1e-7, rounding: 1e-9, ..MadeUp::default() };
        for judged_by in ["displacement", "tip.uz"] {
            let study = run(&mut solver, &Settings { judged_by: Some(judged_by.into()), ..settings() });
            for element in ["Tet4", "Hex8"] {
                let found = order(&study, element);
                assert!((found - known).abs() < 0.03, "{judged_by} of {element}: {found} instead of {known}");
            }
        }
    }
}

#[test]
fn the_made_reference_finds_the_truth_within_its_uncertainty() {
    let study = run(&mut MadeUp::default(), &settings());
    let error = row(&study, "as written").errors["tip.uz"];
    // space 4 %, time 1e-4, rounding 1e-6, measured against the finest mesh's own value
    assert!((error.error - 0.0401).abs() < error.uncertainty + 2e-4, "{error:?}");
    assert!(error.is_clear(), "{error:?}");
    let made_of: Vec<&str> = study.made_of.iter().map(|&place| study.rows[place].label.as_str()).collect();
    assert_eq!(made_of, ["as written", "mesh ×2", "mesh ×4"], "runs of the study itself, each of twice the cells");
}

#[test]
fn the_error_is_split_into_its_parts() {
    let mut solver = MadeUp { time: 8e-3, rounding: 1e-4, ..MadeUp::default() };
    let judged_by = Some("tip.uz".to_string());
    let split = run(&mut solver, &Settings { judged_by, reference: exactly(-2e-3), ..settings() }).findings.split;
    let near = |part: Option<f64>, wanted: f64| assert!((part.unwrap() - wanted).abs() < 0.05 * wanted, "{split:?}");
    near(split.total, 0.04 + 8e-3 + 1e-4);
    near(split.space, 0.04 + 8e-3 / 16.0);
    near(split.time, 8e-3 * 15.0 / 16.0);
    near(split.round_off, 1e-4);
    assert_eq!((split.model, split.stays), (None, false));
}

#[test]
fn a_step_of_second_order_is_seen_as_such() {
    let mut solver = MadeUp { time: 8e-3, ..MadeUp::default() };
    let found = order(&run(&mut solver, &settings()), "time step");
    assert!((found - 2.0).abs() < 0.01, "{found}");
}

#[test]
fn a_shear_modulus_one_percent_too_stiff_is_an_error_that_does_not_fall_with_the_mesh() {
    let stiff = MadeUp { exact: -2e-3 / 1.01, space: 2e-4, time: 1e-6, ..MadeUp::default() };
    let study = run(&mut stiff.clone(), &Settings { reference: exactly(-2e-3), ..settings() });
    let split = &study.findings.split;
    assert!(split.stays, "{split:?}");
    assert!((split.model.unwrap() - 0.01 / 1.01).abs() < 1e-4, "{split:?}");
    let said = study.findings.advice.join(" ");
    assert!(said.contains("An error of 0.99 % does not fall with the mesh"), "{said}");
    // the same with the right modulus
    let right = run(&mut MadeUp { exact: -2e-3, ..stiff }, &Settings { reference: exactly(-2e-3), ..settings() });
    assert!(!right.findings.split.stays && right.findings.split.model.is_none(), "{:?}", right.findings.split);
}

#[test]
fn advice_names_the_cheapest_under_the_target_and_where_to_spend() {
    let study = run(&mut MadeUp::default(), &Settings { reference: exactly(-2e-3), target: 0.012, ..settings() });
    let said = &study.findings.advice;
    assert!(said[0].starts_with("Cheapest under 1.2 %: mesh ×2, 1.0 % at"), "{said:?}");
    assert!(said[1].starts_with("Spend on the mesh, not on the step or the number type"), "{said:?}");
    let hasty = MadeUp { time: 0.1, space: 1e-3, ..MadeUp::default() };
    let said = run(&mut hasty.clone(), &Settings { reference: exactly(-2e-3), ..settings() }).findings.advice;
    assert!(said[1].starts_with("Spend on the step, not on the mesh"), "{said:?}");
    let rough = MadeUp { rounding: 0.1, space: 1e-3, ..MadeUp::default() };
    let said = run(&mut rough.clone(), &Settings { reference: exactly(-2e-3), ..settings() }).findings.advice;
    assert!(said[1].starts_with("Spend on the number type"), "{said:?}");
}

#[test]
fn advice_is_silent_on_parts_of_the_error_that_are_not_known() {
    let mut single = MadeUp { refuses: vec!["f64"], ..MadeUp::default() };
    let study = run(&mut single, &Settings { reference: exactly(-2e-3), ..settings() });
    assert_eq!(study.findings.split.round_off, None);
    let said = study.findings.advice.join(" ");
    assert!(said.contains("Spend on the mesh, not on the step:") && !said.contains("number type"), "{said}");
}

#[test]
fn values_that_may_be_off_themselves_bound_errors_instead_of_ranking_them() {
    let rough = exactly(-2e-3).map(|reference| reference.off_by(&BTreeMap::from([("tip.uz".to_string(), 8e-5)])));
    let study = run(&mut MadeUp::default(), &Settings { reference: rough, ..settings() });
    let error = row(&study, "as written").errors["tip.uz"];
    // the mesh makes 4 %, the reference may be off by 8e-5 of 2e-3: less than three times that
    assert!(!error.is_clear() && (error.vouched() - 0.12).abs() < 1e-12, "{error:?}");
    assert_eq!(
        (study.findings.verdict, study.reference.as_str()),
        (TargetVerdict::CannotTell, "values that the scene names")
    );
}

#[test]
fn the_verdict_is_on_the_scene_as_it_is_written() {
    let verdict = |target: f64| {
        let asked = Settings { reference: exactly(-2e-3), target, ..settings() };
        run(&mut MadeUp::default(), &asked).findings.verdict
    };
    assert_eq!((verdict(0.05), verdict(0.03)), (TargetVerdict::Met, TargetVerdict::NotMet));
}

#[test]
fn where_the_reference_may_err_as_much_nothing_is_ranked() {
    // results that follow no power of the cell size
    let mut solver = MadeUp { order: 0.1, ..MadeUp::default() };
    let study = run(&mut solver, &settings());
    assert_eq!(study.findings.verdict, TargetVerdict::CannotTell);
    let said = study.findings.advice.join(" ");
    assert!(said.contains("The reference is too coarse"), "{said}");
    let shown = tables::cells(&study);
    let hex = shown.iter().find(|row| row.label == "mesh ×2").unwrap();
    assert!(hex.error.starts_with("below "), "{}", hex.error);
    let fronts = shown.iter().filter(|row| row.on_front).count();
    assert!(fronts <= 2, "{fronts} on the front though nothing can be told apart");
}

#[test]
fn what_does_not_fit_into_the_budget_is_a_row_that_says_so() {
    let mut solver = MadeUp::default();
    let study = run(&mut solver, &Settings { budget: 0.05, reference: exactly(-2e-3), ..settings() });
    let Outcome::LeftOut(why) = &row(&study, "mesh ×4").outcome else { panic!("{:?}", row(&study, "mesh ×4")) };
    assert!(why.starts_with("predicted 1.64 s"), "{why}");
    assert!(row(&study, "as written").measured().is_some());
    assert!(study.predicted <= 0.05);
    assert!(tables::csv(&study).contains("left out,predicted 1.64 s"));
    assert!(!solver.runs.contains(&"mesh ×4".to_string()), "it ran all the same");
}

#[test]
fn a_reference_that_does_not_fit_says_which_budget_would_do() {
    // a mesh takes 6.4 s times the fourth power of its fineness, it says: of a second a busy machine leaves enough for
    // the predictions
    let mut solver = MadeUp { seconds: 1e-3, ..MadeUp::default() };
    let study = run(&mut solver, &Settings { budget: 1.0, ..settings() });
    assert!(study.reference.starts_with("none: "), "{}", study.reference);
    let more = study.more.clone().unwrap();
    assert!(more.starts_with("--budget ") && more.contains("would add `as written`"), "{more}");
    assert!(study.estimates.is_empty(), "{:?}", study.estimates);
    assert_eq!(study.findings.verdict, TargetVerdict::CannotTell);
    assert!(study.findings.advice[0].contains("Without a reference"), "{:?}", study.findings.advice);
    assert!(study.rows.iter().any(|row| row.measured().is_some()), "times are measured all the same");
}

#[test]
fn refused_and_broken_configurations_are_rows_with_their_reasons() {
    let mut solver = MadeUp { breaks: vec!["Tet4"], refuses: vec!["f64"], ..MadeUp::default() };
    let study = run(&mut solver, &Settings { reference: exactly(-2e-3), ..settings() });
    assert_eq!(row(&study, "Tet4").outcome, Outcome::Broke("an element turned inside out".into()));
    assert_eq!(row(&study, "f64").outcome, Outcome::Refused("it makes no sense".into()));
    let page = tables::markdown(&study, "a bar", "sinew accuracy bar.ron");
    for words in ["broke down: an element turned inside out", "refused: it makes no sense", "| as written |"] {
        assert!(page.contains(words), "{words:?} is not in\n{page}");
    }
}

#[test]
fn an_interrupted_study_keeps_what_was_done() {
    let mut solver = MadeUp { interrupted_after: Some(2), ..MadeUp::default() };
    let study = run(&mut solver, &Settings { reference: exactly(-2e-3), ..settings() });
    assert!(study.interrupted);
    let done = study.rows.iter().filter(|row| row.measured().is_some()).count();
    assert_eq!(done, 2);
    assert!(row(&study, "as written").errors.contains_key("tip.uz"));
}

#[test]
fn effects_are_told_with_what_they_cost_and_change_and_are_not_ranked() {
    let study = run(&mut MadeUp::default(), &settings());
    let effect = &study.findings.effects[0];
    assert_eq!((effect.effect.as_str(), effect.costs), ("gravity", 0.0));
    assert!((effect.changes - 0.5).abs() < 1e-9, "{effect:?}");
    let without = study.rows.iter().find(|row| row.varied == Varied::Effect).unwrap();
    assert!(!without.on_front);
    assert!(tables::cells(&study).iter().all(|row| !row.label.contains("gravity")));
}

#[test]
fn everything_is_varied_one_at_a_time_and_elements_with_every_mesh() {
    let study = run(&mut MadeUp::default(), &settings());
    for label in [
        "as written",
        "mesh ×1/2",
        "mesh ×2",
        "mesh ×4",
        "Tet4",
        "Tet4, mesh ×1/2",
        "Tet4, mesh ×2",
        "Tet4, mesh ×4",
        "Δt/2",
        "Δt/4",
        "f32 plain",
        "f64",
        "hourglass ×0.5",
        "Δt/4, f64",
        "without gravity",
    ] {
        row(&study, label);
    }
    assert_eq!(study.rows.len(), 15);
}

#[test]
fn a_quantity_that_is_not_there_is_refused_with_those_that_are() {
    let asked = Settings { judged_by: Some("tip.ux".into()), ..settings() };
    let Err(Refusal::Refused(why)) = study(&mut MadeUp::default(), &asked, &mut Nobody) else { panic!() };
    for words in ["no quantity `tip.ux`", "tip.uz", "displacement", ".amplitude"] {
        assert!(why.contains(words), "{words:?} is not in {why}");
    }
}
