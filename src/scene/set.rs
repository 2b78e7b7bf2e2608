//! `--set path=value`: puts a value into the text of a scene, in the place of the one that stands there or as a new
//! field.

use super::check::{wants_maps, wants_text};
use super::diagnostic::Diagnostic;
use super::limits::SET_BYTES;
use super::parts::merged;
use super::schema::Scene;
use super::source::{Origin, Source};
use super::suggest::choice;
use super::syntax::{Kind, Lost, Node, Path, Segment, Span, Tree, parse};

/// Puts in the value of one `--set`.
///
/// # Errors
/// Why it cannot be put in: a path that leads nowhere, a value that is not RON.
pub fn apply(source: &mut Source, view: &View, (number, argument): (usize, &str)) -> Result<(), Box<Diagnostic>> {
    if argument.len() > SET_BYTES {
        let begin: String = argument.chars().take(40).collect();
        let message = format!("--set {begin}...: {} bytes; at most {SET_BYTES} are allowed", argument.len());
        let mut diagnostic = Diagnostic::error(None, message);
        diagnostic.note("long values belong into the scene file");
        return Err(Box::new(diagnostic));
    }
    let fail = |message: String| Box::new(Diagnostic::error(None, format!("--set {argument}: {message}")));
    let (path, value) = argument.split_once('=').ok_or_else(|| {
        let mut diagnostic = fail("a value is missing".to_string());
        diagnostic.note("expected path=value, such as materials.tissue.density=1060");
        diagnostic
    })?;
    let value_at = path.len() + 1 + (value.len() - value.trim_start().len());
    let value = value.trim();
    let way = Path::parse(path).map_err(&fail)?;
    if way.0.is_empty() {
        return Err(fail("a path is missing before the =".to_string()));
    }
    if value.is_empty() {
        return Err(fail("a value is missing after the =".to_string()));
    }
    let slot = view.slot(&way, path).map_err(|(message, notes)| {
        let mut diagnostic = fail(message);
        diagnostic.notes(notes);
        diagnostic
    })?;
    // texts are counted from the scene's own file on
    let number = number + 1;
    let slot = slot.with_maps(source);
    let put = |source: &Source, parts: &[(&str, Origin)]| {
        let mut source = source.clone();
        let span = slot.put(&mut source, (number, 0), parts);
        (source, span)
    };
    let plain = (value, Origin::of(number, value_at));
    let faults = parse(value).faults;
    if faults.is_empty() {
        let (with, span) = put(source, std::slice::from_ref(&plain));
        if !wants_text::<Scene>(&with, &span) {
            *source = with;
            return Ok(());
        }
    } else {
        let (with, span) = put(source, &[("x", plain.1)]);
        if value.contains('"') || !wants_text::<Scene>(&with, &span) {
            let fault = &faults[0];
            return Err(fail(format!(
                "the value `{value}` cannot be read: {}",
                fault.message.replace("the file", "it")
            )));
        }
    }
    // the shell has eaten the quotes, or the author never wrote them
    let quote = || ("\"", Origin::put_in(number, value_at));
    let escaped = value.replace('\\', "\\\\").replace('"', "\\\"");
    *source = put(source, &[quote(), (&escaped, plain.1), quote()]).0;
    Ok(())
}

/// Puts a value in at a path, of which the text of that number has the name from that byte on.
///
/// # Errors
/// Why it cannot be put in, and what is allowed.
pub fn put(
    source: &mut Source,
    view: &View,
    (path, from): (&str, (usize, usize)),
    value: &[(&str, Origin)],
) -> Result<(), (String, Vec<String>)> {
    let way = Path::parse(path).map_err(|message| (message, Vec::new()))?;
    if way.0.is_empty() {
        return Err(("a path is missing".to_string(), Vec::new()));
    }
    view.slot(&way, path)?.with_maps(source).put(source, from, value);
    Ok(())
}

/// A text's tree, as it is written and with what its parts bring.
pub struct View {
    written: Tree,
    merged: Option<Node>,
}

impl View {
    /// Of a text as it is now.
    pub fn of(source: &Source) -> Self {
        let written = parse(source.text());
        Self { merged: merged(&written.root), written }
    }

