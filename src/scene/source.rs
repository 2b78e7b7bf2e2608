//! The text of a scene after `--set`, and where each byte of it came from.

use super::syntax::Span;

/// A scene's text: what the file holds, with the values of `--set` in their places.
#[derive(Clone, Debug)]
pub struct Source {
    /// The name of the file, as messages show it.
    pub name: String,
    /// What the file holds.
    pub file: String,
    /// The `path=value` of each `--set`.
    pub sets: Vec<String>,
    text: String,
    pieces: Vec<Piece>,
}

/// A stretch of the text.
#[derive(Clone, Debug)]
struct Piece {
    length: usize,
    from: Origin,
}

/// Where a stretch of the text came from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Origin {
    /// The file, from this byte on.
    File(usize),
    /// The `--set` of that number, from this byte of its argument on.
    Set(usize, usize),
    /// Punctuation put in for the `--set` of that number; stands for this byte of its argument.
    Glue(usize, usize),
}

/// Bytes of the file (0) or of the `--set` number n - 1 (n).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    /// 0 for the file, n for the n-th `--set`.
    pub text: usize,
    /// The bytes in it.
    pub span: Span,
}

impl Source {
    /// A text as it is.
    pub fn new(name: impl Into<String>, file: impl Into<String>, sets: &[String]) -> Self {
        let file = file.into();
        let pieces = vec![Piece { length: file.len(), from: Origin::File(0) }];
        Self { name: name.into(), text: file.clone(), file, sets: sets.to_vec(), pieces }
    }

    /// The text with the values of all `--set` so far.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Puts something in the place of a stretch of the text.
    pub fn replace(&mut self, span: Span, parts: &[(&str, Origin)]) {
        let mut pieces = Vec::with_capacity(self.pieces.len() + parts.len() + 1);
        let mut start = 0;
        let mut put = false;
        let new: Vec<Piece> =
            parts.iter().map(|(text, from)| Piece { length: text.len(), from: from.clone() }).collect();
        for piece in &self.pieces {
            let end = start + piece.length;
            if start < span.start {
                pieces.push(Piece { length: end.min(span.start) - start, from: piece.from.clone() });
            }
            if !put && span.start <= end {
                pieces.extend(new.iter().cloned());
                put = true;
            }
            if end > span.end {
                let skipped = span.end.max(start) - start;
                pieces.push(Piece { length: piece.length - skipped, from: piece.from.forward(skipped) });
            }
            start = end;
        }
        pieces.retain(|piece| piece.length > 0);
        self.pieces = pieces;
        let inserted: String = parts.iter().map(|(text, _)| *text).collect();
        self.text.replace_range(span, &inserted);
    }

    /// Where a stretch of the text came from; cut off where it leaves the file or `--set` it begins in.
    pub fn place(&self, span: &Span) -> Place {
        let mut start = 0;
        let mut found = Place { text: 0, span: 0..0 };
        for (i, piece) in self.pieces.iter().enumerate() {
            let end = start + piece.length;
            if span.start < end || i + 1 == self.pieces.len() {
                let (text, first) = piece.from.locate(span.start.min(end) - start);
                let last = self.locate_end(span, text).unwrap_or(piece.from.locate(piece.length).1);
                found = Place { text, span: first..last.max(first) };
                break;
            }
            start = end;
        }
        found
    }

    /// The end of a stretch, when it lies in the text it began in.
    fn locate_end(&self, span: &Span, wanted: usize) -> Option<usize> {
        let mut start = 0;
        for piece in &self.pieces {
            let end = start + piece.length;
            // the end belongs to the piece before it: the bytes after it may come from elsewhere
            if span.end <= end {
                let (text, at) = piece.from.locate(span.end - start);
                return (text == wanted).then_some(at);
            }
            start = end;
        }
        None
    }
}

impl Origin {
    fn forward(&self, bytes: usize) -> Self {
        match self {
            Origin::File(at) => Origin::File(at + bytes),
            Origin::Set(set, at) => Origin::Set(*set, at + bytes),
            Origin::Glue(..) => self.clone(),
        }
    }

    fn locate(&self, offset: usize) -> (usize, usize) {
        match self.forward(offset) {
            Origin::File(at) => (0, at),
            Origin::Set(set, at) | Origin::Glue(set, at) => (set + 1, at),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_know_where_they_came_from() {
        let mut source = Source::new("a.ron", "(a: 1, b: 2)", &["a=777".into()]);
        source.replace(4..5, &[("777", Origin::Set(0, 2))]);
        assert_eq!(source.text(), "(a: 777, b: 2)");
        assert_eq!(source.place(&(4..7)), Place { text: 1, span: 2..5 });
        assert_eq!(source.place(&(12..13)), Place { text: 0, span: 10..11 });
        // a span that holds a replaced value reaches around it
        assert_eq!(source.place(&(0..14)), Place { text: 0, span: 0..12 });
        source.replace(5..6, &[("", Origin::Set(0, 0))]);
        assert_eq!(source.text(), "(a: 77, b: 2)");
        assert_eq!(source.place(&(5..6)), Place { text: 1, span: 4..5 });
    }
}
