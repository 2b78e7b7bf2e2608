//! Displacement fields on different meshes against each other.

use super::richardson::{extrapolate, extrapolate_two, gain_of_two};
use super::solver::{BodyField, Field};
use glam::DVec3;
use sinew::mesh::Locator;

/// How far outside of the reference's mesh a node may lie and still be compared, in element sizes: outlines of curved
/// bodies are polygons that differ from mesh to mesh.
const OUTSIDE: f64 = 0.5;

/// A field that others are measured against.
#[derive(Clone, Debug)]
pub struct FieldReference {
    /// What it was made of: one solution, or three on finer and finer meshes.
    parts: Vec<Field>,
    /// For three parts: how many times the last difference the limit lies beyond the finest.
    gain: f64,
    /// How far it may be off, relative: at the end, over time, and the largest distance at the end.
    pub uncertainty: [f64; 3],
    /// The observed order, for three parts.
    pub order: Option<f64>,
}

/// Distance of a field from a reference, relative; mass-weighted root mean square unless said otherwise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FieldError {
    /// Over the reference's own length at the end.
    pub at_end: f64,
    /// All times together.
    pub over_time: f64,
    /// The largest distance of a node at the end, over the largest displacement.
    pub largest: f64,
}

impl FieldError {
    /// In the order of [`FieldReference::uncertainty`].
    pub fn all(&self) -> [f64; 3] {
        [self.at_end, self.over_time, self.largest]
    }
}

/// Nodes at which fields are compared: masses, and values of one field after the other.
struct Sample {
    masses: Vec<f64>,
    /// Whether the node is a node of the first other mesh too, where nothing is interpolated.
    shared: Vec<bool>,
    /// One list a time, all bodies in order.
    own: Vec<Vec<DVec3>>,
    others: Vec<Vec<Vec<DVec3>>>,
}

impl FieldReference {
    /// A field as it is, which may be off by `uncertainty` (relative).
    pub fn given(field: Field, uncertainty: f64) -> Self {
        Self { parts: vec![field], gain: 0.0, uncertainty: [uncertainty; 3], order: None }
    }

    /// From three meshes with cells of `sizes`, descending. `nested`: each coarser mesh's nodes are nodes of the finer
    /// ones; only then is the limit extrapolated, since elsewhere interpolation would spoil what extrapolation gains.
    pub fn of_three(sizes: [f64; 3], fields: [Field; 3], nested: bool) -> Option<Self> {
        let [coarse, middle, fine] = fields;
        let sample = sample(&coarse, &[&middle, &fine])?;
        let weigh = |values: &[DVec3]| -> Vec<f64> {
            let weighted = values.iter().zip(&sample.masses).map(|(value, mass)| *value * mass.sqrt());
            weighted.flat_map(|value| value.to_array()).collect()
        };
        let flat = |list: &[Vec<DVec3>]| list.iter().flat_map(|values| weigh(values)).collect::<Vec<f64>>();
        let length = |values: &[f64]| values.iter().map(|value| value * value).sum::<f64>().sqrt();
        let all = [flat(&sample.own), flat(&sample.others[0]), flat(&sample.others[1])];
        let over_time = extrapolate(sizes, [&all[0], &all[1], &all[2]], length);
        let ends = [&sample.own, &sample.others[0], &sample.others[1]].map(|list| list.last().map(|v| weigh(v)));
        let [Some(a), Some(b), Some(c)] = &ends else { return None };
        let end = extrapolate(sizes, [a, b, c], length);
        let lengths = [length(c), length(&all[2])];
        // what extrapolation leaves of a node's error it leaves, near enough, of the largest one
        let largest = |a: &[DVec3], b: &[DVec3]| {
            a.iter()
                .zip(b)
                .zip(&sample.masses)
                .filter(|(_, mass)| **mass > 0.0)
                .map(|((a, b), _)| a.distance(*b))
                .fold(0.0, f64::max)
        };
        let (Some(middle_end), Some(fine_end)) = (sample.others[0].last(), sample.others[1].last()) else {
            return None;
        };
        let top = fine_end.iter().map(|u| u.length()).fold(0.0, f64::max);
        let near = length(&b.iter().zip(c).map(|(b, c)| b - c).collect::<Vec<_>>());
        let spread = if near > 0.0 { end.uncertainty / near } else { 0.0 };
        let gain = end.order.map_or(0.0, |order| sizes[2].powf(order) / (sizes[1].powf(order) - sizes[2].powf(order)));
        let mut uncertainty = [
            end.uncertainty / lengths[0],
            over_time.uncertainty / lengths[1],
            spread * largest(middle_end, fine_end) / top,
        ];
        let order = end.order;
        if !nested && gain > 0.0 {
            // the finest field as it is, off by all that extrapolation would add, and a quarter more
            let step = |distance: f64| 1.25 * gain * distance;
            let all_near = length(&all[1].iter().zip(&all[2]).map(|(b, c)| b - c).collect::<Vec<_>>());
            uncertainty =
                [step(near) / lengths[0], step(all_near) / lengths[1], step(largest(middle_end, fine_end)) / top];
            return Some(Self { parts: vec![fine], gain: 0.0, uncertainty, order });
        }
        Some(Self { parts: vec![middle, fine], gain, uncertainty, order })
    }