    /// The tree as it is written.
    pub fn written(&self) -> &Tree {
        &self.written
    }

    /// The tree with what parts bring, under the names that the scene knows it by.
    pub fn merged(&self) -> Tree {
        let root = self.merged.as_ref().unwrap_or(&self.written.root).clone();
        Tree { root, faults: self.written.faults.clone() }
    }

    /// Where the value at a path is, or would be.
    fn slot<'a>(&self, way: &'a Path, text: &str) -> Result<Slot<'a>, (String, Vec<String>)> {
        let reach = |root: &Node| way.find(root).map_or_else(|lost| lost.reached, |_| way.0.len());
        let written = &self.written.root;
        match &self.merged {
            Some(merged) if reach(merged) > reach(written) => Slot::find(way, merged, text),
            Some(merged) => Slot::find(way, written, text).or_else(|_| Slot::find(way, merged, text)),
            None => Slot::find(way, written, text),
        }
    }
}

/// Where a value goes.
struct Slot<'a> {
    /// What it replaces; empty where something new goes in.
    span: Span,
    /// Names that come before it, each with the place of the path it came from.
    new: Vec<(&'a str, usize)>,
    /// Of which of these what holds it is a map.
    in_maps: Vec<bool>,
}

impl<'a> Slot<'a> {
    fn find(way: &'a Path, root: &Node, text: &str) -> Result<Self, (String, Vec<String>)> {
        let Lost { node, reached } = match way.find(root) {
            // put together of what parts have, and nowhere written as a whole
            Ok(node) if node.span.is_empty() => {
                let message =
                    format!("only parts have such: there is no `{way}` in the scene to be changed as a whole");
                return Err((
                    message,
                    vec![format!("what is in it can be changed, or what a part brings: `parts.NAME.content.{way}`")],
                ));
            }
            Ok(node) => return Ok(Self { span: node.span.clone(), new: Vec::new(), in_maps: Vec::new() }),
            Err(lost) => lost,
        };
        let holder =
            if reached == 0 { "the scene".to_string() } else { format!("`{}`", Path(way.0[..reached].to_vec())) };
        let inner = node.inner();
        let rest = &way.0[reached..];
        match (&rest[0], &inner.kind) {
            (Segment::Index(index), Kind::List(items) | Kind::Tuple(items)) => {
                let last = items
                    .len()
                    .checked_sub(1)
                    .map_or("it is empty".to_string(), |last| format!("the last is [{last}]"));
                Err((format!("there is no [{index}] in {holder}"), vec![format!("counted from 0, {last}")]))
            }
            (Segment::Name(name), Kind::Map(entries)) if rest.len() > 1 => {
                let names: Vec<&str> = entries
                    .iter()
                    .filter_map(|entry| if let Kind::Text(key) = &entry.key.kind { Some(key.as_str()) } else { None })
                    .collect();
                let dotted =
                    names.iter().find(|known| known.split('.').next() == Some(name.as_str()) && *known != name);
                let quoted = dotted.map(|known| format!("names with dots stand in quotes: `\"{known}\"`"));
                let notes = quoted.into_iter().chain(choice(name, names.iter().copied())).collect();
                Err((format!("there is no `{name}` in {holder}"), notes))
            }
            (Segment::Name(_), Kind::Map(_) | Kind::Fields(_)) => Self::insert(rest, inner, text),
            (Segment::Name(_), Kind::Tuple(items)) if items.is_empty() => Self::insert(rest, inner, text),
            (Segment::Name(name), Kind::List(items)) => {
                let notes = vec![match items.len() {
                    0 => "it is empty".to_string(),
                    count => format!("its items are [0] to [{}]", count - 1),
                }];
                Err((format!("there is no `{name}` in {holder}, which is a list"), notes))
            }
            (Segment::Index(_), Kind::Map(_) | Kind::Fields(_)) => {
                Err((format!("{holder} has names inside, not numbers"), Vec::new()))
            }
            (segment, _) => {
                let inside = Path(vec![segment.clone()]);
                Err((format!("there is no `{inside}` in {holder}, which is {}", inner.describe()), Vec::new()))
            }
        }
    }

