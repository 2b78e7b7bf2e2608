//! Sinew and its viewer in a page. On anything but WebAssembly there is nothing here: `src/main.rs` makes the page.
#![cfg(target_arch = "wasm32")]

mod run;
mod scenes;
mod waiting;

use eframe::WebRunner;
use serde_json::json;
use sinew::driver::State;
use sinew::{BackendChoice, Options};
use sinew_view::{App, FIELDS, Settings, Start, Steps, screen};
use std::cell::RefCell;
use wasm_bindgen::prelude::*;
use web_sys::HtmlCanvasElement;

/// The page: a viewer on a canvas.
#[wasm_bindgen]
pub struct Page {
    runner: WebRunner,
}

#[wasm_bindgen]
#[allow(clippy::new_without_default, reason = "JavaScript knows constructors only")]
impl Page {
    /// Nothing yet.
    #[wasm_bindgen(constructor)]
    pub fn new() -> Self {
        Self { runner: WebRunner::new() }
    }

    /// Begins with the shipped scene of a name, or with a text if one is given, in the colours of a field, on `cpu`,
    /// `gpu` or where it is best.
    ///
    /// # Errors
    /// That nothing can be drawn: there is neither WebGPU nor WebGL.
    pub async fn start(
        &self,
        canvas: HtmlCanvasElement,
        scene: String,
        text: Option<String>,
        run: bool,
        field: Option<String>,
        backend: Option<String>,
    ) -> Result<(), JsValue> {
        let mut bundle = scenes::bundle();
        if let Some(text) = text {
            bundle.scenes.insert(0, (scene.clone(), text));
        }
        let field = field.and_then(|name| FIELDS.into_iter().find(|field| field.array() == name));
        let options = options(backend.as_deref())?;
        let mut start = Start {
            scene: Some(scene.into()),
            options,
            run,
            settings: Settings { field, ..Settings::default() },
            bundle: Some(bundle),
            ..Start::default()
        };
        let app: eframe::AppCreator<'static> = Box::new(move |context| {
            start.options.host = screen::host(context);
            Ok(Box::new(App::on_screen(context, start)))
        });
        self.runner.start(canvas, screen::web_options(), app).await?;
        STEPS.set(self.runner.app_mut::<App>().and_then(|app| app.steps()));
        Ok(())
    }

    /// What is seen, for who tests it: an object in JSON, or `null` before it has begun.
    pub fn status(&self) -> String {
        self.runner.app_mut::<App>().map_or_else(|| "null".into(), |app| status(&app))
    }

    /// How it came to a stop by a mistake of sinew's own, if it did.
    pub fn panicked(&self) -> Option<String> {
        self.runner.panic_summary().map(|summary| summary.message())
    }
}

thread_local! {
    static STEPS: RefCell<Option<Steps>> = const { RefCell::new(None) };
}

/// Takes the steps that are due: the page calls it once a frame, in turn with what else may be put aside (`wait.js`).
#[wasm_bindgen]
pub fn take_steps() {
    if let Some(steps) = STEPS.with_borrow(Clone::clone) {
        steps.take();
    }
}

#[wasm_bindgen(start)]
fn begin() {
    waiting::begin();
}

/// How simulations run, by the name of the backend.
fn options(backend: Option<&str>) -> Result<Options, JsValue> {
    let backend = match backend {
        None | Some("auto") => BackendChoice::Auto,
        Some("cpu") => BackendChoice::Cpu,
        Some("gpu") => BackendChoice::Gpu,
        Some(other) => return Err(JsValue::from_str(&format!("backend: `{other}` is none of `auto`, `cpu`, `gpu`"))),
    };
    Ok(Options { backend, threads: 1, ..Options::default() })
}

fn status(app: &App) -> String {
    let state: &State = app.state();
    let loaded = state.loaded.as_ref();
    json!({
        "scene": loaded.map(|loaded| loaded.scene.path.display().to_string()),
        "number": loaded.map(|loaded| loaded.number),
        "backend": loaded.map(|loaded| loaded.backend.clone()),
        "drawn_by": app.drawn_by(),
        "step": state.step,
        "time": state.time,
        "running": state.running,
        "finished": state.finished,
        "real_time_factor": state.real_time_factor,
        "refusal": state.refusal.as_ref().map(|refusal| refusal.reason.clone()),
        "mistakes": app.mistakes(),
        "breakdown": state.breakdown.as_ref().map(|broken| broken.to_string()),
    })
    .to_string()
}
