//! A formula of an energy, as scenes have it, put into WGSL: names become those of what the function is given, `^`
//! becomes `pow`, whole numbers get a point. What a formula means is for the one compiler to say; places in the WGSL
//! lead back to places in the formula.

use super::form::ENERGY;
use super::{About, Complaint, limits};
use crate::materials::program::{INVARIANTS, is_name, words};
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

/// Functions that a formula may call.
const FUNCTIONS: [&str; 16] = [
    "abs",
    "clamp",
    "cos",
    "exp",
    "exp2",
    "inverseSqrt",
    "log",
    "log2",
    "max",
    "min",
    "pow",
    "sign",
    "sin",
    "sqrt",
    "step",
    "tanh",
];

/// A formula as a text of WGSL.
#[derive(Debug)]
pub(super) struct Wrapped {
    pub(super) text: String,
    /// Values of the members of its struct, by name.
    pub(super) parameters: BTreeMap<String, f64>,
    /// Bytes of the text, and of the formula that they stand for.
    pieces: Vec<(Range<usize>, Range<usize>)>,
}

/// A word of the formula on its way.
struct Word {
    /// What stands for it.
    text: String,
    at: Range<usize>,
    /// Powers that begin before it, and that end behind it.
    begin: usize,
    end: usize,
}

/// The name of the member that holds a parameter: whatever a parameter is called, this is no word of WGSL.
fn member(parameter: &str) -> String {
    format!("parameter_{parameter}")
}

/// Puts a formula into a function.
pub(super) fn wrap(formula: &str, given: &BTreeMap<String, f64>) -> Result<Wrapped, Vec<Complaint>> {
    limits::check(formula, "formula").map_err(|complaint| vec![complaint])?;
    parameters(given)?;
    let mut tokens = tokens(formula, given)?;
    powers(&mut tokens).map_err(|complaint| vec![complaint])?;
    let mut wrapped = Wrapped { text: String::new(), parameters: BTreeMap::new(), pieces: Vec::new() };
    let text = &mut wrapped.text;
    if !given.is_empty() {
        text.push_str("struct FormulaParameters {\n");
        for (name, value) in given {
            text.push_str(&format!("    {}: f32,\n", member(name)));
            wrapped.parameters.insert(member(name), *value);
        }
        text.push_str("}\n@group(0) @binding(0) var<uniform> elastic: FormulaParameters;\n");
    }
    text.push_str(&format!("fn {ENERGY}(s: Invariants) -> f32 {{\n"));
    // a name is no operator: `s.J` would be one, of which expressions have so many at most
    for name in INVARIANTS {
        text.push_str(&format!("    let {name} = s.{name};\n"));
    }
    for name in given.keys().map(|name| member(name)) {
        text.push_str(&format!("    let {name} = elastic.{name};\n"));
    }
    text.push_str("    return ");
    let end = formula.trim_end().len();
    for word in &tokens {
        let start = text.len();
        text.push_str(&"pow(".repeat(word.begin));
        text.push_str(&word.text);
        text.push_str(&")".repeat(word.end));
        wrapped.pieces.push((start..text.len(), word.at.clone()));
        text.push(' ');
    }
    // what the compiler misses, it misses at the formula's end
    wrapped.pieces.push((text.len()..text.len() + 1, end.saturating_sub(1)..end));
    text.push_str(";\n}\n");
    limits::check(text, "formula").map_err(|complaint| vec![wrapped.led_back(complaint)])?;
    Ok(wrapped)
}

impl Wrapped {
    /// A complaint about the text as one about the formula.
    pub(super) fn led_back(&self, complaint: Complaint) -> Complaint {
        let About::Bytes(bytes) = &complaint.about else { return complaint };
        let within = self.pieces.iter().filter(|(text, _)| text.start < bytes.end && bytes.start < text.end);
        let places = within.map(|(_, formula)| formula.clone()).reduce(|a, b| a.start.min(b.start)..a.end.max(b.end));
        Complaint { about: places.map_or(About::File, About::Bytes), ..complaint }
    }
}

/// Whether parameters can be called what they are.
fn parameters(given: &BTreeMap<String, f64>) -> Result<(), Vec<Complaint>> {
    let mut complaints = Vec::new();
    for name in given.keys() {
        let about = || About::Parameter(name.clone());
        let plain = is_name(name) && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
        if !plain {
            let message = format!("`{name}` cannot be the name of a parameter");
            complaints.push(Complaint::new(about(), message).note("allowed: a letter, then letters, digits and `_`"));
        } else if INVARIANTS.contains(&name.as_str()) || FUNCTIONS.contains(&name.as_str()) {
            complaints
                .push(Complaint::new(about(), format!("`{name}` already has a meaning in a formula")).note(allowed()));
        }
    }
    if complaints.is_empty() { Ok(()) } else { Err(complaints) }
}

/// What a formula may be made of.
fn allowed() -> String {
    format!("variables: {}; functions: {}; + - * / ^ ( )", INVARIANTS.join(", "), FUNCTIONS.join(", "))
}

