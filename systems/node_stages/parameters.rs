//! What a scene gives a system as its parameters, as a shader has them: a uniform laid out by the types of the members.

use serde::ser::{
    Error as _, Impossible, Serialize, SerializeStruct, SerializeTuple, SerializeTupleStruct, Serializer,
};
use std::fmt::{Display, Formatter, Write};

/// The declaration of a uniform, and its bytes, each member on a multiple of 16; both empty where there are no members.
#[derive(Debug, Default, PartialEq)]
pub struct Parameters {
    /// WGSL.
    pub declared: String,
    /// What the uniform holds.
    pub bytes: Vec<u8>,
}

impl Parameters {
    /// The uniform `name` of a struct whose members are numbers, truth values, and vectors of two to four real numbers.
    /// Whole numbers are `i32`, those without a sign and truth values `u32`, others `f32`, whatever their values.
    ///
    /// # Errors
    /// A member that is nothing else, by its name.
    pub fn of<S: Serialize>(name: &'static str, parameters: &S) -> Result<Self, String> {
        parameters.serialize(OfStruct { name, ..OfStruct::default() }).map_err(|Unfit(what)| what)
    }
}

/// Why a member cannot be in a uniform.
#[derive(Debug)]
struct Unfit(String);

impl Display for Unfit {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        self.0.fmt(f)
    }
}

impl std::error::Error for Unfit {}

impl serde::ser::Error for Unfit {
    fn custom<T: Display>(what: T) -> Self {
        Self(what.to_string())
    }
}

/// What a member is in WGSL, and its words.
type Member = (String, Vec<u32>);

/// Members that there are so far.
#[derive(Default)]
struct OfStruct {
    /// Of the uniform.
    name: &'static str,
    members: String,
    bytes: Vec<u8>,
}

impl SerializeStruct for OfStruct {
    type Ok = Parameters;
    type Error = Unfit;

    fn serialize_field<T: Serialize + ?Sized>(&mut self, name: &'static str, value: &T) -> Result<(), Unfit> {
        let (of, words) = value.serialize(OfMember).map_err(|Unfit(what)| Unfit(format!("`{name}`: {what}")))?;
        let _ = writeln!(self.members, "    @align(16) {name}: {of},");
        self.bytes.extend(words.iter().flat_map(|word| word.to_le_bytes()));
        self.bytes.resize(self.bytes.len().next_multiple_of(16), 0);
        Ok(())
    }

    fn end(self) -> Result<Parameters, Unfit> {
        let Self { name, members, bytes } = self;
        if bytes.is_empty() {
            return Ok(Parameters::default());
        }
        let mut letters = name.chars();
        let of: String = letters.next().into_iter().flat_map(char::to_uppercase).chain(letters).collect();
        let uniform = format!("@group(0) @binding(0) var<uniform> {name}: {of};");
        Ok(Parameters { declared: format!("struct {of} {{\n{members}}}\n{uniform}\n"), bytes })
    }
}

/// Real numbers of a vector so far.
struct OfVector(Vec<u32>);

impl OfVector {
    fn add<T: Serialize + ?Sized>(&mut self, value: &T) -> Result<(), Unfit> {
        match value.serialize(OfMember)? {
            (of, words) if of == "f32" => self.0.extend(words),
            (of, _) => return Err(Unfit(format!("a vector of `{of}`; only vectors of real numbers can be"))),
        }
        Ok(())
    }

    fn finish(self) -> Result<Member, Unfit> {
        match self.0.len() {
            count @ 2..=4 => Ok((format!("vec{count}<f32>"), self.0)),
            count => Err(Unfit(format!("{count} numbers; a vector has two to four"))),
        }
    }
}

/// The methods of a serializer that refuse what is not meant.
macro_rules! refuse {
    ($($method:ident($($type:ty),*) -> $result:ty: $what:literal;)*) => {
        $(fn $method(self, $(_: $type),*) -> Result<$result, Unfit> {
            Err(Unfit::custom(concat!($what, " is nothing that a shader can have")))
        })*
    };
}

/// Those that neither a struct nor a member is.
macro_rules! refuse_all {
    () => {
        refuse! {
            serialize_char(char) -> Self::Ok: "a letter";
            serialize_str(&str) -> Self::Ok: "a text";
            serialize_bytes(&[u8]) -> Self::Ok: "a text";
            serialize_none() -> Self::Ok: "a value that is not there";
            serialize_unit_variant(&'static str, u32, &'static str) -> Self::Ok: "a choice";
            serialize_map(Option<usize>) -> Self::SerializeMap: "a map";
            serialize_tuple_variant(&'static str, u32, &'static str, usize) -> Self::SerializeTupleVariant: "a choice";
            serialize_struct_variant(&'static str, u32, &'static str, usize) -> Self::SerializeStructVariant: "a choice";
        }

        fn serialize_some<T: Serialize + ?Sized>(self, value: &T) -> Result<Self::Ok, Unfit> {
            value.serialize(self)
        }

        fn serialize_newtype_struct<T: Serialize + ?Sized>(self, _: &'static str, value: &T) -> Result<Self::Ok, Unfit> {
            value.serialize(self)
        }

        fn serialize_newtype_variant<T: Serialize + ?Sized>(
            self,
            _: &'static str,
            _: u32,
            _: &'static str,
            _: &T,
        ) -> Result<Self::Ok, Unfit> {
            Err(Unfit::custom("a choice is nothing that a shader can have"))
        }
    };
}

