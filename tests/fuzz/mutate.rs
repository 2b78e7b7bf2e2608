//! From sound files to hostile ones: bytes, numbers, words and brackets are changed, and files are mixed.

use fastrand::Rng;

/// No input grows beyond this (bytes).
const LONGEST: usize = 1 << 16;

/// Numbers that programs trip over.
const NUMBERS: [&str; 27] = [
    "0",
    "-0",
    "1",
    "-1",
    "2",
    "3",
    "1e308",
    "-1e308",
    "1e309",
    "5e-324",
    "1e-30",
    "1e30",
    "3.5e38",
    "1e18",
    "1e12",
    "NaN",
    "inf",
    "-inf",
    "255",
    "65536",
    "2147483648",
    "4294967295",
    "4294967296",
    "9223372036854775808",
    "18446744073709551615",
    "18446744073709551616",
    "0x7fffffff",
];

/// Brackets and what they are closed with.
const BRACKETS: [(&str, &str); 9] = [
    ("(", ")"),
    ("[", "]"),
    ("{", "}"),
    ("Not(", ")"),
    ("And([", "])"),
    ("Some(", ")"),
    ("/*", "*/"),
    ("<a>", "</a>"),
    ("-", ""),
];

/// A hostile file: one of the corpus, changed.
pub fn mutant(rng: &mut Rng, corpus: &[Vec<u8>]) -> Vec<u8> {
    let mut bytes = rng.choice(corpus).cloned().unwrap_or_default();
    let changes = 1 + (0..6).take_while(|_| rng.bool()).count();
    for _ in 0..changes {
        change(rng, &mut bytes, corpus);
        bytes.truncate(LONGEST);
    }
    bytes
}

fn change(rng: &mut Rng, bytes: &mut Vec<u8>, corpus: &[Vec<u8>]) {
    let (start, end) = stretch(rng, bytes.len());
    match rng.u8(0..17) {
        0 => at(rng, bytes, |rng, byte| *byte ^= 1 << rng.u8(0..8)),
        1 => at(rng, bytes, |rng, byte| *byte = rng.u8(..)),
        2 => at(rng, bytes, |rng, byte| *byte = *rng.choice(b"()[]{}<>:,;\"'/*-+.0e$#=_ \n\0").unwrap_or(&0)),
        3 => bytes.truncate(end),
        4 => drop(bytes.drain(start..end)),
        5 => {
            let piece = bytes[start..end].repeat(rng.usize(1..40));
            bytes.splice(end..end, piece);
        }
        6 => {
            let other = rng.choice(corpus).map_or(&[][..], Vec::as_slice);
            let (from, to) = stretch(rng, other.len());
            bytes.splice(start..end, other[from..to].iter().copied());
        }
        7..=9 => replace_number(rng, bytes),
        10 => words(rng, bytes, |rng, words, places| {
            let (a, b) = (*rng.choice(places)?, *rng.choice(places)?);
            words.swap(a, b);
            Some(())
        }),
        11 => words(rng, bytes, |rng, words, places| {
            words[*rng.choice(places)?].clear();
            Some(())
        }),
        12 => words(rng, bytes, |rng, words, places| {
            let (a, b) = (*rng.choice(places)?, *rng.choice(places)?);
            words[a] = words[b].clone();
            Some(())
        }),
        13 => {
            let ((open, close), times) = (*rng.choice(BRACKETS.iter()).unwrap_or(&BRACKETS[0]), rng.usize(1..300));
            bytes.splice(end..end, close.repeat(times).into_bytes());
            bytes.splice(start..start, open.repeat(times).into_bytes());
        }
        14 => lines(rng, bytes),
        15 => binary_number(rng, bytes),
        _ => {
            // a word of another file in the place of one
            let other = rng.choice(corpus).map_or(&[][..], Vec::as_slice);
            let foreign = split(other);
            words(rng, bytes, |rng, words, places| {
                words[*rng.choice(places)?] = rng.choice(&foreign)?.clone();
                Some(())
            });
        }
    }
}