/// The words of a formula, blanks left out.
fn tokens(formula: &str, given: &BTreeMap<String, f64>) -> Result<Vec<Word>, Vec<Complaint>> {
    let found: Vec<Range<usize>> = words(formula).filter(|range| !formula[range.clone()].trim().is_empty()).collect();
    let (mut tokens, mut complaints) = (Vec::new(), Vec::new());
    let mut unused: BTreeSet<&str> = given.keys().map(String::as_str).collect();
    for (number, at) in found.iter().enumerate() {
        let word = &formula[at.clone()];
        let called = found.get(number + 1).is_some_and(|next| &formula[next.clone()] == "(");
        let mut complain = |message: String, notes: Vec<String>| {
            complaints.push(Complaint { notes, ..Complaint::new(About::Bytes(at.clone()), message) });
        };
        let text = match word {
            "+" | "-" | "*" | "/" | "^" | "(" | ")" | "," => word.to_owned(),
            _ if FUNCTIONS.contains(&word) && called => word.to_owned(),
            _ if is_name(word) && called => {
                let near = crate::scene::nearest(word, FUNCTIONS).map(|near| format!("did you mean `{near}`?"));
                let all = format!("functions: {}", FUNCTIONS.join(", "));
                complain(format!("`{word}` is no function of formulas"), near.into_iter().chain([all]).collect());
                continue;
            }
            _ if INVARIANTS.contains(&word) => word.to_owned(),
            _ if given.contains_key(word) => {
                unused.remove(word);
                member(word)
            }
            _ if is_name(word) => {
                let names = INVARIANTS.iter().copied().chain(given.keys().map(String::as_str));
                let near = crate::scene::nearest(word, names).map(|near| format!("did you mean `{near}`?"));
                let given: Vec<&str> = given.keys().map(String::as_str).collect();
                let given = if given.is_empty() { "none".to_owned() } else { given.join(", ") };
                let notes = [format!("variables: {}", INVARIANTS.join(", ")), format!("`parameters`: {given}")];
                let message = format!("`{word}` is neither a variable nor one of `parameters`");
                complain(message, near.into_iter().chain(notes).collect());
                continue;
            }
            _ => match decimal(word) {
                Some(value) => format!("{value:?}"),
                None => {
                    complain(format!("`{word}` has no place in a formula"), vec![allowed()]);
                    continue;
                }
            },
        };
        tokens.push(Word { text, at: at.clone(), begin: 0, end: 0 });
    }
    for name in unused.into_iter().filter(|_| complaints.is_empty()).collect::<Vec<_>>() {
        let message = format!("the formula does not have the parameter `{name}`");
        complaints.push(Complaint::new(About::Parameter(name.to_owned()), message).note("leave it out, or use it"));
    }
    if tokens.is_empty() && complaints.is_empty() {
        complaints.push(Complaint::new(About::File, "the formula is empty").note(allowed()));
    }
    if complaints.is_empty() { Ok(tokens) } else { Err(complaints) }
}

fn decimal(word: &str) -> Option<f64> {
    let plain = word.starts_with(|c: char| c.is_ascii_digit() || c == '.')
        && word.chars().all(|c| c.is_ascii_digit() || matches!(c, '.' | 'e' | 'E' | '+' | '-'));
    word.parse().ok().filter(|value: &f64| plain && value.is_finite())
}

/// A bracket that is open.
struct Level {
    /// The word it begins at: a function's name, or the bracket.
    from: usize,
    /// Where the last operand in it begins.
    operand: Option<usize>,
    /// Powers whose exponent is still to come to its end.
    open: usize,
}

/// Makes `pow(a, b)` of each a ^ b: of the highest rank, a^b^c is a^(b^c), −a^b is −(a^b).
fn powers(tokens: &mut [Word]) -> Result<(), Complaint> {
    let mut levels = vec![Level { from: 0, operand: None, open: 0 }];
    for i in 0..tokens.len() {
        let at = About::Bytes(tokens[i].at.clone());
        let call = i > 0 && FUNCTIONS.contains(&tokens[i - 1].text.as_str());
        let Some(level) = levels.last_mut() else { break };
        let begins = !matches!(tokens[i].text.as_str(), "+" | "-" | "*" | "/" | "^" | "," | ")");
        if begins && level.operand.is_some() {
            return Err(Complaint::new(at, "an operator is missing before this"));
        }
        // where an operand has come to its end
        let ended = match tokens[i].text.as_str() {
            "(" => {
                levels.push(Level { from: if call { i - 1 } else { i }, operand: None, open: 0 });
                continue;
            }
            ")" => {
                let (from, open) = (level.from, level.open);
                if levels.len() == 1 {
                    return Err(Complaint::new(at, "this bracket closes none"));
                }
                if open > 0 {
                    return Err(Complaint::new(at, "an exponent is missing before this bracket"));
                }
                levels.pop();
                from
            }
            "^" => {
                let Some(operand) = level.operand else {
                    return Err(Complaint::new(at, "there is nothing before `^` to raise to a power"));
                };
                tokens[operand].begin += 1;
                level.open += 1;
                level.operand = None;
                tokens[i].text = ",".to_owned();
                continue;
            }
            "+" | "*" | "/" | "," | "-" => {
                // a sign belongs to the exponent, other operators end without one
                let sign = tokens[i].text == "-" && level.operand.is_none();
                if level.open > 0 && !sign {
                    return Err(Complaint::new(at, format!("an exponent is missing before `{}`", tokens[i].text)));
                }
                level.operand = None;
                continue;
            }
            name if FUNCTIONS.contains(&name) => continue,
            _ => i,
        };
        let next = tokens.get(i + 1).is_some_and(|next| next.text == "^");
        if let Some(level) = levels.last_mut() {
            level.operand = Some(ended);
            if !next {
                tokens[i].end += std::mem::take(&mut level.open);
            }
        }
    }
    let last = tokens.last().map_or(0..0, |word| word.at.clone());
    match levels.last() {
        Some(level) if levels.len() > 1 => {
            let at = tokens.get(level.from).map_or(last, |word| word.at.clone());
            Err(Complaint::new(About::Bytes(at), "this bracket is not closed"))
        }
        Some(level) if level.open > 0 => Err(Complaint::new(About::Bytes(last), "the exponent is missing")),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests;
