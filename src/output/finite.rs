//! Finds the numbers of a value that JSON cannot express: a serialiser that writes nothing and looks at every float.
//! (serde_json itself turns them into `null` without a word.)

use serde::ser::{self, Serialize};
use std::fmt::Display;

/// The numbers that are not finite, each with the way to it: `energy.kinetic`, `probes.tip.2`.
pub fn not_finite<T: Serialize>(value: &T) -> Vec<(String, f64)> {
    let mut search = Search::default();
    // the search itself never refuses anything; what a type refuses, it refuses the JSON writer as well
    let _ = value.serialize(&mut search);
    search.found
}

#[derive(Default)]
struct Search {
    way: Vec<String>,
    /// Rows of the sequences we are in.
    rows: Vec<usize>,
    found: Vec<(String, f64)>,
}

impl Search {
    fn below<T: Serialize + ?Sized>(&mut self, key: &str, value: &T) -> Result<(), Refused> {
        self.way.push(key.to_string());
        let done = value.serialize(&mut *self);
        self.way.pop();
        done
    }

    fn next_row<T: Serialize + ?Sized>(&mut self, value: &T) -> Result<(), Refused> {
        let row = self.rows.last_mut().map_or(0, |row| std::mem::replace(row, *row + 1));
        self.below(&row.to_string(), value)
    }

    fn sequence(&mut self) -> Result<&mut Self, Refused> {
        self.rows.push(0);
        Ok(self)
    }

    fn end_sequence(&mut self) -> Result<(), Refused> {
        self.rows.pop();
        Ok(())
    }
}

/// A type's own refusal to be serialised.
#[derive(Debug, thiserror::Error)]
#[error("{0}")]
struct Refused(String);

impl ser::Error for Refused {
    fn custom<T: Display>(text: T) -> Self {
        Refused(text.to_string())
    }
}

/// Types that hold no float.
macro_rules! nothing_to_find {
    ($($name:ident: $kind:ty),*) => { $(fn $name(self, _: $kind) -> Result<(), Refused> { Ok(()) })* };
}

impl<'a> ser::Serializer for &'a mut Search {
    type Ok = ();
    type Error = Refused;
    type SerializeSeq = &'a mut Search;
    type SerializeTuple = &'a mut Search;
    type SerializeTupleStruct = &'a mut Search;
    type SerializeTupleVariant = &'a mut Search;
    type SerializeMap = Keyed<'a>;
    type SerializeStruct = &'a mut Search;
    type SerializeStructVariant = &'a mut Search;

    nothing_to_find!(serialize_bool: bool, serialize_i8: i8, serialize_i16: i16, serialize_i32: i32, serialize_i64: i64,
        serialize_u8: u8, serialize_u16: u16, serialize_u32: u32, serialize_u64: u64, serialize_char: char,
        serialize_str: &str, serialize_bytes: &[u8], serialize_unit_struct: &'static str);

    fn serialize_f32(self, number: f32) -> Result<(), Refused> {
        self.serialize_f64(f64::from(number))
    }
    fn serialize_f64(self, number: f64) -> Result<(), Refused> {
        if !number.is_finite() {
            self.found.push((self.way.join("."), number));
        }
        Ok(())
    }
    fn serialize_none(self) -> Result<(), Refused> {
        Ok(())
    }
    fn serialize_some<T: Serialize + ?Sized>(self, value: &T) -> Result<(), Refused> {
        value.serialize(self)
    }
    fn serialize_unit(self) -> Result<(), Refused> {
        Ok(())
    }
    fn serialize_unit_variant(self, _: &'static str, _: u32, _: &'static str) -> Result<(), Refused> {
        Ok(())
    }
    fn serialize_newtype_struct<T: Serialize + ?Sized>(self, _: &'static str, value: &T) -> Result<(), Refused> {
        value.serialize(self)
    }
    fn serialize_newtype_variant<T: Serialize + ?Sized>(
        self,
        _: &'static str,
        _: u32,
        variant: &'static str,
        value: &T,
    ) -> Result<(), Refused> {
        self.below(variant, value)
    }
    fn serialize_seq(self, _: Option<usize>) -> Result<Self, Refused> {
        self.sequence()
    }
    fn serialize_tuple(self, _: usize) -> Result<Self, Refused> {
        self.sequence()
    }
    fn serialize_tuple_struct(self, _: &'static str, _: usize) -> Result<Self, Refused> {
        self.sequence()
    }
    fn serialize_tuple_variant(self, _: &'static str, _: u32, _: &'static str, _: usize) -> Result<Self, Refused> {
        self.sequence()
    }
    fn serialize_map(self, _: Option<usize>) -> Result<Keyed<'a>, Refused> {
        Ok(Keyed { search: self, key: String::new() })
    }
    fn serialize_struct(self, _: &'static str, _: usize) -> Result<Self, Refused> {
        Ok(self)
    }
    fn serialize_struct_variant(self, _: &'static str, _: u32, _: &'static str, _: usize) -> Result<Self, Refused> {
        Ok(self)
    }
}

/// A map in which we look, and the key we are at.
struct Keyed<'a> {
    search: &'a mut Search,
    key: String,
}

impl ser::SerializeMap for Keyed<'_> {
    type Ok = ();
    type Error = Refused;
    fn serialize_key<T: Serialize + ?Sized>(&mut self, key: &T) -> Result<(), Refused> {
        let key = serde_json::to_value(key).map_err(|error| Refused(error.to_string()))?;
        self.key = key.as_str().map_or_else(|| key.to_string(), str::to_string);
        Ok(())
    }
    fn serialize_value<T: Serialize + ?Sized>(&mut self, value: &T) -> Result<(), Refused> {
        self.search.below(&self.key, value)
    }
    fn end(self) -> Result<(), Refused> {
        Ok(())
    }
}

/// The four kinds of sequences, alike in all but the names.
macro_rules! sequence {
    ($($kind:ident $method:ident),*) => { $(impl ser::$kind for &mut Search {
        type Ok = ();
        type Error = Refused;
        fn $method<T: Serialize + ?Sized>(&mut self, value: &T) -> Result<(), Refused> {
            self.next_row(value)
        }
        fn end(self) -> Result<(), Refused> {
            self.end_sequence()
        }
    })* };
}
sequence!(SerializeSeq serialize_element, SerializeTuple serialize_element, SerializeTupleStruct serialize_field,
    SerializeTupleVariant serialize_field);

/// The two kinds of named fields.
macro_rules! fields {
    ($($kind:ident),*) => { $(impl ser::$kind for &mut Search {
        type Ok = ();
        type Error = Refused;
        fn serialize_field<T: Serialize + ?Sized>(&mut self, key: &'static str, value: &T) -> Result<(), Refused> {
            self.below(key, value)
        }
        fn end(self) -> Result<(), Refused> {
            Ok(())
        }
    })* };
}
fields!(SerializeStruct, SerializeStructVariant);