/// A stretch of a text, mostly a short one.
fn stretch(rng: &mut Rng, length: usize) -> (usize, usize) {
    let start = rng.usize(0..=length);
    let most = if rng.u8(0..4) == 0 { length - start } else { (length - start).min(40) };
    (start, start + rng.usize(0..=most))
}

fn at(rng: &mut Rng, bytes: &mut [u8], change: impl FnOnce(&mut Rng, &mut u8)) {
    if !bytes.is_empty() {
        let place = rng.usize(0..bytes.len());
        change(rng, &mut bytes[place]);
    }
}

/// Puts a number that programs trip over in the place of one that is written as text.
fn replace_number(rng: &mut Rng, bytes: &mut Vec<u8>) {
    let begins = |i: usize| {
        bytes[i].is_ascii_digit() && (i == 0 || !bytes[i - 1].is_ascii_alphanumeric() && bytes[i - 1] != b'.')
    };
    let starts: Vec<usize> = (0..bytes.len()).filter(|&i| begins(i)).collect();
    let Some(&start) = rng.choice(&starts) else { return };
    let is_part = |&byte: &u8| byte.is_ascii_alphanumeric() || byte == b'.';
    let end = start + bytes[start..].iter().take_while(|byte| is_part(byte)).count();
    let number = match rng.u8(0..12) {
        0 => "9".repeat(rng.usize(1..2000)),
        1 => format!("0.{}1", "0".repeat(rng.usize(1..500))),
        2 | 3 => rng.u32(0..20).to_string(),
        4 => format!("{:e}", rng.f64() * 10_f64.powi(rng.i32(-40..40))),
        _ => rng.choice(NUMBERS.iter()).unwrap_or(&"0").to_string(),
    };
    bytes.splice(start..end, number.into_bytes());
}

/// Puts an integer that programs trip over where a binary one may stand.
fn binary_number(rng: &mut Rng, bytes: &mut [u8]) {
    let value =
        *rng.choice(&[0, 1, u64::MAX, 1 << 31, u64::from(u32::MAX), 1 << 32, 1 << 60, 1_000_000_000_000]).unwrap_or(&0);
    let mut eight = if rng.bool() { value.to_le_bytes() } else { value.to_be_bytes() };
    if rng.bool() {
        eight.rotate_left(4);
    }
    let width = *rng.choice(&[1, 2, 4, 8]).unwrap_or(&8);
    if let Some(last) = bytes.len().checked_sub(width) {
        let start = rng.usize(0..=last);
        bytes[start..start + width].copy_from_slice(&eight[..width]);
    }
}

/// Words, and what stands between them.
fn split(bytes: &[u8]) -> Vec<Vec<u8>> {
    let is_word = |byte: u8| byte.is_ascii_alphanumeric() || matches!(byte, b'_' | b'.' | b'-');
    bytes.chunk_by(|&a, &b| is_word(a) == is_word(b)).map(<[u8]>::to_vec).collect()
}

/// Changes the words of a text.
fn words(rng: &mut Rng, bytes: &mut Vec<u8>, change: impl FnOnce(&mut Rng, &mut [Vec<u8>], &[usize]) -> Option<()>) {
    let mut parts = split(bytes);
    let places: Vec<usize> = (0..parts.len()).filter(|&i| parts[i].iter().any(u8::is_ascii_alphanumeric)).collect();
    if change(rng, &mut parts, &places).is_some() {
        *bytes = parts.concat();
    }
}

/// Doubles, drops or moves a line.
fn lines(rng: &mut Rng, bytes: &mut Vec<u8>) {
    let mut lines: Vec<Vec<u8>> = bytes.split_inclusive(|&byte| byte == b'\n').map(<[u8]>::to_vec).collect();
    if lines.is_empty() {
        return;
    }
    let (from, to) = (rng.usize(0..lines.len()), rng.usize(0..lines.len()));
    match rng.u8(0..3) {
        0 => lines.insert(to, lines[from].clone()),
        1 => drop(lines.remove(from)),
        _ => lines.swap(from, to),
    }
    *bytes = lines.concat();
}
