//! A solver that solves nothing: its errors are formulas.

use sinew::glam::DVec3;
use sinew::mesh::generators::box_mesh;
use sinew::mesh::{ElementKind, Mesh};
use sinew_studies::accuracy::solver::{BodyField, Channel, Field};
use sinew_studies::accuracy::study::Outcome;
use sinew_studies::accuracy::{
    Choices, Configuration, Cost, Digits, Factor, Method, Plan, Processor, Refusal, Solution, Solver, StudyObserver,
};
use std::collections::BTreeMap;
use std::sync::Arc;

/// What its results are made of: exact · (1 + space hᵖ + time Δt² + rounding).
#[derive(Clone)]
pub struct MadeUp {
    /// The tip's displacement with cells and steps of no size (m).
    pub exact: f64,
    /// The order in the cell size, and its factor on the scene's mesh.
    pub order: f64,
    pub space: f64,
    /// Relative error of the scene's step.
    pub time: f64,
    /// Relative error of f32.
    pub rounding: f64,
    /// Seconds that an element and step takes.
    pub seconds: f64,
    /// Ways to step in time.
    pub methods: Vec<Method>,
    /// Relative error of an implicit step of a second, of first or second order, and what one takes in explicit steps.
    pub implicit: f64,
    pub passes: f64,
    /// Configurations that break down, by label.
    pub breaks: Vec<&'static str>,
    /// Configurations that are refused, by label.
    pub refuses: Vec<&'static str>,
    /// After so many runs somebody wants it to end.
    pub interrupted_after: Option<usize>,
    pub runs: Vec<String>,
}

impl Default for MadeUp {
    fn default() -> Self {
        Self {
            exact: -2e-3,
            order: 2.0,
            space: 0.04,
            time: 1e-4,
            rounding: 1e-6,
            seconds: 1e-6,
            methods: Vec::new(),
            implicit: 0.05,
            passes: 4.0,
            breaks: Vec::new(),
            refuses: Vec::new(),
            interrupted_after: None,
            runs: Vec::new(),
        }
    }
}

pub fn base() -> Configuration {
    Configuration {
        element: Some(ElementKind::Hex8),
        mesh: Factor::ONE,
        step: 1,
        method: Method::Explicit,
        digits: Digits::Compensated,
        hourglass: 1.0,
        viscous: None,
        law: None,
        place: Processor::Cpu,
        without: None,
    }
}

impl MadeUp {
    fn value(&self, c: &Configuration) -> f64 {
        let h = 1.0 / c.mesh.value();
        let locking = if c.element == Some(ElementKind::Tet4) { 4.0 } else { 1.0 };
        let space = locking * self.space * h.powf(self.order);
        let time = match c.method {
            Method::Implicit { step, .. } => self.implicit * step.powi(c.method.order()),
            Method::HeavierMasses(times) => self.time * f64::from(times),
            _ => self.time / f64::from(c.step).powi(2),
        };
        let rounding = if c.digits == Digits::Double { 0.0 } else { self.rounding };
        let effect = if c.without.is_some() { 0.5 } else { 1.0 };
        effect * self.exact * (1.0 + space + time + rounding)
    }

    /// A bar along x that bends: uz = value · x², its field as good as its tip.
    fn field(&self, c: &Configuration) -> Field {
        let cells = c.mesh.times(4).unwrap_or(4);
        let mesh: Mesh = box_mesh(DVec3::ONE, (cells, cells, cells), ElementKind::Hex8).unwrap();
        let value = self.value(c);
        let bend = |share: f64| mesh.points.iter().map(|x| DVec3::new(0.0, 0.0, share * value * x.x * x.x)).collect();
        let masses = vec![1.0 / mesh.points.len() as f64; mesh.points.len()];
        let body = BodyField { displacements: vec![bend(0.5), bend(1.0)], mesh: Arc::new(mesh.clone()), masses };
        Field { times: vec![0.5, 1.0], bodies: BTreeMap::from([("bar".to_string(), body)]) }
    }
}

impl Solver for MadeUp {
    fn choices(&mut self) -> Result<Choices, Refusal> {
        Ok(Choices {
            base: base(),
            elements: vec![ElementKind::Tet4, ElementKind::Hex8],
            meshes: [(1, 2), (1, 1), (2, 1), (4, 1)].map(|(up, down)| Factor::new(up, down)).to_vec(),
            single_layers: vec![],
            touches: false,
            steps: vec![2, 4],
            step_is_fixed: false,
            digits: vec![Digits::Plain, Digits::Compensated, Digits::Double],
            hourglass: vec![0.5],
            viscous: vec![],
            laws: vec![],
            places: vec![],
            methods: self.methods.clone(),
            quantities: vec!["tip.uz".into()],
            effects: vec!["gravity".into()],
            unseen: vec![],
            notes: vec![],
        })
    }

    fn predict(&mut self, c: &Configuration) -> Result<Cost, Refusal> {
        if self.refuses.contains(&c.label(&base()).as_str()) {
            return Err(Refusal::Refused("it makes no sense".into()));
        }
        let elements = 64.0 * c.mesh.value().powi(3);
        let explicit = 100.0 * c.mesh.value() * f64::from(c.step);
        let (steps, passes) = match c.method {
            Method::Implicit { step, .. } => (1.0 / step, self.passes),
            Method::HeavierMasses(times) => (explicit / f64::from(times).sqrt(), 1.0),
            _ => (explicit, 1.0),
        };
        let double = if c.digits == Digits::Double { 2.0 } else { 1.0 };
        let seconds = self.seconds * double * elements * steps * passes;
        Ok(Cost { seconds, elements: elements as u64, steps: steps as u64 })
    }

    fn solve(&mut self, c: &Configuration) -> Result<Solution, Refusal> {
        let label = c.label(&base());
        if self.interrupted_after.is_some_and(|runs| self.runs.len() >= runs) {
            return Err(Refusal::Interrupted);
        }
        self.runs.push(label.clone());
        if self.breaks.contains(&label.as_str()) {
            return Err(Refusal::Broke("an element turned inside out".into()));
        }
        let cost = self.predict(c)?;
        let values = vec![0.0, 0.5 * self.value(c), self.value(c)];
        let channel = Channel {
            name: "tip.uz".into(),
            group: "tip".into(),
            unit: "m".into(),
            times: vec![0.0, 0.5, 1.0],
            values,
        };
        Ok(Solution {
            channels: vec![channel],
            field: Some(self.field(c)),
            seconds: cost.seconds,
            preload: 0.0,
            timed: 1,
            simulated: Some(1.0),
            steps: cost.steps,
            elements: cost.elements,
            nodes: cost.elements,
            time_step: 0.01 / f64::from(c.step),
            backend: "made up".into(),
            hourglass_share: 0.0,
        })
    }
}

/// Observes nothing.
pub struct Nobody;

impl StudyObserver for Nobody {
    fn planned(&mut self, _: &Plan) {}
    fn begins(&mut self, _: &str, _: f64, _: usize, _: usize) {}
    fn ended(&mut self, _: &str, _: &Outcome) {}
}
