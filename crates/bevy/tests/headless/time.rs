//! The clock, inputs, and what breaks down.

use crate::*;
use bevy_time::{Fixed, Time};
use std::time::Duration;

fn elapsed(app: &App) -> f64 {
    app.world().resource::<Time<Fixed>>().elapsed_secs_f64()
}

#[test]
fn simulated_time_is_that_of_ticks() {
    let mut app = app();
    let scene = spawn(&mut app, BAR);
    update(&mut app, 20);
    let (time, step) = (simulation(&app, scene).time(), simulation(&app, scene).time_step());
    assert!(elapsed(&app) > 0.25);
    assert!(time >= elapsed(&app) - 1e-9 && time <= elapsed(&app) + step, "{time} {}", elapsed(&app));
}

#[test]
fn a_paused_clock_moves_nothing_and_a_slow_one_less() {
    let mut app = app();
    let scene = spawn(&mut app, BAR);
    update(&mut app, 5);
    let bar = body(&app, scene, "bar");
    app.world_mut().resource_mut::<SinewClock>().paused = true;
    update(&mut app, 1);
    let (time, still) = (simulation(&app, scene).time(), places(&app, bar));
    update(&mut app, 5);
    assert_eq!((simulation(&app, scene).time(), places(&app, bar)), (time, still));
    *app.world_mut().resource_mut::<SinewClock>() =
        SinewClock { paused: false, speed: 0.25, budget: Duration::from_secs(60) };
    let before = elapsed(&app);
    update(&mut app, 16);
    let passed = simulation(&app, scene).time() - time;
    let step = simulation(&app, scene).time_step();
    assert!((passed - 0.25 * (elapsed(&app) - before)).abs() <= step, "{passed}");
}

#[test]
fn what_does_not_fit_into_the_budget_is_told_and_not_caught_up() {
    let mut app = app();
    let scene = spawn(&mut app, BAR);
    update(&mut app, 2);
    assert!(messages::<FellBehind>(&mut app).is_empty());
    app.world_mut().resource_mut::<SinewClock>().budget = Duration::ZERO;
    let (before, since) = (simulation(&app, scene).time(), elapsed(&app));
    update(&mut app, 4);
    let told = messages::<FellBehind>(&mut app);
    let passed = simulation(&app, scene).time() - before;
    assert!(!told.is_empty() && told.iter().all(|told| told.scene == scene && (0.0..1.0).contains(&told.factor)));
    assert!(passed > 0.0 && passed < 0.5 * (elapsed(&app) - since), "{passed}");
    app.world_mut().resource_mut::<SinewClock>().budget = Duration::from_secs(60);
    let (before, since) = (simulation(&app, scene).time(), elapsed(&app));
    update(&mut app, 4);
    let (passed, step) = (simulation(&app, scene).time() - before, simulation(&app, scene).time_step());
    assert!((passed - (elapsed(&app) - since)).abs() <= step, "{passed}");
}

#[test]
fn between_two_ticks_meshes_are_between_two_places() {
    let mut app = app();
    let scene = spawn(&mut app, BAR);
    update(&mut app, 4);
    let bar = body(&app, scene, "bar");
    let tick = app.world().resource::<Time<Fixed>>().timestep();
    app.insert_resource(TimeUpdateStrategy::ManualDuration(tick / 4));
    update(&mut app, 4);
    let mut heights = Vec::new();
    let share = |app: &App| app.world().resource::<Time<Fixed>>().overstep_fraction();
    for _ in 0..5 {
        app.update();
        let lowest = places(&app, bar).iter().map(|place| place[2]).fold(f32::INFINITY, f32::min);
        heights.push((share(&app), simulation(&app, scene).step_count(), lowest));
    }
    // in one tick the bar is lower in each frame
    let same_tick = heights.windows(2).filter(|pair| pair[0].1 == pair[1].1 && pair[1].0 > pair[0].0);
    let lower: Vec<bool> = same_tick.map(|pair| pair[1].2 < pair[0].2).collect();
    assert!(lower.len() >= 2 && lower.iter().all(|lower| *lower), "{heights:?}");
}

