//! A place in a file's bytes that moves on as words and binary numbers are read, and knows where it is.

use crate::FilePosition;
use crate::read::Fault;
use std::str::FromStr;

/// How numbers are written from here on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[doc(hidden)]
pub enum Form {
    /// As words.
    Text,
    /// As bytes, the least significant first.
    LittleEndian,
    /// As bytes, the most significant first.
    BigEndian,
}

/// A place in a file.
#[doc(hidden)]
pub struct Cursor<'a> {
    bytes: &'a [u8],
    at: usize,
    /// Where what was read last begins: faults are reported there.
    last: usize,
    /// How numbers are written.
    pub form: Form,
}

const CUT_SHORT: &str = "the file may have been cut short";

impl<'a> Cursor<'a> {
    /// At a byte of a file.
    pub fn new(bytes: &'a [u8], at: usize) -> Self {
        Cursor { bytes, at, last: at, form: Form::Text }
    }

    /// A fault where the cursor last read.
    pub fn fault(&self, what: impl Into<String>, allowed: impl Into<String>) -> Fault {
        Fault { at: self.place(), what: what.into(), allowed: allowed.into() }
    }

    fn place(&self) -> FilePosition {
        match self.form {
            Form::Text => FilePosition::Line(1 + self.bytes[..self.last].iter().filter(|&&byte| byte == b'\n').count()),
            _ => FilePosition::Byte(self.last),
        }
    }

    /// All bytes of the file.
    pub fn bytes(&self) -> &'a [u8] {
        self.bytes
    }

    /// How many bytes lie behind.
    pub fn at(&self) -> usize {
        self.at
    }

    /// Moves before the line break that was read last.
    pub fn step_back(&mut self) {
        self.at = self.at.saturating_sub(1);
    }

    fn rest(&self) -> &'a [u8] {
        &self.bytes[self.at..]
    }

    /// The next word, or nothing at the end of the file.
    pub fn try_word(&mut self) -> Option<&'a [u8]> {
        let start = self.rest().iter().position(|byte| !byte.is_ascii_whitespace())?;
        self.at += start;
        self.last = self.at;
        let word = self.rest();
        let end = word.iter().position(u8::is_ascii_whitespace).unwrap_or(word.len());
        self.at += end;
        Some(&word[..end])
    }

    /// The next word, which is expected to be `what`.
    pub fn word(&mut self, what: &str) -> Result<&'a [u8], Fault> {
        self.last = self.at;
        self.try_word().ok_or_else(|| self.fault(format!("the file ends where {what} should be"), CUT_SHORT))
    }

    /// The next word as text.
    pub fn name(&mut self, what: &str) -> Result<String, Fault> {
        Ok(String::from_utf8_lossy(self.word(what)?).into_owned())
    }

    /// The rest of the line, trimmed; nothing at the end of the file.
    pub fn try_line(&mut self) -> Option<String> {
        let rest = self.rest();
        if rest.is_empty() {
            return None;
        }
        self.last = self.at;
        let end = rest.iter().position(|&byte| byte == b'\n').unwrap_or(rest.len());
        self.at += (end + 1).min(rest.len());
        Some(String::from_utf8_lossy(&rest[..end]).trim().to_string())
    }

    /// The next word as a number.
    pub fn number<T: FromStr>(&mut self, what: &str) -> Result<T, Fault> {
        let word = self.word(what)?;
        std::str::from_utf8(word).ok().and_then(|text| text.parse().ok()).ok_or_else(|| {
            let found = String::from_utf8_lossy(&word[..word.len().min(40)]);
            self.fault(format!("`{found}` where {what} should be"), "a number is needed here")
        })
    }

    /// The next bytes.
    pub fn take(&mut self, count: usize, what: &str) -> Result<&'a [u8], Fault> {
        self.last = self.at;
        let bytes = self.rest().get(..count);
        let bytes = bytes.ok_or_else(|| {
            let what = format!("{what}: {count} bytes are needed, {} are left", self.rest().len());
            self.fault(what, CUT_SHORT)
        })?;
        self.at += count;
        Ok(bytes)
    }

    fn array<const N: usize>(&mut self, what: &str) -> Result<[u8; N], Fault> {
        let mut array = [0; N];
        array.copy_from_slice(self.take(N, what)?);
        if self.form == Form::BigEndian {
            array.reverse();
        }
        Ok(array)
    }

    /// A 32-bit integer, or a word.
    pub fn int(&mut self, what: &str) -> Result<i32, Fault> {
        if self.form == Form::Text { self.number(what) } else { Ok(i32::from_le_bytes(self.array(what)?)) }
    }

    /// An unsigned integer of `width` bytes (4, else 8), or a word.
    pub fn size(&mut self, width: usize, what: &str) -> Result<u64, Fault> {
        match self.form {
            Form::Text => self.number(what),
            _ if width == 4 => Ok(u64::from(u32::from_le_bytes(self.array(what)?))),
            _ => Ok(u64::from_le_bytes(self.array(what)?)),
        }
    }

    /// A 64-bit number, or a word.
    pub fn double(&mut self, what: &str) -> Result<f64, Fault> {
        if self.form == Form::Text { self.number(what) } else { Ok(f64::from_le_bytes(self.array(what)?)) }
    }

    /// A claimed count as a size, if so many things of at least `bytes_each` can still follow: nothing is allocated for
    /// counts that the file cannot hold.
    pub fn claim(&self, count: u64, bytes_each: usize, what: &str) -> Result<usize, Fault> {
        let most = self.rest().len() / bytes_each.max(1) + 1;
        match usize::try_from(count) {
            Ok(count) if count <= most => Ok(count),
            _ => {
                let what = format!("{count} {what} are claimed, {} bytes follow", self.rest().len());
                Err(self.fault(what, "the count must fit the file, which may have been cut short"))
            }
        }
    }

    /// A count that must not be negative, claimed as [`Cursor::claim`] does.
    pub fn count(&mut self, bytes_each: usize, what: &str) -> Result<usize, Fault> {
        let count: u64 = self.number(&format!("the number of {what}"))?;
        self.claim(count, bytes_each, what)
    }

    /// Moves behind the next occurrence of `end`, if there is one.
    pub fn skip_behind(&mut self, end: &str) -> bool {
        let found = self.rest().windows(end.len()).position(|window| window == end.as_bytes());
        if let Some(found) = found {
            self.at += found + end.len();
        }
        found.is_some()
    }

    /// Moves behind one line break, if there is one here.
    pub fn skip_line_break(&mut self) {
        if self.rest().starts_with(b"\r\n") {
            self.at += 2;
        } else if self.rest().starts_with(b"\n") {
            self.at += 1;
        }
    }

    /// Reads the word that must stand here.
    pub fn expect(&mut self, expected: &str, allowed: &str) -> Result<(), Fault> {
        let form = std::mem::replace(&mut self.form, Form::Text);
        let found = self.word(expected)?;
        if !found.eq_ignore_ascii_case(expected.as_bytes()) {
            let found = String::from_utf8_lossy(&found[..found.len().min(40)]);
            return Err(self.fault(format!("`{found}` where {expected} should be"), allowed));
        }
        self.form = form;
        Ok(())
    }
}
