//! Fields of a body in the author's order, evaluated on the host in f64.

use crate::backend::cpu::{Cpu, ROWS_A_TASK};
use crate::backend::device::bring_to_host;
use crate::components::*;
use crate::error::Error;
use crate::evaluation::{BlockView, node_count, von_mises_and_pressure};
use crate::output::{Array, Frame, Series, Values};
use bevy_ecs::prelude::*;
use glam::DVec3;

/// Fields of one body: nodes and elements in the author's order (tetrahedra, then hexahedra).
#[derive(Clone, Debug, Default)]
pub struct BodyFields {
    /// Displacement of each node (m).
    pub displacement: Vec<DVec3>,
    /// Velocity of each node in the middle of the last step (m/s).
    pub velocity: Vec<DVec3>,
    /// Volume ratio J of each element.
    pub volume_ratio: Vec<f64>,
    /// Cauchy stress of each element (Pa): xx, yy, zz, xy, yz, xz. Zero once removed.
    pub stress: Vec<[f64; 6]>,
    /// 1 while an element is there.
    pub alive: Vec<u8>,
}

const COLUMNS: [&str; 5] =
    [Displacement::NAME, DisplacementStep::NAME, RestShape::NAME, ViscousMemory::NAME, Alive::NAME];

/// What an element contributes: J, Cauchy stress, whether it is there, nodal forces.
type ElementRow = (f64, [f64; 6], u8, [[f64; 3]; 8]);

/// The fields of a body at the present step.
///
/// # Errors
/// What the GPU says.
pub fn body_fields(world: &mut World, body: Entity) -> Result<BodyFields, Error> {
    bring_to_host(world, |_, name| COLUMNS.contains(&name))?;
    let rate = world.resource::<Clock>().rate();
    let mut fields = BodyFields::default();
    let Some(authoring) = world.get::<Authoring>(body) else { return Ok(fields) };
    if let (Some(u), Some(step)) = (world.get::<Displacement>(body), world.get::<DisplacementStep>(body)) {
        fields.displacement = authoring.node_rows.iter().map(|&row| u.vector(row as usize)).collect();
        fields.velocity = authoring.node_rows.iter().map(|&row| step.vector(row as usize) * rate).collect();
    }
    let blocks: Vec<Vec<ElementRow>> = authoring.blocks.iter().map(|&block| elements_of(world, block)).collect();
    for &(block, row) in &authoring.element_rows {
        let (ratio, stress, alive, _) = blocks[block as usize][row as usize];
        fields.volume_ratio.push(ratio);
        fields.stress.push(stress);
        fields.alive.push(alive);
    }
    Ok(fields)
}

/// Internal force of each node (N) at the present displacements, in the author's order.
///
/// # Errors
/// What the GPU says.
pub fn internal_forces(world: &mut World, body: Entity) -> Result<Vec<DVec3>, Error> {
    bring_to_host(world, |_, name| COLUMNS.contains(&name))?;
    let Some(authoring) = world.get::<Authoring>(body) else { return Ok(Vec::new()) };
    let mut by_row = vec![DVec3::ZERO; authoring.node_rows.len()];
    for &entity in &authoring.blocks {
        let (Some(block), Some(connectivity)) = (world.get::<Block>(entity), world.get::<Connectivity>(entity)) else {
            continue;
        };
        for (row, element) in elements_of(world, entity).iter().enumerate() {
            for corner in 0..node_count(block.kind) {
                let node = connectivity[crate::evaluation::lane_place(row, node_count(block.kind), corner)];
                by_row[node as usize] += DVec3::from_array(element.3[corner]);
            }
        }
    }
    Ok(authoring.node_rows.iter().map(|&row| by_row[row as usize]).collect())
}