#[test]
fn inputs_go_in_and_probes_come_out() {
    let mut app = app();
    let (free, held) = (spawn(&mut app, BAR), spawn(&mut app, BAR));
    for scene in [free, held] {
        app.world_mut().entity_mut(scene).insert(SoftProbes::default());
    }
    app.world_mut().entity_mut(held).insert(SoftInputs([("weight".to_string(), 0.0)].into()));
    update(&mut app, 8);
    let tip = |app: &App, scene| app.world().get::<SoftProbes>(scene).unwrap().0["tip"].clone();
    assert!(tip(&app, free)[2] < -1e-4 && tip(&app, held)[2].abs() < 1e-9);
    app.world_mut().entity_mut(held).insert(SoftInputs([("weigth".to_string(), 1.0)].into()));
    update(&mut app, 1);
    let refused = messages::<Refused>(&mut app);
    assert!(refused.len() == 1 && refused[0].scene == held && refused[0].error.contains("weight"), "{refused:?}");
}

#[test]
fn a_scene_that_breaks_down_is_told_and_the_app_goes_on() {
    let mut app = app();
    let (wild, tame) = (spawn(&mut app, BAR), spawn(&mut app, BAR));
    app.world_mut().entity_mut(wild).insert(SoftInputs([("weight".to_string(), 1e9)].into()));
    let mut told = Vec::new();
    for _ in 0..30 {
        app.update();
        told.extend(messages::<BrokeDown>(&mut app));
    }
    assert!(told.len() == 1 && told[0].scene == wild && told[0].error.contains("broke down"), "{told:?}");
    assert!(simulation(&app, wild).is_broken() && !simulation(&app, tame).is_broken());
    assert!(simulation(&app, tame).time() > 0.4);
    app.world_mut().entity_mut(wild).insert(SoftInputs([("weight".to_string(), 1.0)].into()));
    simulation_mut(&mut app, wild).restart().unwrap();
    update(&mut app, 5);
    assert!(simulation(&app, wild).time() > 0.05 && messages::<BrokeDown>(&mut app).is_empty());
}

/// How low the lowest vertex is (m).
fn lowest(app: &App, body: Entity) -> f32 {
    places(app, body).iter().map(|place| place[2]).fold(f32::INFINITY, f32::min)
}

#[test]
fn going_back_is_seen_while_the_clock_is_paused() {
    let mut app = app();
    let scene = spawn(&mut app, BAR);
    app.world_mut().entity_mut(scene).insert(SoftProbes::default());
    update(&mut app, 10);
    let bar = body(&app, scene, "bar");
    app.world_mut().resource_mut::<SinewClock>().paused = true;
    update(&mut app, 2);
    let tip = |app: &App| app.world().get::<SoftProbes>(scene).unwrap().0["tip"][2];
    assert!(lowest(&app, bar) < -1e-3 && tip(&app) < -1e-3);
    let kept = simulation_mut(&mut app, scene).snapshot().unwrap();
    let low = lowest(&app, bar);
    simulation_mut(&mut app, scene).restart().unwrap();
    update(&mut app, 1);
    assert!(lowest(&app, bar).abs() < 1e-9 && tip(&app).abs() < 1e-9, "{}", lowest(&app, bar));
    simulation_mut(&mut app, scene).restore(&kept).unwrap();
    update(&mut app, 1);
    assert!((lowest(&app, bar) - low).abs() < 1e-7 && tip(&app) < -1e-3);
}

#[test]
fn nothing_is_drawn_between_a_state_and_one_that_was_gone_back_to() {
    let mut app = app();
    let scene = spawn(&mut app, BAR);
    update(&mut app, 10);
    let bar = body(&app, scene, "bar");
    let low = lowest(&app, bar);
    let tick = app.world().resource::<Time<Fixed>>().timestep();
    app.insert_resource(TimeUpdateStrategy::ManualDuration(tick / 4));
    simulation_mut(&mut app, scene).restart().unwrap();
    while simulation(&app, scene).step_count() == 0 {
        app.update();
    }
    assert!(lowest(&app, bar) > 0.2 * low, "{} of {low}", lowest(&app, bar));
}

#[test]
fn probes_are_those_of_the_scene_that_runs() {
    let mut app = app();
    let scene = spawn(&mut app, BAR);
    app.world_mut().entity_mut(scene).insert(SoftProbes::default());
    update(&mut app, 3);
    let other = BAR.replace("\"tip\"", "\"end\"");
    let handle = app.world_mut().resource_mut::<Assets<SceneText>>().add(SceneText::new("other", other));
    app.world_mut().entity_mut(scene).insert(SoftScene(handle));
    update(&mut app, 3);
    let names: Vec<&String> = app.world().get::<SoftProbes>(scene).unwrap().0.keys().collect();
    assert_eq!(names, ["end"]);
}
