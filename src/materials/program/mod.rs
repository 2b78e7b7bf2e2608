//! Programs: a law or a load written in WGSL alone, ready to run on the CPU.
//!
//! A pure function of WGSL (no memory, no threads, loops with a fixed number of rounds) is a fixed arrangement of sums,
//! products, roots, exponentials and choices. `translate` finds it from naga's reading of the text, in double
//! precision, with the author's parameters put in as constants; a [`Program`] then runs it over any
//! [`Real`](crate::math::Real): in f64 as the reference, over registers as the CPU backend does.

mod arithmetic;
mod derivative;
mod differences;
mod emit;
mod energy;
mod expression;
mod flow;
mod functions;
mod graph;
mod polynomial;
mod record;
mod tape;
mod tidy;
mod translate;
mod twin;
mod value;
mod words;

pub use energy::{DerivedLaw, INVARIANTS};
pub use record::{Recorded, RecordedLaw, record};
pub use tape::{Program, SLOTS};
pub(crate) use words::{is_name, words};

use graph::Graph;
use naga::{AddressSpace, Module, Span, TypeInner};
use std::collections::BTreeMap;
use std::ops::Range;
use translate::Translator;
use twin::Twin;
use value::Value;

/// Why a function cannot become a program.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Untranslatable {
    /// Bytes of the text; none where the whole function is meant.
    pub at: Option<Range<usize>>,
    /// What is wrong.
    pub message: String,
    /// What is allowed.
    pub notes: Vec<String>,
}

impl Untranslatable {
    fn new(at: Span, message: impl Into<String>) -> Self {
        Self { at: at.to_range(), message: message.into(), notes: Vec::new() }
    }

    fn note(mut self, note: impl Into<String>) -> Self {
        self.notes.push(note.into());
        self
    }
}

/// Functions of ours that look at the bits of a number: what they mean is known by their names.
pub const KNOWN_BY_NAME: [&str; 4] = ["inverse_cbrt", "exponential", "exponential_less_one", "logarithm_of_one_plus"];

const NOT_ALLOWED: &str = "this is not possible in a text of one's own";
const FUNCTIONS: &str = "allowed: abs, all, any, clamp, cos, cross, determinant, distance, dot, exp, exp2, fma, \
     inverseSqrt, length, log, log2, max, min, mix, normalize, outer, pow, saturate, select, sign, sin, sqrt, step, \
     tanh, transpose";

/// The text of the WGSL functions of a law or a load, read in double precision.
pub struct ProgramSource {
    module: Module,
    twin: Twin,
}

impl ProgramSource {
    /// Reads a text that is known to be valid WGSL.
    ///
    /// # Errors
    /// What has no counterpart in double precision, such as `bitcast`.
    pub fn read(text: &str) -> Result<Self, Untranslatable> {
        let twin = Twin::new(text);
        let error = match naga::front::wgsl::parse_str(&twin.text) {
            Ok(module) => return Ok(Self { module, twin }),
            Err(error) => error,
        };
        let unfolded = Twin::unfolded(text);
        if let Ok(module) = naga::front::wgsl::parse_str(&unfolded.text) {
            return Ok(Self { module, twin: unfolded });
        }
        let at = error.labels().next().and_then(|(span, _)| span.to_range());
        let message = format!("this cannot be computed on the CPU: {}", error.message());
        Err(Untranslatable { at: at.map(|range| twin.original(range)), message, notes: Vec::new() })
    }

    /// Translates a function whose arguments and result are numbers, or structs and vectors of numbers. Inputs and
    /// outputs are these numbers in order; `uniforms` are the values of the `f32` members of each `var<uniform>`.
    ///
    /// # Errors
    /// What in the text, or in our own part of it, cannot be translated.
    pub fn translate(&self, name: &str, uniforms: &BTreeMap<String, Vec<f64>>) -> Result<Program, Untranslatable> {
        self.program(name, uniforms).map_err(|mut error| {
            error.at = error.at.map(|range| self.twin.original(range));
            error
        })
    }

    fn program(&self, name: &str, uniforms: &BTreeMap<String, Vec<f64>>) -> Result<Program, Untranslatable> {
        let function = self.module.functions.iter().find(|(_, f)| f.name.as_deref() == Some(name));
        let Some((handle, function)) = function else {
            return Err(Untranslatable::new(Span::UNDEFINED, format!("there is no function `{name}`")));
        };
        let at = self.module.functions.get_span(handle);
        let mut translator = Translator::new(&self.module, Vec::new());
        translator.globals = self.globals(&mut translator.graph, uniforms);
        let (mut arguments, mut inputs) = (Vec::new(), 0);
        for argument in &function.arguments {
            let zero = translator.zero(argument.ty, at)?;
            arguments.push(numbered(&mut translator.graph, &zero, &mut inputs));
        }
        let result = translator.call(function, arguments, at)?;
        let outputs = result.floats().ok_or_else(|| Untranslatable::new(at, translate::VARYING))?;
        let program = Program::new(&translator.graph, usize::from(inputs), &outputs);
        program.map_err(|mut error| {
            error.at = at.to_range();
            error
        })
    }

    /// The values of `var<uniform>`s; none for other variables.
    fn globals(&self, graph: &mut Graph, uniforms: &BTreeMap<String, Vec<f64>>) -> Vec<Option<Value>> {
        let value = |variable: &naga::GlobalVariable| {
            let values = uniforms.get(variable.name.as_deref()?)?;
            let floats = Value::vector(values.iter().map(|value| graph.constant(*value)).collect::<Vec<_>>());
            let uniform = variable.space == AddressSpace::Uniform;
            match self.module.types[variable.ty].inner {
                TypeInner::Struct { .. } if uniform => Some(floats),
                TypeInner::Scalar(_) if uniform => floats.at(&[0]).cloned(),
                _ => None,
            }
        };
        self.module.global_variables.iter().map(|(_, variable)| variable).map(value).collect()
    }
}

/// Inputs in place of the numbers of a value.
fn numbered(graph: &mut Graph, zero: &Value, next: &mut u16) -> Value {
    match zero {
        Value::Parts(parts) => Value::Parts(parts.iter().map(|part| numbered(graph, part, next)).collect()),
        Value::Float(_) => {
            *next += 1;
            Value::Float(graph.input(*next - 1))
        }
        other => other.clone(),
    }
}
