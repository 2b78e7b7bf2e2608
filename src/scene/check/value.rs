//! One value of the tree, handed to serde; what does not fit is noted and stood in for.

use super::access::{Entries, FieldsOf, Items, Variant};
use super::stand_in::StandIn;
use super::{About, Required, Stop};
use crate::scene::diagnostic::Diagnostic;
use crate::scene::load::options;
use crate::scene::suggest::choice;
use crate::scene::syntax::{Kind, Node};
use serde::de::{Deserializer, Error, Visitor};

/// A value, and the name of the field or entry it belongs to.
#[derive(Clone, Copy)]
pub(super) struct Value<'a> {
    pub(super) node: &'a Node,
    pub(super) about: &'a About<'a>,
    pub(super) subject: &'a str,
    /// Whether the word before its brackets is that of an enum whose content they hold.
    pub(super) is_content: bool,
}

/// Numbers: as ron reads the same characters.
macro_rules! whole_numbers {
    ($($method:ident $visit:ident $number:ty),*) => {$(
        fn $method<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Stop> {
            match (&self.node.kind, ron::from_str::<$number>(self.token())) {
                (Kind::Number, Ok(number)) => visitor.$visit(number),
                _ => {
                    self.not_whole(<$number>::MIN as i128, <$number>::MAX as i128);
                    visitor.$visit(1)
                }
            }
        }
    )*};
}

