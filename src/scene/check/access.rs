//! The insides of a value, handed to serde one after the other.

use super::Stop;
use super::stand_in::StandIn;
use super::value::Value;
use crate::scene::syntax::{Field, Kind, MapEntry, Node};
use serde::de::value::StrDeserializer;
use serde::de::{DeserializeSeed, Deserializer, EnumAccess, MapAccess, SeqAccess, VariantAccess, Visitor};
use std::collections::BTreeSet;

/// The items of a list or of brackets; stand-ins where there are too few.
pub(super) struct Items<'a> {
    parent: Value<'a>,
    items: &'a [Node],
    at: usize,
    length: usize,
}

impl<'a> Items<'a> {
    pub(super) fn new(parent: Value<'a>, items: &'a [Node], length: usize) -> Self {
        Self { parent, items, at: 0, length }
    }
}

impl<'de> SeqAccess<'de> for Items<'_> {
    type Error = Stop;

    fn next_element_seed<T: DeserializeSeed<'de>>(&mut self, seed: T) -> Result<Option<T::Value>, Stop> {
        if self.at == self.length {
            return Ok(None);
        }
        let item = self.items.get(self.at);
        self.at += 1;
        match item {
            Some(node) => seed.deserialize(self.parent.of(node)).map(Some),
            None => seed.deserialize(StandIn).map(Some),
        }
    }
}

/// The entries of a map, of a name that stands twice the first only.
pub(super) struct Entries<'a> {
    parent: Value<'a>,
    entries: &'a [MapEntry],
    seen: BTreeSet<&'a str>,
    value: Option<Value<'a>>,
}

impl<'a> Entries<'a> {
    pub(super) fn new(parent: Value<'a>, entries: &'a [MapEntry]) -> Self {
        Self { parent, entries, seen: BTreeSet::new(), value: None }
    }
}

impl<'de> MapAccess<'de> for Entries<'_> {
    type Error = Stop;

    fn next_key_seed<K: DeserializeSeed<'de>>(&mut self, seed: K) -> Result<Option<K::Value>, Stop> {
        while let Some((entry, rest)) = self.entries.split_first() {
            self.entries = rest;
            let key = self.parent.of(&entry.key);
            let name = match &entry.key.kind {
                Kind::Text(name) => name.as_str(),
                _ => key.token(),
            };
            if !self.seen.insert(name) {
                continue;
            }
            if !matches!(entry.key.kind, Kind::Text(_) | Kind::Bad) {
                let label =
                    if matches!(entry.key.kind, Kind::Word) { format!("write \"{name}\"") } else { String::new() };
                key.note(format!("the names in {} must be texts in quotes", self.parent.called()), label);
            }
            self.value = Some(Value { node: &entry.value, about: self.parent.about, subject: name, is_content: false });
            return seed.deserialize(StrDeserializer::new(name)).map(Some);
        }
        Ok(None)
    }

    fn next_value_seed<V: DeserializeSeed<'de>>(&mut self, seed: V) -> Result<V::Value, Stop> {
        match self.value.take() {
            Some(value) => seed.deserialize(value),
            None => seed.deserialize(StandIn),
        }
    }
}

/// The known fields of a struct, and stand-ins for those that are missing and noted.
pub(super) struct FieldsOf<'a> {
    parent: Value<'a>,
    todo: Vec<(&'static str, Option<&'a Node>)>,
    value: Option<&'a Node>,
}

impl<'a> FieldsOf<'a> {
    pub(super) fn new(
        parent: Value<'a>,
        found: &'a [Field],
        fields: &'static [&'static str],
        supplied: &[&'static str],
    ) -> Self {
        let first = |name: &str| found.iter().find(|field| field.name.text == name).map(|field| &field.value);
        let mut todo: Vec<_> =
            fields.iter().filter_map(|name| first(name).map(|node| (*name, Some(node)))).rev().collect();
        todo.extend(supplied.iter().map(|name| (*name, None)));
        Self { parent, todo, value: None }
    }

    pub(super) fn stand_ins(parent: Value<'a>, fields: &'static [&'static str]) -> Self {
        Self { parent, todo: fields.iter().map(|name| (*name, None)).collect(), value: None }
    }
}

impl<'de> MapAccess<'de> for FieldsOf<'_> {
    type Error = Stop;

    fn next_key_seed<K: DeserializeSeed<'de>>(&mut self, seed: K) -> Result<Option<K::Value>, Stop> {
        let Some((name, node)) = self.todo.pop() else { return Ok(None) };
        self.value = node;
        self.parent.subject = name;
        seed.deserialize(StrDeserializer::new(name)).map(Some)
    }

    fn next_value_seed<V: DeserializeSeed<'de>>(&mut self, seed: V) -> Result<V::Value, Stop> {
        match self.value.take() {
            Some(node) => seed.deserialize(self.parent.of(node)),
            None => seed.deserialize(StandIn),
        }
    }
}

/// A word of an enum and what stands in its brackets.
pub(super) struct Variant<'a> {
    pub(super) value: Value<'a>,
    pub(super) name: &'a str,
}

impl<'de> EnumAccess<'de> for Variant<'_> {
    type Error = Stop;
    type Variant = Self;

    fn variant_seed<V: DeserializeSeed<'de>>(self, seed: V) -> Result<(V::Value, Self), Stop> {
        let variant = seed.deserialize(StrDeserializer::new(self.name))?;
        Ok((variant, self))
    }
}

impl<'de> VariantAccess<'de> for Variant<'_> {
    type Error = Stop;

    fn unit_variant(self) -> Result<(), Stop> {
        if !matches!(self.value.node.kind, Kind::Word) {
            let name = self.name;
            self.value.note(format!("`{name}` stands alone, without brackets"), format!("write {name}"));
        }
        Ok(())
    }

    fn newtype_variant_seed<T: DeserializeSeed<'de>>(self, seed: T) -> Result<T::Value, Stop> {
        let Self { value, name } = self;
        match &value.node.kind {
            Kind::Tuple(items) if items.len() == 1 => {
                seed.deserialize(Value { node: &items[0], subject: name, ..value })
            }
            // what it holds may be a struct, whose fields stand in its own brackets
            Kind::Fields(_) | Kind::Tuple(_) => seed.deserialize(Value { subject: name, is_content: true, ..value }),
            _ => {
                value.note(format!("`{name}` needs one value in brackets"), format!("write {name}(...)"));
                seed.deserialize(StandIn)
            }
        }
    }

    fn tuple_variant<V: Visitor<'de>>(self, length: usize, visitor: V) -> Result<V::Value, Stop> {
        Value { subject: self.name, ..self.value }.tuple(self.name, length, visitor)
    }

    fn struct_variant<V: Visitor<'de>>(self, fields: &'static [&'static str], visitor: V) -> Result<V::Value, Stop> {
        let Self { value, name } = self;
        if let Kind::Word = value.node.kind {
            let mut mistake = value.note(format!("`{name}` needs brackets"), format!("write {name}(...)"));
            mistake.note(format!("fields: {}", fields.join(", ")));
            drop(mistake);
            return StandIn.deserialize_struct("", fields, visitor);
        }
        Value { subject: name, ..value }.fields(name, fields, visitor)
    }
}
