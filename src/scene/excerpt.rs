//! The lines of a text that are shown below a mistake; of long ones only what is around the places that are marked.

use codespan_reporting::diagnostic::Label;
use codespan_reporting::files::{Error, Files};
use std::ops::Range;

/// Bytes of a line that are shown.
const WIDTH: usize = 120;
/// Bytes around each of many places on a line, at least.
const AROUND: usize = 24;
/// Stands for what is left out.
const LEFT_OUT: &str = "…";

/// Texts by number, as far as the labels of one mistake need them.
pub struct Excerpts<'t>(Vec<Option<Excerpt<'t>>>);

/// The lines of a text from the first to the last place that is marked.
struct Excerpt<'t> {
    name: &'t str,
    text: &'t str,
    shown: String,
    /// The number of the first line, from 0.
    first: usize,
    /// Where each line begins in `shown`.
    lines: Vec<usize>,
    /// What of the text is shown, in order.
    pieces: Vec<Piece>,
}

/// Bytes of a text, and where they begin in what is shown.
struct Piece {
    from: Range<usize>,
    at: usize,
}

impl<'t> Excerpts<'t> {
    /// Of texts with their names; labels are moved to where their places are in what is shown.
    pub fn of(texts: &[(&'t str, &'t str)], labels: &mut [Label<usize>]) -> Self {
        let excerpt = |(number, (name, text)): (usize, &(&'t str, &'t str))| {
            let mut ranges = labels.iter().filter(|label| label.file_id == number).map(|label| label.range.clone());
            let first = ranges.next()?;
            Some(Excerpt::new(name, text, &ranges.fold(vec![first], |all, range| [all, vec![range]].concat())))
        };
        let excerpts = Self(texts.iter().enumerate().map(excerpt).collect());
        for label in labels {
            if let Ok(excerpt) = excerpts.get(label.file_id) {
                label.range = excerpt.shown_at(label.range.start)..excerpt.shown_at(label.range.end);
            }
        }
        excerpts
    }

    fn get(&self, number: usize) -> Result<&Excerpt<'t>, Error> {
        self.0.get(number).and_then(Option::as_ref).ok_or(Error::FileMissing)
    }
}

impl<'t> Excerpt<'t> {
    fn new(name: &'t str, text: &'t str, marked: &[Range<usize>]) -> Self {
        let start = marked.iter().map(|range| text.floor_char_boundary(range.start)).min().unwrap_or(0);
        let end = marked.iter().map(|range| text.floor_char_boundary(range.end)).max().unwrap_or(0).max(start);
        let start = text[..start].rfind('\n').map_or(0, |before| before + 1);
        let end = text[end..].find('\n').map_or(text.len(), |more| end + more);
        let first = text[..start].matches('\n').count();
        let mut excerpt = Self { name, text, shown: String::new(), first, lines: Vec::new(), pieces: Vec::new() };
        let mut from = start;
        for line in text[start..end].split('\n') {
            excerpt.add(from..from + line.len(), marked);
            from += line.len() + 1;
        }
        excerpt
    }

    /// Adds a line, given without its break.
    fn add(&mut self, line: Range<usize>, marked: &[Range<usize>]) {
        if !self.lines.is_empty() {
            self.shown.push('\n');
        }
        self.lines.push(self.shown.len());
        let mut last = line.start;
        for window in windows(self.text, &line, marked) {
            if window.start > last {
                self.shown.push_str(LEFT_OUT);
            }
            last = window.end;
            self.pieces.push(Piece { from: window.clone(), at: self.shown.len() });
            self.shown.push_str(&self.text[window]);
        }
        if last < line.end {
            self.shown.push_str(LEFT_OUT);
        }
    }

    /// Where a byte of the text is in what is shown; what is left out is where it was cut.
    fn shown_at(&self, byte: usize) -> usize {
        let place = self.pieces.partition_point(|piece| piece.from.start <= byte);
        let Some(piece) = place.checked_sub(1).map(|place| &self.pieces[place]) else { return 0 };
        piece.at + byte.min(piece.from.end) - piece.from.start
    }

    /// The byte of the text that is shown at a place.
    fn byte_of(&self, shown: usize) -> usize {
        let place = self.pieces.partition_point(|piece| piece.at <= shown);
        let Some(piece) = place.checked_sub(1).map(|place| &self.pieces[place]) else { return 0 };
        (piece.from.start + shown - piece.at).min(piece.from.end)
    }
}

/// What of a line is shown, in order: all of a short one, and what is around each place in a long one.
fn windows(text: &str, line: &Range<usize>, marked: &[Range<usize>]) -> Vec<Range<usize>> {
    if line.len() <= WIDTH {
        return vec![line.clone()];
    }
    let clipped = |range: &Range<usize>| range.start.max(line.start)..range.end.min(line.end);
    let here = |range: &&Range<usize>| range.start <= line.end && range.end >= line.start;
    let mut places: Vec<Range<usize>> = marked.iter().filter(here).map(clipped).collect();
    if places.is_empty() {
        places.push(line.start..line.start);
    }
    places.sort_by_key(|place| place.start);
    let share = (WIDTH / places.len()).max(AROUND);
    let mut windows: Vec<Range<usize>> = Vec::new();
    for place in places {
        // of a long place its beginning is shown
        let before = (share - place.len().min(2 * share / 3)) / 2;
        let start = place.start.saturating_sub(before).min(line.end.saturating_sub(share)).max(line.start);
        let end = (start + share).min(line.end);
        let window = text.floor_char_boundary(start)..text.ceil_char_boundary(end);
        match windows.last_mut() {
            // as short as what would stand for what is left out
            Some(last) if window.start <= last.end + LEFT_OUT.len() => last.end = last.end.max(window.end),
            _ => windows.push(window),
        }
    }
    windows
}

impl<'a> Files<'a> for Excerpts<'_> {
    type FileId = usize;
    type Name = &'a str;
    type Source = &'a str;

    fn name(&'a self, number: usize) -> Result<&'a str, Error> {
        Ok(self.get(number)?.name)
    }

    fn source(&'a self, number: usize) -> Result<&'a str, Error> {
        Ok(&self.get(number)?.shown)
    }

    fn line_index(&'a self, number: usize, byte: usize) -> Result<usize, Error> {
        let lines = &self.get(number)?.lines;
        Ok(lines.partition_point(|start| *start <= byte).saturating_sub(1))
    }

    /// That of the file.
    fn line_number(&'a self, number: usize, line: usize) -> Result<usize, Error> {
        Ok(self.get(number)?.first + line + 1)
    }

    /// That of the file.
    fn column_number(&'a self, number: usize, _line: usize, byte: usize) -> Result<usize, Error> {
        let excerpt = self.get(number)?;
        let given = excerpt.byte_of(byte);
        let before = excerpt.text.get(..given).ok_or(Error::InvalidCharBoundary { given })?;
        Ok(before.chars().rev().take_while(|c| *c != '\n').count() + 1)
    }

    fn line_range(&'a self, number: usize, line: usize) -> Result<Range<usize>, Error> {
        let Excerpt { lines, shown, .. } = self.get(number)?;
        let start = lines.get(line).ok_or(Error::LineTooLarge { given: line, max: lines.len().saturating_sub(1) })?;
        Ok(*start..lines.get(line + 1).copied().unwrap_or(shown.len()))
    }
}

#[cfg(test)]
mod tests;
