//! One frame of a series: the mesh, who is who in it, and the fields that the scene asks for.

use super::contact_fields::contact_field;
use super::element_fields::{BodyElements, ElementFields, ElementRows};
use super::fields::{internal_forces, reaction};
use crate::backend::cpu::Cpu;
use crate::backend::device::bring_to_host;
use crate::components::*;
use crate::error::Error;
use crate::mesh::{CellKind, Cells};
use crate::output::{Array, Frame, Series, Values, write_vtu};
use crate::scene::schema::{Output, OutputField};
use bevy_ecs::prelude::*;
use glam::DVec3;
use std::collections::BTreeMap;
use std::path::Path;

/// Which fields are written, and whether removed elements are, too. A resource.
#[derive(Resource, Clone, Debug, Default)]
pub struct WrittenFields {
    /// The fields.
    pub fields: Vec<OutputField>,
    /// Whether elements stay in the files when they are removed.
    pub removed_elements: bool,
}

impl From<&Output> for WrittenFields {
    fn from(output: &Output) -> Self {
        Self { fields: output.fields().to_vec(), removed_elements: output.removed_elements }
    }
}

/// What goes into a frame, body after body.
#[derive(Default)]
struct Parts {
    points: Vec<DVec3>,
    /// Numbers of bodies and nodes, one a point.
    point_body: Vec<u32>,
    node: Vec<i64>,
    /// A field of nodes each.
    vectors: Vec<Vec<f32>>,
    cells: Cells,
    /// What the cells of each kind are.
    rows: BTreeMap<CellKind, ElementRows>,
}

/// Writes all bodies as one frame; or what of them is not finite, and nothing is written.
///
/// # Errors
/// What the GPU says; files that cannot be written.
pub fn write(world: &mut World, series: &mut Series) -> Result<Option<String>, Error> {
    let wanted = world.get_resource::<WrittenFields>().cloned().unwrap_or_default();
    let of_nodes: Vec<OutputField> = wanted.fields.iter().copied().filter(|field| field.is_of_nodes()).collect();
    let elements = ElementFields::new(&wanted, world)?;
    let bodies = bodies(world);
    let mut parts = Parts { vectors: vec![Vec::new(); of_nodes.len()], ..Parts::default() };
    for (number, body) in bodies.iter().enumerate() {
        for (field, values) in of_nodes.iter().zip(&mut parts.vectors) {
            values.extend(node_numbers(*field, *body, world)?.into_iter().map(|number| number as f32));
        }
        let (Some(authoring), Some(rest)) = (world.get::<Authoring>(*body), world.get::<RestPosition>(*body)) else {
            continue;
        };
        let first = parts.points.len() as u32;
        parts.points.extend(authoring.node_rows.iter().map(|&row| rest.0[row as usize]));
        parts.point_body.resize(parts.points.len(), number as u32);
        parts.node.extend((0..authoring.node_rows.len()).map(|place| authoring.node_ids.of(place) as i64));
        let found = elements.of_body(number as u32, *body, world);
        parts.add(&authoring.cells, first, &found);
    }
    put_together(&wanted, &of_nodes, &elements, parts, world, series)
}

/// The bodies in the order of their names.
pub(super) fn bodies(world: &mut World) -> Vec<Entity> {
    let mut bodies: Vec<(Label, Entity)> =
        world.query_filtered::<(&Label, Entity), With<Authoring>>().iter(world).map(|(l, e)| (l.clone(), e)).collect();
    bodies.sort();
    bodies.into_iter().map(|(_, body)| body).collect()
}

/// Writes the mesh at rest with all elements, where some have gone and frames lack them: what is bared in the first
/// frame of a run that goes on from a snapshot can be told from no frame.
///
/// # Errors
/// What the GPU says; a file that cannot be written.
pub fn write_whole(world: &mut World, path: &Path) -> Result<(), Error> {
    if world.get_resource::<WrittenFields>().is_some_and(|wanted| wanted.removed_elements) {
        return Ok(());
    }
    bring_to_host(world, |_, name| name == Alive::NAME)?;
    let lacks = |(block, alive): (&Block, &Alive)| alive.iter().take(block.count).any(|alive| *alive == 0);
    if !world.query::<(&Block, &Alive)>().iter(world).any(lacks) {
        return Ok(());
    }
    let (mut points, mut cells) = (Vec::new(), Cells::default());
    for body in bodies(world) {
        let (Some(authoring), Some(rest)) = (world.get::<Authoring>(body), world.get::<RestPosition>(body)) else {
            continue;
        };
        let first = points.len() as u32;
        points.extend(authoring.node_rows.iter().map(|&row| rest.0[row as usize]));
        cells.extend_moved(&authoring.cells, first);
    }
    let (point_arrays, cell_arrays) = (Vec::new(), Vec::new());
    let frame = Frame { time: 0.0, points: &points, cells: &cells, point_arrays, cell_arrays };
    world.resource::<Cpu>().confine(|| write_vtu(path, &frame))?;
    Ok(())
}

impl Parts {
    /// Adds the cells of a body that are written; its points begin at `first`.
    fn add(&mut self, cells: &Cells, first: u32, found: &BodyElements<'_>) {
        for (kind, rows, nodes) in cells.blocks() {
            let own = self.rows.entry(kind).or_default();
            self.cells.reserve(kind, rows.len());
            let kept = rows.zip(nodes.chunks_exact(kind.node_count())).filter(|(row, _)| found.put(*row, own));
            self.cells.extend_kind(kind, kept.flat_map(|(_, nodes)| nodes.iter().map(move |node| node + first)));
        }
    }
}

