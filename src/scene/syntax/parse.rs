//! From a text to its tree, going on after what can be gone on from.

use super::scan::{Endless, Scan, starts_word};
use super::{DEEPEST, Fault, Field, Kind, MapEntry, Node, Span, Tree, Word};
use crate::scene::limits::{FAULTS, VALUES};

/// Reads a text. Never fails: what is wrong is in [`Tree::faults`], and the tree holds the rest.
pub fn parse(text: &str) -> Tree {
    let mut parser =
        Parser { scan: Scan { text, at: 0 }, faults: Vec::new(), long_text: None, open: Vec::new(), values: 0 };
    let root = parser.file().unwrap_or(Node { span: 0..text.len(), name: None, kind: Kind::Bad });
    Tree { root, faults: parser.faults }
}

struct Parser<'a> {
    scan: Scan<'a>,
    faults: Vec<Fault>,
    /// The first text that goes on over the end of a line: where it begins, and how many faults came before it.
    long_text: Option<(Span, usize)>,
    /// The brackets that are open, innermost last.
    open: Vec<Span>,
    /// How many values there were so far.
    values: usize,
}

/// Nothing after this place can be made sense of; the fault is on the list.
struct Stop;

type Parsed<T> = Result<T, Stop>;

fn begins_value(c: char) -> bool {
    starts_word(c) || c.is_ascii_digit() || matches!(c, '"' | '\'' | '-' | '+' | '.' | '(' | '[' | '{')
}

