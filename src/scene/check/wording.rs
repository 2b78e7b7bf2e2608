//! What is said about values that do not fit.

use super::value::Value;
use crate::scene::diagnostic::Diagnostic;
use crate::scene::schema::OF_THE_WHOLE;
use crate::scene::suggest::{choice, nearest};
use crate::scene::syntax::{Field, Kind};
use crate::scene::words::meaning;
use std::cell::RefMut;

impl<'a> Value<'a> {
    /// The value as a sentence begins with it.
    pub(super) fn called(&self) -> String {
        match self.subject {
            "the scene" => self.subject.to_string(),
            name => format!("`{name}`"),
        }
    }

    /// Notes a mistake about this value, unless the parser has already.
    pub(super) fn note(&self, message: impl Into<String>, label: impl Into<String>) -> RefMut<'a, Diagnostic> {
        if let Kind::Bad = self.node.kind {
            return self.about.said_before.borrow_mut();
        }
        let mut at = self.node.span.clone();
        if self.token().contains('\n') {
            at = self.node.mark();
        }
        let mut diagnostic = Diagnostic::error(at, message);
        diagnostic.label(label);
        self.about.tell(diagnostic)
    }

    /// Notes that this value is of another kind than it must be.
    pub(super) fn wrong(&self, expected: &str) -> RefMut<'a, Diagnostic> {
        let called = self.called();
        self.note(format!("{called} must be {expected}"), format!("found {}", self.node.describe()))
    }

    /// The number; none when it is not one or not finite, which is noted.
    pub(super) fn number(&self) -> Option<f64> {
        if !matches!(self.node.kind, Kind::Number) {
            self.wrong("a number");
            return None;
        }
        let token = self.token();
        match ron::from_str::<f64>(token) {
            Ok(number) if number.is_finite() => Some(number),
            Ok(_) => {
                self.note(format!("{} must be finite, found {token}", self.called()), "not a finite number");
                None
            }
            Err(_) => {
                self.note(format!("`{token}` is not a number"), "written like 0.05, 5e-2 or 3");
                None
            }
        }
    }

    /// Notes numbers in a value, or in what it holds, that are none; if there are none of these, what else keeps ron
    /// from reading it.
    pub(super) fn unreadable(&self, error: &ron::Error) {
        let before = self.about.found.borrow().len();
        self.numbers_inside();
        if self.about.found.borrow().len() == before {
            self.note(format!("{} cannot be read: {error}", self.called()), "");
        }
    }

    fn numbers_inside(&self) {
        if matches!(self.node.kind, Kind::Number) && ron::from_str::<ron::Value>(self.token()).is_err() {
            self.note(format!("`{}` is not a number", self.token()), "written like 0.05, 5e-2 or 3");
        }
        for child in self.node.children() {
            self.of(child).numbers_inside();
        }
    }

    pub(super) fn not_whole(&self, least: i128, most: i128) {
        let from = if least == 0 { ", 0 or above" } else { "" };
        let expected = format!("a whole number{from}");
        if !matches!(self.node.kind, Kind::Number) {
            self.wrong(&expected);
            return;
        }
        let token = self.token();
        let called = self.called();
        match ron::from_str::<f64>(token) {
            Ok(number) if number.fract() == 0.0 && number > most as f64 => {
                self.note(format!("{called} must be at most {most}, found {token}"), "too large");
            }
            Ok(number) if number.fract() == 0.0 && number >= least as f64 => {
                self.note(format!("{called} must be {expected}, found {token}"), format!("write {number}"));
            }
            Ok(_) => {
                self.note(format!("{called} must be {expected}, found {token}"), "");
            }
            Err(_) => {
                self.note(format!("`{token}` is not a number"), format!("expected {expected}"));
            }
        }
    }

    pub(super) fn unknown_field(&self, owner: &str, field: &Field, fields: &'static [&'static str]) {
        let name = &field.name.text;
        if owner == "PartScene" && OF_THE_WHOLE.contains(&name.as_str()) {
            let message = format!("`{name}` belongs into the whole scene, not into a part of it");
            let mut diagnostic = Diagnostic::error(field.name.span.clone(), message);
            diagnostic.label("not in a part").note(format!("a part may have: {}", fields.join(", ")));
            drop(self.about.tell(diagnostic));
            return;
        }
        let mut diagnostic = Diagnostic::error(field.name.span.clone(), format!("unknown field `{name}`"));
        diagnostic.label(format!("not a field of {owner}"));
        if owner == "Scene" && name == "variants" {
            diagnostic
                .note("this looks like a sweep, which names a scene and its variants: it is run by `sinew sweep`");
        }
        if fields.is_empty() {
            diagnostic.note(format!("{owner} has no fields"));
        } else {
            diagnostic.notes(choice(name, fields.iter().copied()));
        }
        drop(self.about.tell(diagnostic));
    }

    /// Notes a missing field, but not when one of the unknown ones is probably it, misspelt.
    pub(super) fn missing_field(&self, owner: &str, field: &str, fields: &'static [&'static str]) {
        if let Kind::Fields(found) = &self.node.kind {
            let unknown = found.iter().map(|field| field.name.text.as_str()).filter(|name| !fields.contains(name));
            if unknown.into_iter().any(|name| nearest(name, fields.iter().copied()) == Some(field)) {
                return;
            }
        }
        let mut diagnostic =
            Diagnostic::error(self.node.mark(), format!("the field `{field}` is missing in {}", self.called()));
        diagnostic.label(format!("{owner} needs `{field}`"));
        if let Some(meaning) = meaning(owner, field) {
            diagnostic.note(format!("{field}: {meaning}"));
        }
        drop(self.about.tell(diagnostic));
    }
}