    fn insert(rest: &'a [Segment], holder: &Node, text: &str) -> Result<Self, (String, Vec<String>)> {
        let mut new = Vec::new();
        for segment in rest {
            let Segment::Name(name) = segment else {
                return Err(("a list that is not in the scene cannot be changed item by item".to_string(), Vec::new()));
            };
            // names lie in the path in this order; the place is for messages only
            let from = new.last().map_or(0, |(before, at): &(&str, usize)| at + before.len());
            let at = text[from..].find(name.as_str()).map_or(0, |found| from + found);
            new.push((name.as_str(), at));
        }
        if holder.span.is_empty() {
            let name = new.first().map_or("", |(name, _)| name);
            let notes = vec![
                "what a part brings can be changed, and added to: `parts.NAME.content. ...`; or give the scene an empty \
                 one of its own, as `probes: {}`"
                    .to_string(),
            ];
            return Err((format!("only parts have such: there is nothing to put `{name}` into"), notes));
        }
        // before the first that is there, where the comma after it is right; comments may stand anywhere else
        let first = match &holder.kind {
            Kind::Fields(fields) => fields.first().map(|field| field.name.span.start),
            Kind::Map(entries) => entries.first().map(|entry| entry.key.span.start),
            _ => None,
        };
        let open = first.unwrap_or(holder.span.end - 1);
        let mut in_maps = vec![false; new.len()];
        in_maps[0] = matches!(holder.kind, Kind::Map(_));
        Ok(Self { span: open..open, new, in_maps })
    }

    /// With maps where the scene wants such, of names that are not there yet.
    fn with_maps(mut self, source: &Source) -> Self {
        // what is inside is looked at where its holder is right; so until nothing is found any more
        for _ in 1..self.new.len() {
            let mut with = source.clone();
            self.put(&mut with, (0, 0), &[("x", Origin::of(0, 0))]);
            let wanted = wants_maps::<Scene>(&with);
            let (mut at, mut is_found) = (self.span.start, false);
            for i in 0..self.new.len() {
                let length: usize = self.before(i).iter().map(|text| text.len()).sum();
                // the bracket before a name holds it
                if i > 0 && wanted.iter().any(|span| span.start == at) {
                    self.in_maps[i] = true;
                    is_found = true;
                }
                at += length;
            }
            if !is_found {
                break;
            }
        }
        self
    }

    /// What stands before the next name, or the value.
    fn before(&self, i: usize) -> [&str; 4] {
        let bracket = match (i, self.in_maps[i]) {
            (0, _) => "",
            (_, true) => "{",
            (_, false) => "(",
        };
        let [quote, colon] = if self.in_maps[i] { ["\"", "\": "] } else { ["", ": "] };
        [bracket, quote, self.new[i].0, colon]
    }

    /// Puts the value in and tells where it now stands.
    fn put(&self, source: &mut Source, (text, from): (usize, usize), value: &[(&str, Origin)]) -> Span {
        let mut parts: Vec<(&str, Origin)> = Vec::new();
        let glue = |at: usize| Origin::put_in(text, from + at);
        let span = self.span.clone();
        if let Some((_, at)) = self.new.last() {
            for (i, (_, at)) in self.new.iter().enumerate() {
                let [bracket, quote, name, colon] = self.before(i);
                parts.extend([(bracket, glue(*at)), (quote, glue(*at)), (name, Origin::of(text, from + at))]);
                parts.push((colon, glue(*at)));
            }
            let before: usize = parts.iter().map(|(text, _)| text.len()).sum();
            let length: usize = value.iter().map(|(text, _)| text.len()).sum();
            parts.extend(value.iter().cloned());
            let close = |in_map: &bool| (if *in_map { "}" } else { ")" }, glue(*at));
            parts.extend(self.in_maps.iter().skip(1).rev().map(close));
            parts.push((", ", glue(*at)));
            source.replace(span, &parts);
            let start = self.span.start + before;
            return start..start + length;
        }
        source.replace(span.clone(), value);
        span.start..span.start + value.iter().map(|(text, _)| text.len()).sum::<usize>()
    }
}
