//! PLY files: points and polygons, as text or binary. Properties but places and corners belong to pictures.

use super::{Triangles, polygon};
use crate::Fault;
use glam::DVec3;

const RULE: &str = "a PLY file has a head up to `end_header`, with an element `vertex` that has x, y and z, and an element \
                    `face` that has a list of corners, `vertex_indices`";

/// A kind of number: its bytes, and how they are read.
#[derive(Clone, Copy)]
struct Number {
    bytes: usize,
    read: fn([u8; 8]) -> f64,
}

impl Number {
    /// By its name; `read` takes the bytes in little-endian order, the first ones count.
    fn of(name: &str) -> Option<Self> {
        let number = |bytes: usize, read: fn([u8; 8]) -> f64| Some(Self { bytes, read });
        match name {
            "char" | "int8" => number(1, |b| f64::from(b[0] as i8)),
            "uchar" | "uint8" => number(1, |b| f64::from(b[0])),
            "short" | "int16" => number(2, |b| f64::from(i16::from_le_bytes([b[0], b[1]]))),
            "ushort" | "uint16" => number(2, |b| f64::from(u16::from_le_bytes([b[0], b[1]]))),
            "int" | "int32" => number(4, |b| f64::from(i32::from_le_bytes([b[0], b[1], b[2], b[3]]))),
            "uint" | "uint32" => number(4, |b| f64::from(u32::from_le_bytes([b[0], b[1], b[2], b[3]]))),
            "float" | "float32" => number(4, |b| f64::from(f32::from_le_bytes([b[0], b[1], b[2], b[3]]))),
            "double" | "float64" => number(8, f64::from_le_bytes),
            _ => None,
        }
    }
}

/// A property of an element: one number, or a list with the kind of number that its length is.
struct Property {
    name: String,
    of: Number,
    length: Option<Number>,
}

struct Element {
    name: String,
    count: u64,
    properties: Vec<Property>,
}

/// How numbers stand in the file.
#[derive(Clone, Copy, PartialEq)]
enum Form {
    Text,
    Little,
    Big,
}

/// What follows the head.
struct Data<'a> {
    rest: &'a [u8],
    form: Form,
}

impl Data<'_> {
    fn number(&mut self, kind: Number) -> Option<f64> {
        if self.form == Form::Text {
            self.rest = self.rest.trim_ascii_start();
            let end = self.rest.iter().position(u8::is_ascii_whitespace).unwrap_or(self.rest.len());
            let (word, rest) = self.rest.split_at(end);
            self.rest = rest;
            return std::str::from_utf8(word).ok()?.parse().ok();
        }
        let (own, rest) = self.rest.split_at_checked(kind.bytes)?;
        self.rest = rest;
        let mut bytes = [0; 8];
        bytes[..kind.bytes].copy_from_slice(own);
        if self.form == Form::Big {
            bytes[..kind.bytes].reverse();
        }
        Some((kind.read)(bytes))
    }

    /// The values of a property: one, or those of a list.
    fn values(&mut self, property: &Property, values: &mut Vec<f64>) -> Option<()> {
        values.clear();
        let count = property.length.map_or(Some(1.0), |length| self.number(length))?;
        if !(count >= 0.0 && count.fract() == 0.0) {
            return None;
        }
        // what a file claims and does not have ends it
        for _ in 0..count as u64 {
            values.push(self.number(property.of)?);
        }
        Some(())
    }
}

/// Reads the points and polygons of a file that begins with `ply`.
pub(super) fn read(bytes: &[u8]) -> Result<Triangles, Fault> {
    let wrong = |what: String| Fault::whole(what, RULE);
    let (head, rest) = head(bytes).ok_or_else(|| wrong("the head of the file has no end".into()))?;
    let (elements, form) = elements(&head).map_err(wrong)?;
    let mut data = Data { rest, form };
    let mut read = Triangles::default();
    let mut polygons = Polygons::default();
    let mut values = Vec::new();
    for element in elements.iter().filter(|element| !element.properties.is_empty()) {
        for row in 0..element.count {
            let mut point = [f64::NAN; 3];
            for property in &element.properties {
                let short = || wrong(format!("the file ends, or is no number, in {} {row}", element.name));
                data.values(property, &mut values).ok_or_else(short)?;
                let axis = ["x", "y", "z"].iter().position(|name| *name == property.name);
                match (element.name.as_str(), axis, property.length.is_some()) {
                    ("vertex", Some(axis), false) => point[axis] = values[0],
                    ("face", _, true) if ["vertex_indices", "vertex_index"].contains(&property.name.as_str()) => {
                        polygons.add(&values, row).map_err(wrong)?;
                    }
                    _ => {}
                }
            }
            if element.name == "vertex" {
                if !point.iter().all(|part| part.is_finite()) {
                    return Err(wrong(format!("vertex {row} is no place: {point:?}")));
                }
                read.points.push(DVec3::from_array(point));
            }
        }
    }
    polygons.cut(&mut read).map_err(|(what, allowed)| Fault::whole(what, allowed))?;
    Ok(read)
}

