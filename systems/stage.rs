//! What a node system has on a GPU beside columns and parameters.

use super::node_stages::Parameters;
use super::rows::Rows;
use crate::backend::Buffers;
use crate::backend::kernel::{Fragment, Layout, Uniform};
use crate::backend::node_stage::NodeStage;
use crate::shader;
use bevy_ecs::prelude::*;
use serde::Serialize;
use std::borrow::Cow;
use std::fmt::Write;

/// One of the things that a node system's WGSL function is called for, and what it reads there beside columns and
/// parameters: see [`NodeSystem::stages`](super::NodeSystem::stages).
#[derive(Clone, Debug, Default)]
pub struct Stage {
    /// Ascending; `None`: all of the body's nodes.
    pub(super) rows: Option<Vec<u32>>,
    own: Vec<Fragment>,
    declared: String,
    bound: Vec<Bound>,
    columns: Vec<(&'static str, Entity, &'static str)>,
    calls: Vec<(&'static str, String, Vec<Fragment>)>,
    wrong: Option<String>,
}

/// Numbers that a variable of the text holds.
#[derive(Clone, Debug)]
struct Bound {
    variable: &'static str,
    /// Of its buffer; empty: by the variable and the system.
    label: String,
    bytes: Vec<u8>,
    kind: Kind,
}

#[derive(Clone, Copy, Debug)]
enum Kind {
    List,
    Uniform(Option<Layout>),
}

impl Stage {
    /// For these rows of the body: `fn NAME(i: u32, node: u32)` is called for each of a list, which must ascend, with
    /// `i` its place there; else `fn NAME(node: u32)` for all nodes.
    pub fn of(rows: Rows<'_>) -> Self {
        let rows = match rows {
            Rows::List(rows) => Some(rows.to_vec()),
            Rows::All | Rows::Changing => None,
        };
        Self { rows, ..Self::default() }
    }

    /// With a list of numbers, `name: array<f32>`. An empty one is a single 0 there.
    pub fn reals(self, name: &'static str, numbers: &[f32]) -> Self {
        self.list(name, "f32", bytemuck::cast_slice(numbers))
    }

    /// With a list of whole numbers, `name: array<u32>`. An empty one is a single 0 there.
    pub fn integers(self, name: &'static str, numbers: &[u32]) -> Self {
        self.list(name, "u32", bytemuck::cast_slice(numbers))
    }

    fn list(mut self, variable: &'static str, word: &str, bytes: &[u8]) -> Self {
        let bytes = if bytes.is_empty() { vec![0; 4] } else { bytes.to_vec() };
        let _ = writeln!(self.declared, "@group(0) @binding(0) var<storage, read> {variable}: array<{word}>;");
        self.bound.push(Bound { variable, label: String::new(), bytes, kind: Kind::List });
        self
    }

    /// With a struct of numbers in a uniform of that name, as a component is in `parameters`
    /// ([`System::with_shader`](super::System::with_shader)).
    pub fn uniform(mut self, name: &'static str, numbers: &impl Serialize) -> Self {
        match Parameters::of(name, numbers) {
            Ok(Parameters { declared, bytes }) => {
                self.declared += &declared;
                if !bytes.is_empty() {
                    self.bound.push(Bound { variable: name, label: String::new(), bytes, kind: Kind::Uniform(None) });
                }
            }
            Err(wrong) => self.wrong = Some(wrong),
        }
        self
    }

    /// With more WGSL, and `path` under which errors name it: constants, say, or a function that differs from stage to
    /// stage.
    pub fn text(self, path: impl Into<String>, text: impl Into<Cow<'static, str>>) -> Self {
        self.fragment(Fragment::new(path, text))
    }

    /// With a file of `shaders/`.
    pub(super) fn fragment(mut self, fragment: Fragment) -> Self {
        self.own.push(fragment);
        self
    }

    /// With a uniform that the text itself declares: its layout is that of who writes it anew while it runs.
    pub(super) fn rewritten<U: Uniform>(mut self, variable: &'static str, label: String, bytes: Vec<u8>) -> Self {
        self.bound.push(Bound { variable, label, bytes, kind: Kind::Uniform(Some(U::LAYOUT)) });
        self
    }

    /// With a column that the text itself declares: of a block, or one that lies in the buffer of another.
    pub(super) fn column(mut self, variable: &'static str, of: Entity, column: &'static str) -> Self {
        self.columns.push((variable, of, column));
        self
    }

    /// Calls the function `name` of a text that is not the system's author's, in place of its own empty `function`:
    /// neither sees the other's names. `parameters`: what the uniform of that name in it holds.
    pub(super) fn calling(
        mut self,
        function: &'static str,
        name: String,
        text: Vec<Fragment>,
        parameters: &[u8],
    ) -> Self {
        self.calls.push((function, name, text));
        if !parameters.is_empty() {
            let bytes = parameters.to_vec();
            let kind = Kind::Uniform(None);
            self.bound.push(Bound { variable: "parameters", label: String::new(), bytes, kind });
        }
        self
    }

    /// What is wrong with it.
    ///
    /// # Errors
    /// A number that a shader cannot have, by name, and rows that do not ascend.
    pub(super) fn check(&self) -> Result<(), String> {
        match (&self.wrong, &self.rows) {
            (Some(wrong), _) => Err(wrong.clone()),
            (None, Some(rows)) if !rows.is_sorted_by(|one, next| one < next) => {
                Err("its rows, which a shader gets one by one, do not ascend".into())
            }
            (None, _) => Ok(()),
        }
    }

    /// Puts all of it to a stage of a system's.
    pub(super) fn put_to(self, stage: NodeStage, system: &str, buffers: &mut dyn Buffers) -> NodeStage {
        let declared = Fragment::new(format!("generated: what {system} has of its own"), self.declared);
        let own = self.own.into_iter().chain((!declared.text.is_empty()).then_some(declared));
        let mut stage = own.fold(stage, NodeStage::own);
        for Bound { variable, label, bytes, kind } in self.bound {
            let label = if label.is_empty() { format!("{variable} of {system}") } else { label };
            stage = match kind {
                Kind::List => stage.bind(variable, buffers.constants(label, &bytes)),
                Kind::Uniform(layout) => stage.bind_laid_out(variable, layout, buffers.uniform(label, &bytes)),
            };
        }
        for (variable, of, column) in self.columns {
            stage = stage.column(variable, buffers.column(of, column));
        }
        let stage =
            self.calls.into_iter().fold(stage, |stage, (function, name, own)| stage.calling(function, name, own));
        match self.rows {
            Some(rows) => stage.of_rows(rows),
            None => stage,
        }
    }
}

/// Adds what a load is multiplied with at each of its rows along each axis; empty: 1 at all.
pub(super) fn with_factors(stage: Stage, factors: &[[f64; 3]]) -> Stage {
    if factors.is_empty() {
        let text = "fn factor_of(i: u32) -> vec3<f32> {\n    return vec3<f32>(1.0);\n}\n";
        return stage.text("generated: the same load on all nodes", text);
    }
    let factors: Vec<f32> = factors.iter().flatten().map(|&factor| factor as f32).collect();
    stage.fragment(shader!("load_factor")).reals("factors", &factors)
}