    /// From two meshes with cells of `sizes`, descending, as [`FieldReference::of_three`] from three.
    pub fn of_two(sizes: [f64; 2], fields: [Field; 2], nested: bool) -> Option<Self> {
        let [middle, fine] = fields;
        let apart = Self::given(fine.clone(), 0.0).error_of(&middle)?.all();
        let doubt = |apart: f64| extrapolate_two(sizes, [&[apart], &[0.0]], |value| value[0].abs()).uncertainty;
        let gain = gain_of_two(sizes);
        if !nested {
            let uncertainty = apart.map(|apart| doubt(apart) + gain * apart);
            return Some(Self { parts: vec![fine], gain: 0.0, uncertainty, order: None });
        }
        Some(Self { parts: vec![middle, fine], gain, uncertainty: apart.map(doubt), order: None })
    }

    /// How far a field is from this one; `None` where they have no nodes, bodies or times in common, or where nothing
    /// moves.
    pub fn error_of(&self, field: &Field) -> Option<FieldError> {
        let parts: Vec<&Field> = self.parts.iter().collect();
        let mut sample = sample(field, &parts)?;
        if self.gain != 0.0 && sample.shared.contains(&true) {
            // between the nodes of the coarser mesh, extrapolation would multiply the errors of interpolation
            sample.keep_shared();
        }
        let (fine, middle) = (sample.others.last()?, sample.others.first()?);
        let times = sample.own.len();
        let reference: Vec<Vec<DVec3>> = (0..times)
            .map(|t| fine[t].iter().zip(&middle[t]).map(|(f, m)| *f + self.gain * (*f - *m)).collect())
            .collect();
        compare(&sample.masses, &sample.own, &reference)
    }
}

impl Sample {
    fn keep_shared(&mut self) {
        let shared = std::mem::take(&mut self.shared);
        let keep = |values: &mut Vec<DVec3>| {
            let mut marks = shared.iter();
            values.retain(|_| marks.next().is_some_and(|shared| *shared));
        };
        self.own.iter_mut().for_each(keep);
        self.others.iter_mut().flatten().for_each(keep);
        let mut marks = shared.iter();
        self.masses.retain(|_| marks.next().is_some_and(|shared| *shared));
    }
}

/// How far two fields on the same mesh are apart, relative to the second.
pub fn same_mesh(a: &Field, b: &Field) -> Option<FieldError> {
    let sample = sample(a, &[b])?;
    compare(&sample.masses, &sample.own, &sample.others[0])
}

