//! Fields of elements, evaluated on the host in f64, side by side for each element.

use super::frame::WrittenFields;
use crate::backend::cpu::{BlockLaw, Cpu, ROWS_A_TASK};
use crate::backend::device::bring_to_host;
use crate::components::*;
use crate::error::Error;
use crate::evaluation::{BlockView, principal_values, von_mises_and_pressure};
use crate::scene::schema::OutputField;
use bevy_ecs::prelude::*;

/// The fields of elements that are written.
pub struct ElementFields {
    fields: Vec<OutputField>,
    removed: bool,
    /// Families of fibres of the block that has most.
    families: usize,
    /// Numbers an element.
    width: usize,
    /// Materials in order of their names.
    materials: Vec<Entity>,
}

/// Elements of one body, ready to be put into a frame.
pub struct BodyElements<'a> {
    of: &'a ElementFields,
    number: u32,
    authoring: Option<&'a Authoring>,
    /// Of each block: its material's number, what its elements are, who is there.
    blocks: Vec<(u32, Vec<f32>, Option<&'a Alive>)>,
}

/// Elements of a frame, in its order.
#[derive(Default)]
pub struct ElementRows {
    values: Vec<f32>,
    /// 1 while an element is there.
    pub alive: Vec<u8>,
    /// Number of its body, in the order of names.
    pub body: Vec<u32>,
    /// Number of its material, likewise.
    pub material: Vec<u32>,
    /// The author's number.
    pub element: Vec<i64>,
}

/// An array of a frame.
pub struct FieldColumn {
    /// Its name.
    pub name: String,
    /// Numbers an element.
    pub components: usize,
    /// The numbers.
    pub values: Vec<f32>,
}

const COLUMNS: [&str; 4] = [Displacement::NAME, RestShape::NAME, ViscousMemory::NAME, Alive::NAME];

impl ElementFields {
    /// Brings to the host what they are made of.
    ///
    /// # Errors
    /// What the GPU says.
    pub fn new(wanted: &WrittenFields, world: &mut World) -> Result<Self, Error> {
        let fields: Vec<OutputField> = wanted.fields.iter().copied().filter(|field| !field.is_of_nodes()).collect();
        bring_to_host(world, |_, name| match fields.is_empty() {
            true => name == Alive::NAME,
            false => COLUMNS.contains(&name),
        })?;
        let families = |law: &BlockLaw<f64>| law.fibres.iter().len() + law.exponential.len();
        let families = world.query::<&BlockLaw<f64>>().iter(world).map(families).max().unwrap_or(0).max(1);
        let mut materials: Vec<(Label, Entity)> = world
            .query_filtered::<(&Label, Entity), With<Density>>()
            .iter(world)
            .map(|(l, e)| (l.clone(), e))
            .collect();
        materials.sort();
        let materials = materials.into_iter().map(|(_, entity)| entity).collect();
        let mut all = Self { fields, removed: wanted.removed_elements, families, width: 0, materials };
        all.width = all.fields.iter().map(|&field| all.numbers(field)).sum();
        Ok(all)
    }

    fn numbers(&self, field: OutputField) -> usize {
        if field == OutputField::FibreStretch { self.families } else { field.components() }
    }

    /// The elements of a body, whose number is that of its name's place.
    pub fn of_body<'a>(&'a self, number: u32, body: Entity, world: &'a World) -> BodyElements<'a> {
        let authoring = world.get::<Authoring>(body);
        let of_block = |&entity: &Entity| {
            let material = world.get::<Block>(entity).map(|block| block.material);
            let material = self.materials.iter().position(|&other| Some(other) == material).unwrap_or(0);
            (material as u32, self.of_block(entity, world), world.get::<Alive>(entity))
        };
        let blocks = authoring.iter().flat_map(|authoring| &authoring.blocks).map(of_block).collect();
        BodyElements { of: self, number, authoring, blocks }
    }

    fn of_block(&self, entity: Entity, world: &World) -> Vec<f32> {
        if self.width == 0 {
            return Vec::new();
        }
        let Some(view) = BlockView::now(world, entity) else { return Vec::new() };
        let alive = world.get::<Alive>(entity);
        let task = |task: usize| {
            let mut values = Vec::with_capacity(self.width * ROWS_A_TASK);
            for row in task * ROWS_A_TASK..view.block.count.min((task + 1) * ROWS_A_TASK) {
                match alive.is_some_and(|alive| alive[row] == 0) {
                    true => self.fields.iter().for_each(|&field| self.at_rest(field, &mut values)),
                    false => self.of_element(&view, row, &mut values),
                }
            }
            values
        };
        world.resource::<Cpu>().map(view.block.count.div_ceil(ROWS_A_TASK), task).concat()
    }

