//! Materials of which each copy of a body has one of its own.

use super::schema::{Body, Material, PerCopy};
use super::syntax::{Kind, Node, Path, Segment, Span, parse};

/// A material of a body with [`per_copy`](Body::per_copy).
pub struct CopiedMaterial {
    /// The material, and where what differs stands in it: the last place first.
    text: String,
    varied: Vec<Varied>,
}

/// A parameter that differs.
struct Varied {
    key: String,
    at: Span,
    values: Vec<f64>,
}

impl CopiedMaterial {
    /// Of a material of that name; `None` where nothing of it differs.
    pub fn of(body: &Body, name: &str, material: &Material) -> Option<Self> {
        let text = ron::to_string(material).ok()?;
        let root = parse(&text).root;
        let of_key = |(key, values): (&String, &PerCopy)| {
            let (of, way) = split(key).ok()?;
            let node = way.find(&root).ok().filter(|node| of == name && matches!(node.kind, Kind::Number))?;
            let values = values.values(key, body.copies as usize);
            Some(Varied { key: key.clone(), at: node.span.clone(), values })
        };
        let mut varied: Vec<Varied> = body.per_copy.iter().filter_map(of_key).collect();
        varied.sort_by_key(|varied| std::cmp::Reverse(varied.at.start));
        // two names of one place: told when the scene is validated
        varied.dedup_by_key(|varied| varied.at.start);
        (!varied.is_empty()).then_some(Self { text, varied })
    }

    /// The material of a copy.
    pub fn of_copy(&self, copy: usize) -> Option<Material> {
        let mut text = self.text.clone();
        for varied in &self.varied {
            text.replace_range(varied.at.clone(), &format!("{:?}", varied.values.get(copy)?));
        }
        ron::from_str(&text).ok()
    }

    /// The key of the first parameter that differs, and what all of them are in a copy.
    pub fn parameters(&self, copy: usize) -> (&str, String) {
        let each = self.varied.iter().rev().map(|varied| {
            let value = varied.values.get(copy).copied().unwrap_or(f64::NAN);
            format!("{} = {value}", varied.key)
        });
        (self.varied.last().map_or("", |varied| &varied.key), each.collect::<Vec<_>>().join(", "))
    }
}

/// The name of the material and the way within it that a key of `per_copy` means.
///
/// # Errors
/// What is wrong with it, in one sentence.
pub fn split(key: &str) -> Result<(String, Path), String> {
    let path = Path::parse(key)?;
    match path.0.split_first() {
        Some((Segment::Name(material), way)) if !way.is_empty() => Ok((material.clone(), Path(way.to_vec()))),
        _ => Err(format!("`{key}` names no parameter of a material")),
    }
}

/// Ways to all parameters of a material that may differ from copy to copy: numbers of its elastic law, unless that is
/// one of the user's own, and what fibres are stiff by.
pub fn parameters(material: &Material) -> Vec<String> {
    let Ok(text) = ron::to_string(material) else { return Vec::new() };
    let mut all = Vec::new();
    // what differs from element to element is no copy's
    let differs = |law: &&str| *law == "law" || material.by_frame().is_some();
    let laws = material.elastic_laws().into_iter().filter(|law| !differs(law));
    for place in laws.chain(["fibres", "exponential_fibres"]) {
        let way = Path::default().name(place);
        if let Ok(node) = way.find(&parse(&text).root) {
            numbers(node, &way, &mut all);
        }
    }
    // directions and shares have no such number
    let is_stiffness = |way: &Path| match way.0.as_slice() {
        [Segment::Name(effect), .., last] if effect.contains("fibres") => {
            matches!(last, Segment::Name(field) if ["eta", "k1", "k2"].contains(&field.as_str()))
        }
        _ => true,
    };
    all.into_iter().filter(is_stiffness).map(|way| way.to_string()).collect()
}

/// Ways to all numbers in a tree.
fn numbers(node: &Node, way: &Path, all: &mut Vec<Path>) {
    match &node.kind {
        Kind::Number => all.push(way.clone()),
        Kind::Fields(fields) => fields.iter().for_each(|field| numbers(&field.value, &way.name(&field.name.text), all)),
        Kind::Tuple(items) if items.len() == 1 && node.name.is_some() => numbers(&items[0], way, all),
        Kind::List(items) | Kind::Tuple(items) => {
            items.iter().enumerate().for_each(|(number, item)| numbers(item, &way.index(number), all));
        }
        _ => {}
    }
}