fn compare(masses: &[f64], own: &[Vec<DVec3>], reference: &[Vec<DVec3>]) -> Option<FieldError> {
    let (mut away, mut length, mut last) = (0.0, 0.0, (0.0, 0.0));
    for (own, reference) in own.iter().zip(reference) {
        let sum = |of: &dyn Fn(usize) -> f64| (0..masses.len()).map(|i| masses[i] * of(i)).sum::<f64>();
        last = (sum(&|i| own[i].distance_squared(reference[i])), sum(&|i| reference[i].length_squared()));
        (away, length) = (away + last.0, length + last.1);
    }
    let (own, reference) = (own.last()?, reference.last()?);
    let loose = |i: &usize| masses[*i] > 0.0;
    let largest = (0..masses.len()).filter(loose).map(|i| own[i].distance(reference[i])).fold(0.0, f64::max);
    let top = (0..masses.len()).filter(loose).map(|i| reference[i].length()).fold(0.0, f64::max);
    // a field that has come back to rest is measured against where it has been
    let end = if last.1 > 1e-4 * length { last.1 } else { length };
    let error = FieldError {
        at_end: (last.0 / end).sqrt(),
        over_time: (away / length).sqrt(),
        largest: largest / top.max(1e-300),
    };
    (length > 0.0 && error.all().iter().all(|error| error.is_finite())).then_some(error)
}

/// Where a node lies in another mesh.
#[derive(Clone, Copy, PartialEq)]
enum At {
    Node,
    Between,
    Outside,
}

/// Values of fields at the nodes of the first: its own, and the others' interpolated.
fn sample(own: &Field, others: &[&Field]) -> Option<Sample> {
    let times = own.times.len();
    let none = vec![Vec::new(); times];
    let mut sample =
        Sample { masses: Vec::new(), shared: Vec::new(), own: none.clone(), others: vec![none; others.len()] };
    for (name, body) in &own.bodies {
        let mut nodes = vec![At::Node; body.mesh.points.len()];
        let mut shared: Option<Vec<bool>> = None;
        let mut found: Vec<Vec<Vec<DVec3>>> = Vec::new();
        for other in others {
            let other_body = other.bodies.get(name).filter(|_| other.times.len() == times)?;
            found.push(at_nodes(body, other_body, &mut nodes));
            shared.get_or_insert_with(|| nodes.iter().map(|at| *at == At::Node).collect());
        }
        for node in (0..nodes.len()).filter(|&node| nodes[node] != At::Outside) {
            sample.masses.push(body.masses[node]);
            sample.shared.push(shared.as_ref().is_some_and(|shared| shared[node]));
            for time in 0..times {
                sample.own[time].push(body.displacements[time][node]);
                for (values, found) in sample.others.iter_mut().zip(&found) {
                    values[time].push(found[time][node]);
                }
            }
        }
    }
    (!sample.masses.is_empty()).then_some(sample)
}

/// Displacements of `other` at the nodes of `body`, one list a time. Marks where nodes lie in the other's
/// mesh; a mark that says less stays.
fn at_nodes(body: &BodyField, other: &BodyField, nodes: &mut [At]) -> Vec<Vec<DVec3>> {
    let points = &body.mesh.points;
    if *points == other.mesh.points {
        return other.displacements.clone();
    }
    let mut values = vec![vec![DVec3::ZERO; points.len()]; other.displacements.len()];
    let locator = Locator::new(&other.mesh);
    for (node, point) in points.iter().enumerate() {
        let Some(location) = locator.locate(*point).filter(|location| location.outside <= OUTSIDE) else {
            nodes[node] = At::Outside;
            continue;
        };
        if nodes[node] == At::Node && location.weights.iter().all(|weight| *weight < 1.0 - 1e-6) {
            nodes[node] = At::Between;
        }
        let corners = other.mesh.element(location.element);
        for (values, displacements) in values.iter_mut().zip(&other.displacements) {
            let shares = corners.iter().zip(location.weights);
            values[node] = shares.map(|(&corner, weight)| weight * displacements[corner as usize]).sum();
        }
    }
    values
}