fn put_together(
    wanted: &WrittenFields,
    of_nodes: &[OutputField],
    elements: &ElementFields,
    parts: Parts,
    world: &World,
    series: &mut Series,
) -> Result<Option<String>, Error> {
    // cells of one kind of all bodies come before those of the next
    let cells = parts.rows.into_values().fold(ElementRows::default(), ElementRows::and);
    let columns = elements.columns(&cells);
    let points = of_nodes
        .iter()
        .zip(&parts.vectors)
        .map(|(field, values)| (field.array().to_string(), field.components(), values));
    let cell_fields = columns.iter().map(|column| (column.name.clone(), column.components, &column.values));
    let real: Vec<(String, usize, &Vec<f32>)> = points.chain(cell_fields).collect();
    if let Some((name, ..)) = real.iter().find(|(.., values)| values.iter().any(|value| !value.is_finite())) {
        return Ok(Some(format!("the field {name}")));
    }
    let (of_points, of_cells) = real.split_at(of_nodes.len());
    let mut point_arrays: Vec<Array<'_>> =
        of_points.iter().map(|(n, c, v)| Array { name: n, components: *c, values: Values::F32(v) }).collect();
    point_arrays.push(Array { name: "body", components: 1, values: Values::U32(&parts.point_body) });
    point_arrays.push(Array { name: "node", components: 1, values: Values::I64(&parts.node) });
    let mut cell_arrays: Vec<Array<'_>> =
        of_cells.iter().map(|(n, c, v)| Array { name: n, components: *c, values: Values::F32(v) }).collect();
    if wanted.removed_elements {
        cell_arrays.push(Array { name: "alive", components: 1, values: Values::U8(&cells.alive) });
    }
    cell_arrays.push(Array { name: "body", components: 1, values: Values::U32(&cells.body) });
    cell_arrays.push(Array { name: "material", components: 1, values: Values::U32(&cells.material) });
    cell_arrays.push(Array { name: "element", components: 1, values: Values::I64(&cells.element) });
    let time = world.resource::<Clock>().time();
    let frame = Frame { time, points: &parts.points, cells: &parts.cells, point_arrays, cell_arrays };
    // parts of a file are compressed side by side
    world.resource::<Cpu>().confine(|| series.write(&frame))?;
    Ok(None)
}

/// A field of a body at the present step in the author's order: its numbers, one after the other, and how many there
/// are of each node or element. Of several families of fibres that of the first.
///
/// # Errors
/// What the GPU says.
pub fn field_of(field: OutputField, body: Entity, world: &mut World) -> Result<(Vec<f32>, usize), Error> {
    let components = field.components();
    if field.is_of_nodes() {
        let numbers = node_numbers(field, body, world)?;
        return Ok((numbers.into_iter().map(|number| number as f32).collect(), components));
    }
    let wanted = WrittenFields { fields: vec![field], removed_elements: true };
    let elements = ElementFields::new(&wanted, world)?;
    let count = world.get::<Authoring>(body).map_or(0, |authoring| authoring.cells.len());
    let (found, mut rows) = (elements.of_body(0, body, world), ElementRows::default());
    (0..count).for_each(|place| {
        found.put(place, &mut rows);
    });
    Ok((elements.columns(&rows).into_iter().next().map(|column| column.values).unwrap_or_default(), components))
}

/// A field of a body's nodes in the author's order, its numbers one after the other.
fn node_numbers(field: OutputField, body: Entity, world: &mut World) -> Result<Vec<f64>, Error> {
    if field.is_of_contact() {
        return contact_field(field, body, world);
    }
    let vectors = node_vectors(field, body, world)?;
    Ok(vectors.into_iter().flat_map(|vector| vector.to_array()).collect())
}

/// A field of vectors of a body's nodes in the author's order.
fn node_vectors(field: OutputField, body: Entity, world: &mut World) -> Result<Vec<DVec3>, Error> {
    let columns: &[&str] = match field {
        OutputField::InternalForce => return internal_forces(world, body),
        OutputField::Displacement => &[Displacement::NAME],
        OutputField::Velocity => &[DisplacementIncrement::NAME],
        OutputField::ExternalForce => &[ExternalForce::NAME],
        _ => &[InternalForce::NAME, ExternalForce::NAME],
    };
    bring_to_host(world, |entity, name| entity == body && columns.contains(&name))?;
    let rate = world.resource::<Clock>().rate();
    let entity = world.entity(body);
    let vector = |reals: Option<&Reals>, row: usize| reals.map_or(DVec3::ZERO, |reals| reals.vector(row));
    let external = |row: usize| vector(entity.get::<ExternalForce>().map(|f| &f.0), row);
    let value = |row: usize| match field {
        OutputField::Displacement => vector(entity.get::<Displacement>().map(|u| &u.0), row),
        OutputField::Velocity => vector(entity.get::<DisplacementIncrement>().map(|d| &d.0), row) * rate,
        OutputField::ExternalForce => external(row),
        _ => reaction(entity, row),
    };
    let Some(authoring) = entity.get::<Authoring>() else { return Ok(Vec::new()) };
    Ok(authoring.node_rows.iter().map(|&row| value(row as usize)).collect())
}