/// Polygons, whose points may follow them.
#[derive(Default)]
struct Polygons {
    /// The rows of their corners, one polygon after the other.
    corners: Vec<u32>,
    /// Of each the row of its face, and where its corners end.
    ends: Vec<(u64, usize)>,
}

impl Polygons {
    fn add(&mut self, corners: &[f64], row: u64) -> Result<(), String> {
        let whole = |corner: &f64| (corner.fract() == 0.0 && (0.0..4e9).contains(corner)).then_some(*corner as u32);
        let rows: Option<Vec<u32>> = corners.iter().map(whole).collect();
        let Some(rows) = rows.filter(|rows| rows.len() > 2) else {
            return Err(format!("face {row} is no polygon: its corners are {corners:?}"));
        };
        self.corners.extend(rows);
        self.ends.push((row, self.corners.len()));
        Ok(())
    }

    /// Makes triangles of them; or says what is wrong, and what is allowed.
    fn cut(self, read: &mut Triangles) -> Result<(), (String, &'static str)> {
        let points = read.points.len();
        if let Some(row) = self.corners.iter().find(|row| **row as usize >= points) {
            return Err((format!("a face names vertex {row}; there are {points}, counted from 0"), RULE));
        }
        let mut begin = 0;
        for (row, end) in self.ends {
            let corners = &self.corners[begin..end];
            let places: Vec<DVec3> = corners.iter().map(|row| read.points[*row as usize]).collect();
            let wrong = |what: String| (format!("face {row}, counted from 0, {what}"), polygon::RULE);
            let triangles = polygon::triangles(&places).map_err(wrong)?;
            read.triangles.extend(triangles.into_iter().map(|triangle| triangle.map(|corner| corners[corner])));
            begin = end;
        }
        Ok(())
    }
}

/// The lines of the head, and what follows it.
fn head(bytes: &[u8]) -> Option<(Vec<String>, &[u8])> {
    let mut rest = bytes;
    let mut lines = Vec::new();
    loop {
        let end = rest.iter().position(|&byte| byte == b'\n')?;
        let line = String::from_utf8_lossy(&rest[..end]).trim().to_string();
        rest = &rest[end + 1..];
        if line == "end_header" {
            return Some((lines, rest));
        }
        lines.push(line);
    }
}

fn elements(head: &[String]) -> Result<(Vec<Element>, Form), String> {
    let (mut all, mut form) = (Vec::<Element>::new(), None);
    for line in head {
        let unknown = || format!("`{line}` in the head");
        let words: Vec<&str> = line.split_whitespace().collect();
        match words[..] {
            ["format", "ascii", _] => form = Some(Form::Text),
            ["format", "binary_little_endian", _] => form = Some(Form::Little),
            ["format", "binary_big_endian", _] => form = Some(Form::Big),
            ["element", name, count] => {
                let count = count.parse().map_err(|_| unknown())?;
                all.push(Element { name: name.to_string(), count, properties: Vec::new() });
            }
            ["property", ref kinds @ .., name] => {
                let number = |name: &str| Number::of(name).ok_or_else(unknown);
                let (of, length) = match kinds {
                    ["list", length, of] => (number(of)?, Some(number(length)?)),
                    [of] => (number(of)?, None),
                    _ => return Err(unknown()),
                };
                let element = all.last_mut().ok_or_else(unknown)?;
                element.properties.push(Property { name: name.to_string(), of, length });
            }
            ["ply" | "comment" | "obj_info", ..] | [] => {}
            _ => return Err(unknown()),
        }
    }
    Ok((all, form.ok_or("the head names no format")?))
}