impl Serializer for OfStruct {
    type Ok = Parameters;
    type Error = Unfit;
    type SerializeSeq = Impossible<Parameters, Unfit>;
    type SerializeTuple = Impossible<Parameters, Unfit>;
    type SerializeTupleStruct = Impossible<Parameters, Unfit>;
    type SerializeTupleVariant = Impossible<Parameters, Unfit>;
    type SerializeMap = Impossible<Parameters, Unfit>;
    type SerializeStruct = Self;
    type SerializeStructVariant = Impossible<Parameters, Unfit>;

    fn serialize_struct(self, _: &'static str, _: usize) -> Result<Self, Unfit> {
        Ok(self)
    }

    fn serialize_unit(self) -> Result<Parameters, Unfit> {
        Ok(Parameters::default())
    }

    fn serialize_unit_struct(self, _: &'static str) -> Result<Parameters, Unfit> {
        Ok(Parameters::default())
    }

    refuse! {
        serialize_bool(bool) -> Parameters: "a number without a name";
        serialize_i8(i8) -> Parameters: "a number without a name";
        serialize_i16(i16) -> Parameters: "a number without a name";
        serialize_i32(i32) -> Parameters: "a number without a name";
        serialize_i64(i64) -> Parameters: "a number without a name";
        serialize_u8(u8) -> Parameters: "a number without a name";
        serialize_u16(u16) -> Parameters: "a number without a name";
        serialize_u32(u32) -> Parameters: "a number without a name";
        serialize_u64(u64) -> Parameters: "a number without a name";
        serialize_f32(f32) -> Parameters: "a number without a name";
        serialize_f64(f64) -> Parameters: "a number without a name";
        serialize_seq(Option<usize>) -> Self::SerializeSeq: "a list without a name";
        serialize_tuple(usize) -> Self::SerializeTuple: "a list without a name";
        serialize_tuple_struct(&'static str, usize) -> Self::SerializeTupleStruct: "a list without a name";
    }
    refuse_all!();
}

/// One member.
struct OfMember;

fn too_large(value: impl Display) -> Unfit {
    Unfit(format!("{value} is more than 32 bits hold"))
}

impl Serializer for OfMember {
    type Ok = Member;
    type Error = Unfit;
    type SerializeSeq = Impossible<Member, Unfit>;
    type SerializeTuple = OfVector;
    type SerializeTupleStruct = OfVector;
    type SerializeTupleVariant = Impossible<Member, Unfit>;
    type SerializeMap = Impossible<Member, Unfit>;
    type SerializeStruct = Impossible<Member, Unfit>;
    type SerializeStructVariant = Impossible<Member, Unfit>;

    fn serialize_bool(self, value: bool) -> Result<Member, Unfit> {
        self.serialize_u32(value.into())
    }

    fn serialize_i8(self, value: i8) -> Result<Member, Unfit> {
        self.serialize_i32(value.into())
    }

    fn serialize_i16(self, value: i16) -> Result<Member, Unfit> {
        self.serialize_i32(value.into())
    }

    fn serialize_i32(self, value: i32) -> Result<Member, Unfit> {
        Ok(("i32".into(), vec![value.cast_unsigned()]))
    }

    fn serialize_i64(self, value: i64) -> Result<Member, Unfit> {
        self.serialize_i32(value.try_into().map_err(|_| too_large(value))?)
    }

    fn serialize_u8(self, value: u8) -> Result<Member, Unfit> {
        self.serialize_u32(value.into())
    }

    fn serialize_u16(self, value: u16) -> Result<Member, Unfit> {
        self.serialize_u32(value.into())
    }

    fn serialize_u32(self, value: u32) -> Result<Member, Unfit> {
        Ok(("u32".into(), vec![value]))
    }

    fn serialize_u64(self, value: u64) -> Result<Member, Unfit> {
        self.serialize_u32(value.try_into().map_err(|_| too_large(value))?)
    }

    fn serialize_f32(self, value: f32) -> Result<Member, Unfit> {
        Ok(("f32".into(), vec![value.to_bits()]))
    }

    fn serialize_f64(self, value: f64) -> Result<Member, Unfit> {
        self.serialize_f32(value as f32)
    }

    fn serialize_tuple(self, _: usize) -> Result<OfVector, Unfit> {
        Ok(OfVector(Vec::new()))
    }

    fn serialize_tuple_struct(self, _: &'static str, _: usize) -> Result<OfVector, Unfit> {
        Ok(OfVector(Vec::new()))
    }

    refuse! {
        serialize_seq(Option<usize>) -> Self::SerializeSeq: "a list of any length";
        serialize_unit() -> Member: "nothing";
        serialize_unit_struct(&'static str) -> Member: "nothing";
        serialize_struct(&'static str, usize) -> Self::SerializeStruct: "a struct in a struct";
    }
    refuse_all!();
}

impl SerializeTuple for OfVector {
    type Ok = Member;
    type Error = Unfit;

    fn serialize_element<T: Serialize + ?Sized>(&mut self, value: &T) -> Result<(), Unfit> {
        self.add(value)
    }

    fn end(self) -> Result<Member, Unfit> {
        self.finish()
    }
}

impl SerializeTupleStruct for OfVector {
    type Ok = Member;
    type Error = Unfit;

    fn serialize_field<T: Serialize + ?Sized>(&mut self, value: &T) -> Result<(), Unfit> {
        self.add(value)
    }

    fn end(self) -> Result<Member, Unfit> {
        self.finish()
    }
}

#[cfg(test)]
mod tests;