impl Parser<'_> {
    fn fault(&mut self, span: Span, message: impl Into<String>, label: impl Into<String>) -> Stop {
        self.faults.push(Fault { span, message: message.into(), label: label.into(), also: None });
        Stop
    }

    fn endless(&mut self, Endless(span, message): Endless) -> Stop {
        self.fault(span, message, "begins here")
    }

    fn blanks(&mut self) -> Parsed<()> {
        self.scan.blanks().map_err(|endless| self.endless(endless))
    }

    fn file(&mut self) -> Parsed<Node> {
        self.blanks()?;
        while self.scan.rest().starts_with("#!") {
            // `#![enable(...)]`: for ron to validator
            let end = self.scan.rest().find(']').map_or(self.scan.text.len(), |end| self.scan.at + end + 1);
            self.scan.at = end;
            self.blanks()?;
        }
        if self.scan.peek().is_none() {
            return Err(self.fault(0..0, "the file is empty", "a scene begins with ( and ends with )"));
        }
        let root = self.value()?;
        self.blanks()?;
        if self.scan.peek().is_some() {
            let here = self.scan.here();
            self.fault(here, "something follows after the end of the scene", "the scene is complete before this");
        }
        Ok(root)
    }

    fn value(&mut self) -> Parsed<Node> {
        let start = self.scan.at;
        self.values += 1;
        if self.values > VALUES {
            let message = format!("the scene has more than {VALUES} values, the most that are allowed");
            return Err(self.fault(self.scan.here(), message, "one too many"));
        }
        if self.faults.len() >= FAULTS {
            return Err(Stop);
        }
        let kind = match self.scan.peek() {
            Some('[') => Kind::List(self.items(']')?),
            Some('{') => self.map()?,
            Some('(') => self.round()?,
            Some(_) if self.scan.quoted_ahead() => self.quoted()?,
            Some(c) if c.is_ascii_digit() || matches!(c, '-' | '+' | '.') => {
                self.scan.number();
                Kind::Number
            }
            Some(c) if starts_word(c) => return self.worded(),
            _ => return self.unreadable(),
        };
        Ok(Node { span: start..self.scan.at, name: None, kind })
    }

    /// No value begins here. A missing value (`a: ,`) is a fault one can go on from.
    fn unreadable(&mut self) -> Parsed<Node> {
        let here = self.scan.here();
        match self.scan.peek() {
            None => Err(self.unclosed()),
            Some(',' | ')' | ']' | '}') => {
                self.fault(here.clone(), "a value is missing", "expected a value before this");
                Ok(Node { span: here.start..here.start, name: None, kind: Kind::Bad })
            }
            Some(c) => Err(self.fault(here, format!("`{c}` does not belong here"), "expected a value")),
        }
    }

    /// The text ends inside brackets.
    fn unclosed(&mut self) -> Stop {
        let end = self.scan.text.trim_end().len();
        let also = self.open.last().map(|open| (open.clone(), "this bracket is not closed".to_string()));
        self.faults.push(Fault {
            span: end..end,
            message: "the file ends too early".to_string(),
            label: "the end of the file".to_string(),
            also,
        });
        Stop
    }

    fn quoted(&mut self) -> Parsed<Kind> {
        let span = self.scan.quoted().map_err(|endless| match self.long_text.take() {
            // a missing quotation mark turns the rest of the file inside out; what was said of it is of no use
            Some((span, faults)) if faults < self.faults.len() => {
                self.faults.truncate(faults);
                self.fault(span, "this text does not end on its line; a quotation mark may be missing", "begins here")
            }
            _ => self.endless(endless),
        })?;
        let token = &self.scan.text[span.clone()];
        if self.long_text.is_none() && token.contains('\n') {
            self.long_text = Some((span.start..span.start + 1, self.faults.len()));
        }
        if token.starts_with(['\'', 'b']) {
            return Ok(Kind::Char);
        }
        match ron::from_str::<String>(token) {
            Ok(text) => Ok(Kind::Text(text)),
            Err(error) => {
                self.fault(span, format!("this text cannot be read: {}", error.code), "write \\\\ for a backslash");
                Ok(Kind::Bad)
            }
        }
    }

    /// A word, alone or with brackets.
    fn worded(&mut self) -> Parsed<Node> {
        let start = self.scan.at;
        let Some(span) = self.scan.word() else { return self.unreadable() };
        let text = &self.scan.text[span.clone()];
        let plain = |kind| Ok(Node { span: span.clone(), name: None, kind });
        match text {
            "true" | "false" => return plain(Kind::Bool(text == "true")),
            "inf" | "inff32" | "inff64" | "NaN" | "NaNf32" | "NaNf64" => return plain(Kind::Number),
            _ => {}
        }
        let name = Some(Word { text: text.trim_start_matches("r#").to_string(), span: span.clone() });
        self.blanks()?;
        if self.scan.peek() == Some('(') {
            let kind = self.round()?;
            return Ok(Node { span: start..self.scan.at, name, kind });
        }
        Ok(Node { span, name, kind: Kind::Word })
    }

    fn enter(&mut self) -> Parsed<()> {
        let here = self.scan.here();
        if self.open.len() >= DEEPEST {
            return Err(self.fault(here, format!("brackets are nested more than {DEEPEST} deep"), "too deep"));
        }
        self.scan.at = here.end;
        self.open.push(here);
        Ok(())
    }

    /// `( ... )`: fields when the first thing is a word and a colon, or something in the place of a colon.
    fn round(&mut self) -> Parsed<Kind> {
        let before = self.scan.at;
        self.scan.at += 1;
        self.blanks()?;
        let word = if self.scan.quoted_ahead() { None } else { self.scan.word() };
        self.blanks()?;
        let value_follows = |c: char| c.is_ascii_digit() || matches!(c, ':' | '=' | '"' | '-' | '[' | '{');
        let named = word.is_some() && self.scan.peek().is_some_and(value_follows);
        self.scan.at = before;
        if !named {
            return Ok(Kind::Tuple(self.items(')')?));
        }
        let mut fields = Vec::new();
        self.enter()?;
        while self.more(')')? {
            let Some(span) = self.scan.word() else {
                let here = self.scan.here();
                return Err(self.fault(here, "the name of a field is missing", "expected `name: value`"));
            };
            let name = Word { text: self.scan.text[span.clone()].trim_start_matches("r#").to_string(), span };
            let value = self.after_colon(&name.span, "field")?;
            fields.push(Field { name, value });
            self.stray_word()?;
            self.comma(')')?;
        }
        Ok(Kind::Fields(fields))
    }

    fn map(&mut self) -> Parsed<Kind> {
        let mut entries = Vec::new();
        self.enter()?;
        while self.more('}')? {
            let key = self.value()?;
            let value = self.after_colon(&key.span, "name")?;
            entries.push(MapEntry { key, value });
            self.comma('}')?;
        }
        Ok(Kind::Map(entries))
    }

    fn items(&mut self, close: char) -> Parsed<Vec<Node>> {
        let mut items = Vec::new();
        self.enter()?;
        while self.more(close)? {
            items.push(self.value()?);
            self.comma(close)?;
        }
        Ok(items)
    }

    /// A colon and the value behind it.
    fn after_colon(&mut self, before: &Span, what: &str) -> Parsed<Node> {
        self.blanks()?;
        if self.scan.peek() == Some('=') {
            let here = self.scan.here();
            self.fault(here.clone(), "`=` does not belong here", "a colon stands between name and value");
            self.scan.at = here.end;
        } else if !self.scan.eat(':') {
            let text = &self.scan.text[before.clone()];
            if self.scan.peek().is_some_and(begins_value) {
                self.fault(before.end..before.end, "a colon is missing", "expected a colon here");
                return self.value();
            }
            return Err(self.fault(
                before.clone(),
                format!("the {what} {text} has no value"),
                "expected a colon after this",
            ));
        }
        self.blanks()?;
        self.value()
    }

    /// Whether another item follows; eats the closing bracket when not.
    fn more(&mut self, close: char) -> Parsed<bool> {
        self.blanks()?;
        let here = self.scan.here();
        match self.scan.peek() {
            None => Err(self.unclosed()),
            Some(c) if c == close => {
                self.scan.at = here.end;
                self.open.pop();
                Ok(false)
            }
            Some(c @ (')' | ']' | '}')) => {
                let stop = self.fault(
                    here,
                    format!("`{c}` does not match the bracket that is open"),
                    format!("expected `{close}`"),
                );
                let also = self.open.last().map(|open| (open.clone(), "opened here".to_string()));
                if let Some(fault) = self.faults.last_mut() {
                    fault.also = also;
                }
                Err(stop)
            }
            _ => Ok(true),
        }
    }

    /// A word between a value and the comma after it, such as a unit.
    fn stray_word(&mut self) -> Parsed<()> {
        self.blanks()?;
        let before = self.scan.at;
        if self.scan.quoted_ahead() {
            return Ok(());
        }
        let Some(span) = self.scan.word() else { return Ok(()) };
        self.blanks()?;
        if matches!(self.scan.peek(), Some(',' | ')')) {
            let message = format!("`{}` does not belong here", &self.scan.text[span.clone()]);
            self.fault(span, message, "numbers are written without units: m, kg, s, Pa");
        } else {
            self.scan.at = before;
        }
        Ok(())
    }

    /// The comma after an item; one that is missing is a fault one can go on from.
    fn comma(&mut self, close: char) -> Parsed<()> {
        let end = self.scan.at;
        self.blanks()?;
        if self.scan.eat(',') {
            return Ok(());
        }
        match self.scan.peek() {
            None => Err(self.unclosed()),
            Some(c) if c == close || matches!(c, ')' | ']' | '}') => Ok(()),
            Some(c) if begins_value(c) => {
                self.fault(end..end, "a comma is missing", "expected a comma here");
                Ok(())
            }
            Some(c) => {
                let here = self.scan.here();
                let label = match (c, close) {
                    (':', ')') => "names in quotes belong in curly brackets { }".to_string(),
                    _ => format!("expected a comma or `{close}`"),
                };
                Err(self.fault(here, format!("`{c}` does not belong here"), label))
            }
        }
    }
}