fn elements_of(world: &World, entity: Entity) -> Vec<ElementRow> {
    let all = (|| {
        let view = BlockView::now(world, entity)?;
        let alive = world.get::<Alive>(entity);
        let element = |row: usize| {
            if alive.is_some_and(|alive| alive[row] == 0) {
                return (1.0, [0.0; 6], 0, [[0.0; 3]; 8]);
            }
            let state = view.element(row);
            (state.volume_ratio(), view.cauchy(row, &state), 1, view.forces(row, &state))
        };
        let task = |task: usize| {
            (task * ROWS_A_TASK..view.block.count.min((task + 1) * ROWS_A_TASK))
                .map(element)
                .collect::<Vec<ElementRow>>()
        };
        Some(world.resource::<Cpu>().map(view.block.count.div_ceil(ROWS_A_TASK), task).concat())
    })();
    all.unwrap_or_default()
}

/// Writes the fields of all bodies as one frame; or what of them is not finite, and nothing is written.
pub fn write(world: &mut World, series: &mut Series) -> Result<Option<String>, Error> {
    let mut bodies: Vec<(Label, Entity)> =
        world.query_filtered::<(&Label, Entity), With<Authoring>>().iter(world).map(|(l, e)| (l.clone(), e)).collect();
    bodies.sort();
    let (mut points, mut tets, mut hexes, mut all) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    for (_, body) in &bodies {
        let fields = body_fields(world, *body)?;
        let (Some(authoring), Some(rest)) = (world.get::<Authoring>(*body), world.get::<RestPosition>(*body)) else {
            continue;
        };
        let first = points.len() as u32;
        points.extend(authoring.node_rows.iter().map(|&row| rest.0[row as usize]));
        tets.extend(authoring.tets.iter().map(|nodes| nodes.map(|node| node + first)));
        hexes.extend(authoring.hexes.iter().map(|nodes| nodes.map(|node| node + first)));
        all.push((authoring.tets.len(), fields));
    }
    let node_vectors = |of: fn(&BodyFields) -> &Vec<DVec3>| -> Vec<f32> {
        all.iter().flat_map(|(_, fields)| of(fields)).flat_map(|v| v.as_vec3().to_array()).collect()
    };
    // tetrahedra of all bodies come before the hexahedra of all bodies
    let elements: Vec<(&BodyFields, usize)> =
        (all.iter().flat_map(|(tets, fields)| (0..*tets).map(move |e| (fields, e))))
            .chain(all.iter().flat_map(|(tets, fields)| (*tets..fields.alive.len()).map(move |e| (fields, e))))
            .collect();
    let of_elements = |of: &dyn Fn(&BodyFields, usize) -> f64| -> Vec<f32> {
        elements.iter().map(|(fields, element)| of(fields, *element) as f32).collect()
    };
    let (displacement, velocity) = (node_vectors(|f| &f.displacement), node_vectors(|f| &f.velocity));
    let ratio = of_elements(&|f, e| f.volume_ratio[e]);
    let von_mises = of_elements(&|f, e| von_mises_and_pressure(&f.stress[e]).0);
    let pressure = of_elements(&|f, e| von_mises_and_pressure(&f.stress[e]).1);
    let stress: Vec<f32> = elements.iter().flat_map(|(f, e)| f.stress[*e].map(|s| s as f32)).collect();
    let real = [
        ("displacement", &displacement),
        ("velocity", &velocity),
        ("J", &ratio),
        ("von_mises", &von_mises),
        ("pressure", &pressure),
        ("stress", &stress),
    ];
    if let Some((name, _)) = real.iter().find(|(_, values)| values.iter().any(|value| !value.is_finite())) {
        return Ok(Some(format!("the field {name}")));
    }
    let alive: Vec<u8> = elements.iter().map(|(f, e)| f.alive[*e]).collect();
    let scalar = |name, values| Array { name, components: 1, values: Values::F32(values) };
    let frame = Frame {
        time: world.resource::<Clock>().time(),
        points: &points,
        tets: &tets,
        hexes: &hexes,
        point_arrays: vec![
            Array { name: "displacement", components: 3, values: Values::F32(&displacement) },
            Array { name: "velocity", components: 3, values: Values::F32(&velocity) },
        ],
        cell_arrays: vec![
            scalar("J", &ratio),
            scalar("von_mises", &von_mises),
            scalar("pressure", &pressure),
            Array { name: "stress", components: 6, values: Values::F32(&stress) },
            Array { name: "alive", components: 1, values: Values::U8(&alive) },
        ],
    };
    series.write(&frame)?;
    Ok(None)
}