    fn of_element(&self, view: &BlockView<'_>, row: usize, values: &mut Vec<f32>) {
        let state = view.element(row);
        let mut stress: Option<[f64; 6]> = None;
        for &field in &self.fields {
            let mut cauchy = || *stress.get_or_insert_with(|| view.cauchy(row, &state));
            let mut put = |numbers: &[f64]| values.extend(numbers.iter().map(|&number| number as f32));
            match field {
                OutputField::VolumeRatio => put(&[state.volume_ratio()]),
                OutputField::CauchyStress => put(&cauchy()),
                OutputField::VonMises => put(&[von_mises_and_pressure(&cauchy()).0]),
                OutputField::Pressure => put(&[von_mises_and_pressure(&cauchy()).1]),
                OutputField::PrincipalStresses => put(&principal_values(&cauchy())),
                OutputField::PrincipalStretches => put(&state.principal_stretches()),
                OutputField::GreenStrain => put(&state.green_strain()),
                OutputField::EnergyDensity => put(&[view.energy(row, &state)]),
                OutputField::HourglassShare => put(&[view.hourglass_share(row, &state)]),
                OutputField::FibreStretch => {
                    let mut stretches = view.fibre_stretches(row, &state);
                    // no fibre is stretched to nothing
                    stretches.resize(self.families, 0.0);
                    put(&stretches);
                }
                OutputField::Displacement
                | OutputField::Velocity
                | OutputField::Reaction
                | OutputField::InternalForce
                | OutputField::ExternalForce
                | OutputField::ContactForce
                | OutputField::ContactTraction
                | OutputField::ContactPressure
                | OutputField::ContactArea
                | OutputField::ContactGap
                | OutputField::ContactSlip => {}
            }
        }
    }

    /// What a removed element has: neither strain nor stress.
    fn at_rest(&self, field: OutputField, values: &mut Vec<f32>) {
        let value = match field {
            OutputField::VolumeRatio | OutputField::PrincipalStretches => 1.0,
            _ => 0.0,
        };
        values.extend(std::iter::repeat_n(value, self.numbers(field)));
    }

    /// The arrays of a frame.
    pub fn columns(&self, rows: &ElementRows) -> Vec<FieldColumn> {
        let mut columns = Vec::new();
        let mut first = 0;
        for &field in &self.fields {
            let (numbers, components) = (self.numbers(field), field.components());
            for family in 0..numbers / components {
                let name = match family {
                    0 => field.array().to_string(),
                    _ => format!("{}_{}", field.array(), family + 1),
                };
                let begin = first + family * components;
                let row = |row: &[f32]| row[begin..begin + components].to_vec();
                let values = rows.values.chunks_exact(self.width).flat_map(row).collect();
                columns.push(FieldColumn { name, components, values });
            }
            first += numbers;
        }
        columns
    }
}

impl BodyElements<'_> {
    /// Puts the author's element of a place into a frame, if it is to be written: whether it is.
    pub fn put(&self, place: usize, rows: &mut ElementRows) -> bool {
        let Some(authoring) = self.authoring else { return false };
        let (block, row) = authoring.element_rows[place];
        let (material, values, alive) = &self.blocks[block as usize];
        let alive = alive.is_none_or(|alive| alive[row as usize] != 0);
        if !alive && !self.of.removed {
            return false;
        }
        let (row, width) = (row as usize, self.of.width);
        rows.values.extend(values.get(row * width..(row + 1) * width).unwrap_or_default());
        rows.alive.push(u8::from(alive));
        rows.body.push(self.number);
        rows.material.push(*material);
        rows.element.push(authoring.element_ids.of(place) as i64);
        true
    }
}

impl ElementRows {
    /// These, then others.
    pub fn and(mut self, others: ElementRows) -> Self {
        self.values.extend(others.values);
        self.alive.extend(others.alive);
        self.body.extend(others.body);
        self.material.extend(others.material);
        self.element.extend(others.element);
        self
    }
}
