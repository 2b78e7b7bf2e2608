//! Scenes run without the viewer: what a step takes in a page, and whether it comes to what it comes to elsewhere.
//!
//! What may be put aside while it waits for a device takes nothing and gives nothing (`page/wait.js`): a run is asked
//! for, made, and its answer fetched.

use serde_json::json;
use sinew::{Error, Options, SceneFile, Simulation};
use std::cell::RefCell;
use wasm_bindgen::prelude::*;
use web_time::Instant;

struct Asked {
    text: String,
    steps: u64,
    options: Options,
}

thread_local! {
    static ASKED: RefCell<Option<Asked>> = const { RefCell::new(None) };
    static ANSWER: RefCell<Result<String, String>> = const { RefCell::new(Ok(String::new())) };
}

/// Asks for the text of a scene to be run for so many steps, on `cpu`, `gpu` or where it is best.
///
/// # Errors
/// That there is no such backend.
#[wasm_bindgen]
pub fn ask_for_run(text: String, steps: u32, backend: Option<String>) -> Result<(), JsValue> {
    let options = super::options(backend.as_deref())?;
    ASKED.set(Some(Asked { text, steps: u64::from(steps), options }));
    Ok(())
}

/// Makes the run that was asked for last.
#[wasm_bindgen]
pub fn make_run() {
    if let Some(asked) = ASKED.take() {
        let answer = run(&asked).map_err(|error| error.to_string());
        ANSWER.set(answer);
    }
}

/// What came of it: an object in JSON of backend, elements, steps, seconds that the steps took, simulated time (s), and
/// of each body where its nodes are by then (m), in the author's order.
///
/// # Errors
/// What is wrong with the scene, or how it broke down, in words.
#[wasm_bindgen]
pub fn answer_of_run() -> Result<String, JsValue> {
    ANSWER.replace(Ok(String::new())).map_err(|why| JsValue::from_str(&why))
}

fn run(asked: &Asked) -> Result<String, Error> {
    let files = super::scenes::bundle().files;
    let scene = SceneFile::from_memory("scene.ron", &asked.text, files, &[]);
    let scene = scene.map_err(|wrong| Error::Scene(Box::new(wrong)))?;
    let mut simulation = Simulation::new(&scene, &asked.options)?;
    let started = Instant::now();
    simulation.advance(asked.steps)?;
    let mut bodies = serde_json::Map::new();
    let mut elements = 0;
    for name in scene.scene.bodies.keys() {
        let positions: Vec<[f64; 3]> = simulation.positions(name)?.iter().map(|place| place.to_array()).collect();
        elements += simulation.elements_left(name)?;
        bodies.insert(name.clone(), json!(positions));
    }
    // with the first look at where it has come to: a GPU has only been told of steps before
    let seconds = started.elapsed().as_secs_f64();
    let (steps, time, backend) = (simulation.step_count(), simulation.time(), simulation.backend());
    Ok(json!({
        "backend": backend, "elements": elements, "steps": steps, "seconds": seconds, "time": time, "bodies": bodies,
    })
    .to_string())
}
