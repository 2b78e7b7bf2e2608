//! The text of a scene after `--set` and with its parts, and where each byte of it came from.

use super::diagnostic::TextFile;
use super::syntax::Span;
use std::sync::Arc;

/// A scene's text: what its file holds, with the values of `--set` and the files of parts in their places.
#[derive(Clone, Debug)]
pub struct Source {
    /// All that the text is made of, with the names that messages show: the file first, then each `--set`, then the
    /// files of parts.
    pub texts: Vec<Arc<TextFile>>,
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
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Origin {
    /// The number of the text in [`Source::texts`].
    text: usize,
    /// From this byte of it on.
    at: usize,
    /// Put in for what stands at that byte: all of the stretch stands for that one place.
    put_in: bool,
}

/// Bytes of one of the texts.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TextSpan {
    /// The number of the text in [`Source::texts`]: 0 for the file, n for the n-th `--set`.
    pub text: usize,
    /// The bytes in it.
    pub span: Span,
}

/// Stretches of text with where they came from.
pub type Stretches = Vec<(String, Origin)>;

impl Source {
    /// The text of a file as it is.
    pub fn new(name: impl Into<String>, file: impl Into<String>, sets: &[String]) -> Self {
        let named = |name: String, text: String| Arc::new(TextFile { name, text });
        let file = file.into();
        let mut texts = vec![named(name.into(), file.clone())];
        texts.extend(sets.iter().map(|set| named("--set".into(), set.clone())));
        Self { texts, ..Self::of(0, file) }
    }

    /// A text that is to be put into another one, in which it has a number.
    pub fn of(number: usize, text: impl Into<String>) -> Self {
        let text = text.into();
        let pieces = vec![Piece { length: text.len(), from: Origin::of(number, 0) }];
        Self { texts: Vec::new(), text, pieces }
    }

    /// A text made of stretches of others.
    pub fn made_of(stretches: &Stretches) -> Self {
        let piece = |(text, from): &(String, Origin)| Piece { length: text.len(), from: *from };
        let text = stretches.iter().map(|(text, _)| text.as_str()).collect();
        Self { texts: Vec::new(), text, pieces: stretches.iter().map(piece).collect() }
    }

    /// The text with all that was put in so far.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Puts something in the place of a stretch of the text.
    pub fn replace(&mut self, span: Span, parts: &[(&str, Origin)]) {
        let mut pieces = Vec::with_capacity(self.pieces.len() + parts.len() + 1);
        let mut start = 0;
        let mut put = false;
        let new: Vec<Piece> = parts.iter().map(|(text, from)| Piece { length: text.len(), from: *from }).collect();
        for piece in &self.pieces {
            let end = start + piece.length;
            if start < span.start {
                pieces.push(Piece { length: end.min(span.start) - start, from: piece.from });
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

    /// What a stretch of the text is made of.
    pub fn stretches(&self, span: &Span) -> Stretches {
        let mut start = 0;
        let mut found = Vec::new();
        for piece in &self.pieces {
            let end = start + piece.length;
            let (from, to) = (start.max(span.start), end.min(span.end));
            if from < to {
                found.push((self.text[from..to].to_string(), piece.from.forward(from - start)));
            }
            start = end;
        }
        found
    }

    /// Where a stretch of the text came from; cut off where it leaves the text it begins in.
    pub fn place(&self, span: &Span) -> TextSpan {
        let mut start = 0;
        let mut found = TextSpan { text: 0, span: 0..0 };
        for (i, piece) in self.pieces.iter().enumerate() {
            let end = start + piece.length;
            if span.start < end || i + 1 == self.pieces.len() {
                let first = piece.from.forward(span.start.min(end) - start);
                let last = self.locate_end(span, first.text).unwrap_or(piece.from.forward(piece.length).at);
                found = TextSpan { text: first.text, span: first.at..last.max(first.at) };
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
                let from = piece.from.forward(span.end - start);
                return (from.text == wanted).then_some(from.at);
            }
            start = end;
        }
        None
    }
}

impl Origin {
    /// The text of that number, from this byte on.
    pub fn of(text: usize, at: usize) -> Self {
        Self { text, at, put_in: false }
    }

    /// Something put in for what stands at that byte of the text of that number.
    pub fn put_in(text: usize, at: usize) -> Self {
        Self { text, at, put_in: true }
    }

    fn forward(self, bytes: usize) -> Self {
        Self { at: if self.put_in { self.at } else { self.at + bytes }, ..self }
    }
}

#[cfg(test)]
mod tests;
