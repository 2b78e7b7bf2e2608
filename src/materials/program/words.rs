//! WGSL text word by word, as far as is needed to change words and to find what a text declares.

use std::ops::Range;

/// Words, numbers, comments and single other characters, one after the other; together the whole text.
pub(crate) fn words(text: &str) -> impl Iterator<Item = Range<usize>> + '_ {
    let mut at = 0;
    std::iter::from_fn(move || {
        let start = at;
        at += token(&text[start..]);
        (start < at).then_some(start..at)
    })
}

/// Whether a word is a name or a word of the language.
pub(crate) fn is_name(word: &str) -> bool {
    word.starts_with(|c: char| c.is_alphabetic() || c == '_')
}

/// Length of the first token: a word, a number, a comment, or one other character.
fn token(text: &str) -> usize {
    let word = |c: char| c.is_alphanumeric() || c == '_';
    let mut characters = text.chars();
    let (first, second) = (characters.next(), characters.next());
    match first {
        Some('/') if second == Some('/') => text.find('\n').unwrap_or(text.len()),
        Some('/') if second == Some('*') => block_comment(text),
        Some(c) if c.is_ascii_digit() || (c == '.' && second.is_some_and(|c| c.is_ascii_digit())) => number(text),
        Some(c) if word(c) => text.find(|c| !word(c)).unwrap_or(text.len()),
        Some(c) => c.len_utf8(),
        None => 0,
    }
}

/// Block comments may stand within each other.
fn block_comment(text: &str) -> usize {
    let (mut depth, mut at) = (0, 0);
    while at < text.len() {
        if text[at..].starts_with("/*") {
            (depth, at) = (depth + 1, at + 2);
        } else if text[at..].starts_with("*/") {
            (depth, at) = (depth - 1, at + 2);
            if depth == 0 {
                return at;
            }
        } else {
            at += text[at..].chars().next().map_or(1, char::len_utf8);
        }
    }
    text.len()
}

fn number(text: &str) -> usize {
    let bytes = text.as_bytes();
    let hexadecimal = text.starts_with("0x") || text.starts_with("0X");
    let mut at = 0;
    while at < bytes.len() {
        let exponent = matches!(bytes[at], b'e' | b'E') && !hexadecimal || matches!(bytes[at], b'p' | b'P');
        let sign = exponent && matches!(bytes.get(at + 1), Some(b'+' | b'-'));
        match bytes[at] {
            b'.' => at += 1,
            c if c.is_ascii_alphanumeric() => at += if sign { 2 } else { 1 },
            _ => break,
        }
    }
    at
}
