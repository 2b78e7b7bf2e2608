//! WGSL text read in double precision: the same text with `f64` for `f32`, from which naga folds constants such as
//! 1.0 / 3.0 to all their digits. WGSL itself knows no `f64`; naga does.

use super::words::words;
use std::ops::Range;

/// The function of [`Twin::unfolded`] that gives 1.
const ONE: &str = "one_that_is_not_folded";

/// WGSL's own functions that a law may call; all take numbers, vectors or matrices of them.
const MATH: [&str; 25] = [
    "abs",
    "clamp",
    "cos",
    "cross",
    "determinant",
    "distance",
    "dot",
    "exp",
    "exp2",
    "fma",
    "inverseSqrt",
    "length",
    "log",
    "log2",
    "max",
    "min",
    "mix",
    "normalize",
    "pow",
    "saturate",
    "sign",
    "sin",
    "sqrt",
    "step",
    "tanh",
];

/// The text in double precision, and where each changed word came from.
pub(super) struct Twin {
    pub(super) text: String,
    /// Bytes in the twin and in the original of each word that changed.
    changed: Vec<(Range<usize>, Range<usize>)>,
}

impl Twin {
    /// Changes the words of a text that parses: float types, and numbers with a point or an exponent.
    pub(super) fn new(original: &str) -> Self {
        Self::of(original, false)
    }

    /// The same text, in which no call of WGSL's own functions is a constant: their first argument is multiplied by
    /// what only [`ONE`] knows to be 1, which the graph folds to all its digits. naga cannot tell the value of such a
    /// call of constants of type `f64`, and refuses it.
    pub(super) fn unfolded(original: &str) -> Self {
        let mut twin = Self::of(original, true);
        twin.text.push_str(&format!("\nfn {ONE}() -> f64 {{ return 1.0lf; }}\n"));
        twin
    }

    fn of(original: &str, unfolded: bool) -> Self {
        let mut twin = Self { text: String::with_capacity(original.len() * 5 / 4), changed: Vec::new() };
        let mut constant = Constant::default();
        let mut called = false;
        for range in words(original) {
            let word = &original[range.clone()];
            let declared = constant.holds(word);
            match if declared { constant.abstracted(word) } else { double(word) } {
                Some(other) => twin.change(&other, range.clone()),
                None => twin.text.push_str(word),
            }
            if unfolded && called && word == "(" {
                // a product comes before all that may follow the argument's first factor
                twin.change(&format!("{ONE}() * "), range.end..range.end);
            }
            called = !declared && MATH.contains(&word) || called && word.trim().is_empty();
        }
        twin
    }

    /// Appends what stands for some bytes of the original.
    fn change(&mut self, other: &str, original: Range<usize>) {
        let start = self.text.len();
        self.text.push_str(other);
        self.changed.push((start..self.text.len(), original));
    }

    /// The place in the original of a place in the twin.
    pub(super) fn original(&self, range: Range<usize>) -> Range<usize> {
        self.place(range.start, false)..self.place(range.end, true)
    }

    fn place(&self, at: usize, end: bool) -> usize {
        let before = self.changed.partition_point(|(word, _)| if end { word.start < at } else { word.start <= at });
        match before.checked_sub(1).and_then(|last| self.changed.get(last)) {
            None => at,
            Some((word, original)) if at < word.end => {
                if end {
                    original.end
                } else {
                    original.start
                }
            }
            Some((word, original)) => original.end + (at - word.end),
        }
    }
}

/// Where a declaration of a constant has got to. naga folds numbers of no type yet to all the digits of `f64`, numbers
/// of type `f64` not at all: so constants keep the former.
#[derive(Default)]
enum Constant {
    #[default]
    Outside,
    Name,
    Type,
    Value,
}

impl Constant {
    /// Moves on to the next word; whether that belongs to the declaration.
    fn holds(&mut self, word: &str) -> bool {
        *self = match (&self, word) {
            (Self::Outside, "const") => Self::Name,
            (Self::Name, ":") => Self::Type,
            (Self::Name | Self::Type, "=") => Self::Value,
            (Self::Value, ";") => Self::Outside,
            _ => return !matches!(self, Self::Outside),
        };
        !matches!(self, Self::Outside)
    }

    /// What stands for a word of it, where that is another: `const a: f32` has no type.
    fn abstracted(&self, word: &str) -> Option<String> {
        match self {
            Self::Type => (!word.trim().is_empty()).then(String::new),
            _ => double(word).map(|other| match other.strip_suffix("lf") {
                Some(digits) if digits.contains(['.', 'e', 'E', 'p', 'P']) => digits.to_owned(),
                Some(digits) => format!("{digits}.0"),
                None => other,
            }),
        }
    }
}

/// What stands for a word in double precision, where that is another.
fn double(word: &str) -> Option<String> {
    if word == "f32" {
        return Some("f64".to_owned());
    }
    if word.starts_with(|c: char| c.is_ascii_digit()) || (word.starts_with('.') && word.len() > 1) {
        let hexadecimal = word.starts_with("0x") || word.starts_with("0X");
        let digits = if hexadecimal && !word.contains(['p', 'P', '.']) { word } else { word.trim_end_matches('f') };
        let float = digits.len() < word.len()
            || word.contains('.')
            || (!hexadecimal && word.contains(['e', 'E']))
            || word.contains(['p', 'P']);
        return float.then(|| format!("{digits}lf"));
    }
    // vec3f, mat3x3f
    let stem = word.strip_suffix('f')?;
    let size = |text: &str| matches!(text, "2" | "3" | "4");
    let known = stem.strip_prefix("vec").is_some_and(size)
        || stem.strip_prefix("mat").and_then(|sizes| sizes.split_once('x')).is_some_and(|(a, b)| size(a) && size(b));
    known.then(|| format!("{stem}<f64>"))
}

#[cfg(test)]
mod tests;
