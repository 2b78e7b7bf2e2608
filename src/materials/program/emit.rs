//! A graph as statements of WGSL: one `let` for each value.

use super::Untranslatable;
use super::graph::{Binary, Graph, Id, Node, Unary};
use naga::Span;
use std::fmt::Write as _;

impl Graph {
    /// Statements that compute some values, and what each is then called. `inputs` are expressions.
    ///
    /// # Errors
    /// A constant that f32 does not hold.
    pub(super) fn wgsl(&self, outputs: &[Id], inputs: &[String]) -> Result<(String, Vec<String>), Untranslatable> {
        let wanted = self.wanted(outputs);
        let (mut text, mut names) = (String::new(), vec![String::new(); wanted.len()]);
        let mut count = 0;
        for (index, node) in self.nodes().iter().enumerate().filter(|(index, _)| wanted[*index]) {
            let at = |id: Id| names[id.index()].as_str();
            let expression = match *node {
                Node::Input(number) => {
                    names[index] = inputs.get(usize::from(number)).cloned().unwrap_or_default();
                    continue;
                }
                Node::Constant(bits) => {
                    names[index] = literal(f64::from_bits(bits))?;
                    continue;
                }
                Node::Unary(function, x) => of_one(function, at(x)),
                Node::Binary(function, a, b) => of_two(function, at(a), at(b)),
                Node::Select(test, a, b) => format!("select({}, {}, {} > 0.0)", at(b), at(a), at(test)),
            };
            let _ = writeln!(text, "    let x{count} = {expression};");
            names[index] = format!("x{count}");
            count += 1;
        }
        Ok((text, outputs.iter().map(|output| names[output.index()].clone()).collect()))
    }
}

/// What stands for a constant that is no number: such a one cannot be written down.
const NONE: &str = "no_number(0.0)";

fn literal(value: f64) -> Result<String, Untranslatable> {
    let single = value as f32;
    if value.is_nan() {
        Ok(NONE.to_owned())
    } else if !single.is_finite() {
        let message = format!("the number {value:e} in it is beyond single precision");
        Err(Untranslatable::new(Span::UNDEFINED, message).note(format!("the largest is {:e}", f32::MAX)))
    } else if single != 0.0 && !single.is_normal() {
        Ok("0.0".to_owned())
    } else {
        // a minus of its own would meet another
        Ok(if value < 0.0 { format!("({value:?})") } else { format!("{:?}", value.abs()) })
    }
}

fn of_one(function: Unary, x: &str) -> String {
    let name = match function {
        Unary::Negate => return format!("-{x}"),
        Unary::Abs => "abs",
        Unary::Sqrt => "sqrt",
        Unary::Exp => "exponential",
        Unary::ExpLessOne => "exponential_less_one",
        Unary::Log => return format!("select(no_number({x}), log({x}), {x} > 0.0)"),
        Unary::LogOfOnePlus => {
            return format!("select(no_number({x}), logarithm_of_one_plus(max({x}, -0.9999999)), {x} > -1.0)");
        }
        Unary::InverseCbrt => "inverse_cbrt",
        Unary::Sine => "sin",
        Unary::Cosine => "cos",
    };
    format!("{name}({x})")
}

fn of_two(function: Binary, a: &str, b: &str) -> String {
    match function {
        Binary::Add => format!("{a} + {b}"),
        Binary::Subtract => format!("{a} - {b}"),
        Binary::Multiply => format!("{a} * {b}"),
        Binary::Divide => format!("{a} / {b}"),
        Binary::Min => format!("min({a}, {b})"),
        Binary::Max => format!("max({a}, {b})"),
        Binary::Less => format!("select(0.0, 1.0, {a} < {b})"),
    }
}