impl<'de> Deserializer<'de> for Value<'_> {
    type Error = Stop;

    whole_numbers!(deserialize_u8 visit_u8 u8, deserialize_u16 visit_u16 u16, deserialize_u32 visit_u32 u32,
        deserialize_u64 visit_u64 u64, deserialize_i8 visit_i8 i8, deserialize_i16 visit_i16 i16,
        deserialize_i32 visit_i32 i32, deserialize_i64 visit_i64 i64);

    /// A value that may be anything, as ron reads it.
    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Stop> {
        match options().from_str::<ron::Value>(self.token()) {
            Ok(value) => value.deserialize_any(visitor).map_err(Stop::custom),
            Err(error) => {
                self.unreadable(&error.code);
                visitor.visit_unit()
            }
        }
    }

    fn deserialize_ignored_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Stop> {
        visitor.visit_unit()
    }

    fn deserialize_bool<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Stop> {
        match self.node.kind {
            Kind::Bool(value) => visitor.visit_bool(value),
            _ => {
                self.wrong("true or false");
                visitor.visit_bool(false)
            }
        }
    }

    fn deserialize_f64<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Stop> {
        visitor.visit_f64(self.number().unwrap_or(1.0))
    }

    fn deserialize_f32<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Stop> {
        self.deserialize_f64(visitor)
    }

    fn deserialize_str<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Stop> {
        if !matches!(self.node.kind, Kind::Text(_)) {
            self.about.texts_wanted.borrow_mut().push(self.node.span.clone());
        }
        match &self.node.kind {
            Kind::Text(text) => visitor.visit_str(text),
            Kind::Word => {
                let word = self.token();
                self.note(format!("{} must be a text in quotes", self.called()), format!("write \"{word}\""));
                visitor.visit_str(word)
            }
            _ => {
                self.wrong("a text in quotes");
                visitor.visit_str("")
            }
        }
    }

    fn deserialize_string<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Stop> {
        self.deserialize_str(visitor)
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Stop> {
        let name = self.node.name.as_ref().map(|name| name.text.as_str());
        match (name, &self.node.kind) {
            (Some("None"), Kind::Word) => visitor.visit_none(),
            (Some("Some"), Kind::Tuple(items)) if items.len() == 1 => visitor.visit_some(self.of(&items[0])),
            (Some("Some"), _) => {
                self.wrong("Some(value), None, or the value alone");
                visitor.visit_none()
            }
            _ => visitor.visit_some(self),
        }
    }

    fn deserialize_seq<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Stop> {
        match &self.node.kind {
            Kind::List(items) => visitor.visit_seq(Items::new(self, items, items.len())),
            Kind::Tuple(items) if self.node.name.is_none() => {
                self.note(format!("{} must be a list", self.called()), "write [ ] instead of ( )");
                visitor.visit_seq(Items::new(self, items, items.len()))
            }
            Kind::Bad => visitor.visit_seq(Items::new(self, &[], 0)),
            _ => {
                let label = match self.token() {
                    short if short.len() < 40 && !short.contains('\n') => format!("write [{short}]"),
                    _ => "put it in [ ]".to_string(),
                };
                self.note(format!("{} must be a list", self.called()), label);
                visitor.visit_seq(Items::new(self, &[], 0))
            }
        }
    }

    fn deserialize_tuple<V: Visitor<'de>>(self, length: usize, visitor: V) -> Result<V::Value, Stop> {
        self.tuple("", length, visitor)
    }

    fn deserialize_tuple_struct<V: Visitor<'de>>(
        self,
        name: &'static str,
        length: usize,
        visitor: V,
    ) -> Result<V::Value, Stop> {
        self.tuple(name, length, visitor)
    }

    fn deserialize_map<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Stop> {
        match &self.node.kind {
            Kind::Map(entries) => visitor.visit_map(Entries::new(self, entries)),
            _ => {
                self.about.maps_wanted.borrow_mut().push(self.node.span.clone());
                self.wrong("names and values in curly brackets: { \"name\": value }");
                visitor.visit_map(Entries::new(self, &[]))
            }
        }
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        name: &'static str,
        fields: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Stop> {
        if self.is_content {
            return self.fields(self.subject, fields, visitor);
        }
        if let Some(found) = self.node.name.as_ref().filter(|found| found.text != name) {
            let mut diagnostic =
                Diagnostic::error(found.span.clone(), format!("`{}` does not belong here", found.text));
            diagnostic.label(format!("{} is written without a word before the brackets", self.called()));
            drop(self.about.tell(diagnostic));
            // its fields are those of something else
            return StandIn.deserialize_struct(name, fields, visitor);
        }
        self.fields(name, fields, visitor)
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        name: &'static str,
        variants: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Stop> {
        let found = match &self.node.name {
            Some(found) if variants.contains(&found.text.as_str()) => {
                return visitor.visit_enum(Variant { value: self, name: &found.text });
            }
            Some(found) => found.text.as_str(),
            None => "",
        };
        match &self.node.kind {
            Kind::Bad => {}
            Kind::Text(text) if variants.contains(&text.as_str()) => {
                self.note(format!("{} must be a word without quotes", self.called()), format!("write {text}"));
            }
            _ if found.is_empty() => {
                self.wrong("one of the words below").notes(choice(self.token(), variants.iter().copied()));
            }
            _ => {
                let mut diagnostic =
                    Diagnostic::error(self.node.mark(), format!("{} cannot be `{found}`", self.called()));
                diagnostic.label("unknown word").notes(choice(found, variants.iter().copied()));
                drop(self.about.tell(diagnostic));
            }
        }
        StandIn.deserialize_enum(name, variants, visitor)
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(self, _: &'static str, visitor: V) -> Result<V::Value, Stop> {
        visitor.visit_newtype_struct(self)
    }

    fn deserialize_unit<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Stop> {
        visitor.visit_unit()
    }

    serde::forward_to_deserialize_any! { i128 u128 char bytes byte_buf unit_struct identifier }
}

impl<'a> Value<'a> {
    /// Another value under the same name.
    pub(super) fn of(self, node: &'a Node) -> Self {
        Self { node, is_content: false, ..self }
    }

    pub(super) fn token(&self) -> &'a str {
        &self.about.text[self.node.span.clone()]
    }

    /// The fields of a struct or of a struct variant.
    pub(super) fn fields<'de, V: Visitor<'de>>(
        self,
        owner: &'a str,
        fields: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Stop> {
        let found = match &self.node.kind {
            Kind::Fields(found) => found.as_slice(),
            Kind::Tuple(items) if items.is_empty() => &[],
            Kind::Tuple(_) => {
                let word = self.node.name.as_ref().map_or("", |name| &name.text);
                let first = fields.first().copied().unwrap_or_default();
                self.note(
                    format!("{} needs the names of its fields", self.called()),
                    format!("write {word}({first}: ...)"),
                )
                .note(format!("fields: {}", fields.join(", ")));
                return visitor.visit_map(FieldsOf::stand_ins(self, fields));
            }
            _ => {
                let named = fields.first().map_or(String::new(), |first| format!(", such as ({first}: ...)"));
                self.wrong(&format!("fields in round brackets{named}")).note(format!("fields: {}", fields.join(", ")));
                return visitor.visit_map(FieldsOf::stand_ins(self, fields));
            }
        };
        for field in found.iter().filter(|field| !fields.contains(&field.name.text.as_str())) {
            self.unknown_field(owner, field, fields);
        }
        let required = |field: &'static str| Required { owner: owner.to_string(), fields, field };
        let absent = fields.iter().filter(|name| !found.iter().any(|field| field.name.text == **name));
        let missing: Vec<_> = absent.copied().filter(|name| self.about.required.contains(&required(name))).collect();
        for field in &missing {
            self.missing_field(owner, field, fields);
        }
        visitor.visit_map(FieldsOf::new(self, found, fields, &missing)).map_err(|stop| match stop {
            Stop::Missing { field, of: None } => Stop::Missing { field, of: Some(required(field)) },
            stop => stop,
        })
    }

    /// Several values in round brackets, of a fixed number.
    pub(super) fn tuple<'de, V: Visitor<'de>>(self, name: &str, length: usize, visitor: V) -> Result<V::Value, Stop> {
        let named = self.node.name.as_ref().is_some_and(|found| found.text != name);
        let items = match &self.node.kind {
            Kind::Tuple(items) if !named => items.as_slice(),
            Kind::List(items) => {
                self.note(format!("{} must stand in round brackets", self.called()), "write ( ) instead of [ ]");
                items
            }
            Kind::Bad => &[],
            _ => {
                self.wrong(&format!("{length} values in round brackets"));
                return visitor.visit_seq(Items::new(self, &[], length));
            }
        };
        if items.len() != length && !matches!(self.node.kind, Kind::Bad) {
            let message = format!("{} must have {length} values, found {}", self.called(), items.len());
            self.note(message, format!("{length} values belong here"));
        }
        visitor.visit_seq(Items::new(self, items, length))
    }
}
