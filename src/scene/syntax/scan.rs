//! Steps through a RON text: blanks and comments, words, texts and numbers.

use super::Span;

/// A place in a text.
pub(super) struct Scan<'a> {
    pub(super) text: &'a str,
    pub(super) at: usize,
}

/// A text or comment that never ends: where it began.
pub(super) struct Endless(pub(super) Span, pub(super) &'static str);

pub(super) fn starts_word(c: char) -> bool {
    c.is_alphabetic() || c == '_'
}

pub(super) fn in_word(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}

impl<'a> Scan<'a> {
    pub(super) fn rest(&self) -> &'a str {
        &self.text[self.at..]
    }

    pub(super) fn peek(&self) -> Option<char> {
        self.rest().chars().next()
    }

    /// The next character as a span; an empty one at the end of the text.
    pub(super) fn here(&self) -> Span {
        self.at..self.at + self.peek().map_or(0, char::len_utf8)
    }

    pub(super) fn eat(&mut self, c: char) -> bool {
        let found = self.peek() == Some(c);
        if found {
            self.at += c.len_utf8();
        }
        found
    }

    fn skip_while(&mut self, keep: impl Fn(char) -> bool) {
        let rest = self.rest();
        self.at += rest.find(|c| !keep(c)).unwrap_or(rest.len());
    }

    /// Skips blanks and comments; block comments may be nested.
    pub(super) fn blanks(&mut self) -> Result<(), Endless> {
        loop {
            // the byte order mark is what some editors put first
            self.skip_while(|c| c.is_whitespace() || c == '\u{feff}');
            if self.rest().starts_with("//") {
                self.skip_while(|c| c != '\n');
            } else if self.rest().starts_with("/*") {
                self.block_comment()?;
            } else {
                return Ok(());
            }
        }
    }

    fn block_comment(&mut self) -> Result<(), Endless> {
        let start = self.at;
        let mut depth = 0;
        loop {
            let rest = self.rest();
            let Some(next) = rest.find(['/', '*']) else {
                self.at = self.text.len();
                return Err(Endless(start..start + 2, "this comment has no end; close it with */"));
            };
            self.at += next;
            if self.rest().starts_with("/*") {
                depth += 1;
                self.at += 2;
            } else if self.rest().starts_with("*/") {
                depth -= 1;
                self.at += 2;
                if depth == 0 {
                    return Ok(());
                }
            } else {
                self.at += 1;
            }
        }
    }

    pub(super) fn word(&mut self) -> Option<Span> {
        let start = self.at;
        if self.rest().starts_with("r#") {
            self.at += 2;
        }
        if self.peek().is_some_and(starts_word) {
            self.skip_while(in_word);
            Some(start..self.at)
        } else {
            self.at = start;
            None
        }
    }

    /// All that could belong to a number, suffix included.
    pub(super) fn number(&mut self) -> Span {
        let start = self.at;
        let mut before = ' ';
        while let Some(c) = self.peek() {
            // a sign inside belongs to an exponent only
            let sign = (c == '-' || c == '+') && (self.at == start || matches!(before, 'e' | 'E'));
            if !(sign || in_word(c) || c == '.') {
                break;
            }
            before = c;
            self.at += c.len_utf8();
        }
        start..self.at
    }

    /// Whether a text, a character or bytes begin here: `"`, `r"`, `r#"`, `b"`, `br"`, `'`, `b'`.
    pub(super) fn quoted_ahead(&self) -> bool {
        let rest = self.rest();
        let rest = rest.strip_prefix('b').unwrap_or(rest);
        rest.starts_with(['"', '\''])
            || rest.strip_prefix('r').is_some_and(|raw| raw.trim_start_matches('#').starts_with('"'))
    }

    /// Skips what [`Self::quoted_ahead`] saw.
    pub(super) fn quoted(&mut self) -> Result<Span, Endless> {
        let start = self.at;
        self.eat('b');
        let raw = self.eat('r');
        let hashes = self.rest().len() - self.rest().trim_start_matches('#').len();
        self.at += hashes;
        let quote = self.peek().unwrap_or('"');
        let opened = start..self.at + quote.len_utf8();
        self.at = opened.end;
        let endless = Endless(opened, "this text has no end; close it with a quotation mark");
        if raw {
            let end = format!("\"{}", "#".repeat(hashes));
            let length = self.rest().find(&end).ok_or(endless)?;
            self.at += length + end.len();
            return Ok(start..self.at);
        }
        loop {
            match self.peek() {
                None => return Err(endless),
                Some('\\') => {
                    self.at += 1;
                    self.at += self.peek().map_or(0, char::len_utf8);
                }
                Some(c) => {
                    self.at += c.len_utf8();
                    if c == quote {
                        return Ok(start..self.at);
                    }
                }
            }
        }
    }
}
