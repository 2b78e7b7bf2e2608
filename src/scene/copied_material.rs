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
    of: Part,
    at: Span,
    values: Vec<f64>,
}

/// What of a material a parameter belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// The elastic law, or what fibres are stiff by.
    Law,
    /// What it remembers: viscosity, and damping proportional to stiffness.
    Memory,
    /// Where fibres run.
    Direction,
    /// Density, and damping proportional to mass.
    Inertia,
}

impl Part {
    /// Of a way within a material.
    pub fn of(way: &Path) -> Self {
        let named = |wanted: &str| way.0.iter().any(|segment| matches!(segment, Segment::Name(name) if name == wanted));
        match way.0.first() {
            Some(Segment::Name(first)) if ["density", "damping"].contains(&first.as_str()) => Self::Inertia,
            Some(Segment::Name(first)) if ["prony", "stiffness_damping"].contains(&first.as_str()) => Self::Memory,
            _ if named("direction") => Self::Direction,
            _ => Self::Law,
        }
    }
}

impl CopiedMaterial {
    /// Of a material of that name; `None` where nothing of it differs.
    pub fn of(body: &Body, name: &str, material: &Material) -> Option<Self> {
        let text = ron::to_string(material).ok()?;
        let root = parse(&text).root;
        let of_key = |(key, values): (&String, &PerCopy)| {
            numbers_of(key, values, body.copies as usize).into_iter().filter_map(|(key, values)| {
                let (of, way) = split(&key).ok()?;
                let node = number(way.find(&root).ok()?).filter(|_| of == name)?;
                Some(Varied { of: Part::of(&way), at: node.span.clone(), key, values })
            })
        };
        let mut varied: Vec<Varied> = body.per_copy.iter().flat_map(of_key).collect();
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

    /// Whether anything of a part differs.
    pub fn differs_in(&self, part: Part) -> bool {
        self.varied.iter().any(|varied| varied.of == part)
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

/// The places of numbers that a key of `per_copy` leads to, and the numbers of all copies: of a vector three.
pub fn numbers_of(key: &str, values: &PerCopy, copies: usize) -> Vec<(String, Vec<f64>)> {
    if !values.is_vector() {
        return vec![(key.to_string(), values.values(key, copies))];
    }
    let vectors = values.vectors(key, copies);
    (0..3).map(|axis| (format!("{key}[{axis}]"), vectors.iter().map(|vector| vector[axis]).collect())).collect()
}

/// Ways to all parameters of a material that may differ from copy to copy: numbers of its elastic law and of what it
/// remembers, unless the law is one of the user's own; what fibres are stiff by, and numbers of their directions; its
/// density and damping.
pub fn parameters(material: &Material) -> Vec<String> {
    let Ok(text) = ron::to_string(material) else { return Vec::new() };
    let root = parse(&text).root;
    let mut all = Vec::new();
    let laws = material.elastic_laws();
    // what differs from element to element is no copy's
    let own = laws.contains(&"law") || material.by_frame().is_some();
    let remembered = ["prony", "stiffness_damping"].into_iter().filter(|_| !own);
    let laws = laws.into_iter().filter(|_| !own);
    for place in laws.chain(["fibres", "exponential_fibres"]).chain(remembered).chain(["density", "damping"]) {
        let way = Path::default().name(place);
        if let Ok(node) = way.find(&root) {
            numbers(node, &way, &mut all);
        }
    }
    // shares of fibres have no such number
    let may_differ = |way: &Path| match way.0.as_slice() {
        [Segment::Name(effect), .., last] if effect.contains("fibres") && Part::of(way) == Part::Law => {
            matches!(last, Segment::Name(field) if ["eta", "k1", "k2"].contains(&field.as_str()))
        }
        _ => true,
    };
    all.into_iter().filter(may_differ).map(|way| way.to_string()).collect()
}

/// A number, also one that stands as `Some` of it.
fn number(node: &Node) -> Option<&Node> {
    match &node.kind {
        Kind::Number => Some(node),
        Kind::Tuple(items) if items.len() == 1 && node.name.is_some() => number(&items[0]),
        _ => None,
    }
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
