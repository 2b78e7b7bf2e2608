//! Whether a text of the user's own has a bearable size and depth, from its words alone. Compilers go into what is
//! nested by calls within calls: a text without limits would take all of their stack, or all of one's time.

use super::{About, Complaint};
use crate::materials::program::{is_name, words};
use crate::scene::limits::{LAW_DECLARATIONS, LAW_DEPTH, LAW_WORDS};
use std::ops::Range;

/// How much deeper a bracket leads than an operator; the compiler goes through 200 brackets at most.
const BRACKET: usize = 3;

/// A bracket that is open, and what stands in it so far.
#[derive(Default)]
struct Level {
    /// Operators and closed brackets of the expression: no tree of it is deeper.
    now: usize,
    /// The most of the expressions before, where commas part them.
    most: usize,
    /// Brackets `<` of types that are open; after a name it could also be "less than".
    angles: usize,
    /// Whether a block of statements has just ended: what follows belongs to it only by `else`.
    after_block: bool,
}

/// Finds the place where a text, a `law` say, becomes too long, too deep or too much.
pub(super) fn check(text: &str, word: &str) -> Result<(), Complaint> {
    let at_most = |most: usize, found: usize, at: &Range<usize>, what: &str, note: &str| match found <= most {
        true => Ok(()),
        false => {
            let message = format!("a {word} has at most {most} {what}");
            Err(Complaint::new(About::Bytes(at.clone()), message).note(note))
        }
    };
    let mut levels = vec![Level::default()];
    let (mut count, mut declarations, mut arrays, mut after_name) = (0, 0, 0, false);
    for range in words(text) {
        let word = &text[range.clone()];
        if word.trim().is_empty() || word.starts_with("//") || word.starts_with("/*") {
            continue;
        }
        count += 1;
        at_most(LAW_WORDS, count, &range, "words, numbers and signs", "a table of so many numbers has no place in it")?;
        match word {
            "fn" | "struct" | "var" | "const" | "alias" | "override" if levels.len() == 1 => declarations += 1,
            "array" | "ptr" => arrays += 1,
            _ => {}
        }
        at_most(LAW_DECLARATIONS, declarations, &range, "declarations", "several values fit into one array")?;
        at_most(LAW_DECLARATIONS, arrays, &range, "arrays", "give a type a name and use it")?;
        nest(&mut levels, word, after_name);
        let depth = levels.iter().map(|level| level.now + BRACKET * (level.angles + 1)).sum::<usize>() - BRACKET;
        let note = "give parts of it names with `let`, or write functions";
        at_most(LAW_DEPTH, depth, &range, "operators, brackets and branches within each other", note)?;
        after_name = is_name(word);
    }
    Ok(())
}

/// Goes on to a word.
fn nest(levels: &mut Vec<Level>, word: &str, after_name: bool) {
    let Some(level) = levels.last_mut() else { return };
    if std::mem::take(&mut level.after_block) && word != "else" {
        *level = Level::default();
    }
    match word {
        "(" | "[" | "{" => levels.push(Level::default()),
        ")" | "]" | "}" => {
            let inner = level.now.max(level.most);
            // a bracket too many is for the compiler to tell
            if levels.len() > 1 {
                levels.pop();
            }
            if let Some(outer) = levels.last_mut() {
                outer.after_block = word == "}";
                // branches of a chain hold one another, what stands in them is done with
                outer.now += if outer.after_block { 1 } else { inner + 1 };
            }
        }
        ";" => *level = Level::default(),
        "," => level.most = level.most.max(std::mem::take(&mut level.now)),
        "<" if after_name => level.angles += 1,
        ">" if level.angles > 0 => level.angles -= 1,
        _ if is_name(word) || word.starts_with(|c: char| c.is_ascii_digit()) => {}
        _ => level.now += 1,
    }
}

#[cfg(test)]
mod tests;
