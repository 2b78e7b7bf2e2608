//! Bodies: node columns and element blocks from a mesh.

use super::body_columns::block_corners;
use super::fibres::Members;
use super::locality::{element_order, node_rows};
use super::material::{OfCopies, called_for};
use super::patches::{insert_forces, strided};
use super::{Assembly, PlacedMesh, select};
use crate::backend::cpu::{LawCopies, PerCopyLaw};
use crate::components::*;
use crate::elements::{Element, MOST_NODES};
use crate::elements::{averages, node_count, with_element, with_element_of};
use crate::materials::{Elastic, ElasticLaw};
use crate::math::LANES;
use crate::math::lane_place;
use crate::mesh::{ElementKind, Mesh};
use crate::scene::diagnostic::Diagnostics;
use bevy_ecs::prelude::*;
use glam::DVec3;
use std::collections::BTreeMap;
use std::sync::Arc;

/// A body's entity and what is known of it in the author's numbering.
pub struct BodyParts {
    /// The body.
    pub entity: Entity,
    /// Its mesh.
    pub placed: PlacedMesh,
    /// How many copies of one mesh that is.
    pub copies: usize,
    /// For each of the author's nodes its row.
    pub node_rows: Vec<u32>,
    /// For each of the author's elements its block's place in `blocks` and its row there.
    pub element_rows: Vec<(u32, u32)>,
    /// The blocks.
    pub blocks: Vec<Entity>,
}

impl BodyParts {
    /// Rows, ascending, of the author's nodes that are marked.
    pub fn rows_of(&self, marked: &[bool]) -> Vec<u32> {
        let mut rows: Vec<u32> =
            marked.iter().zip(&self.node_rows).filter(|(marked, _)| **marked).map(|(_, &row)| row).collect();
        rows.sort_unstable();
        rows
    }

    /// For each of some rows the number, or the numbers, that its copy has.
    pub fn of_rows<N: Copy>(&self, rows: &[u32], of_copies: &[N]) -> Vec<N> {
        self.copies_of(rows).into_iter().map(|copy| of_copies[copy]).collect()
    }

    /// For each of some rows which copy it belongs to.
    pub fn copies_of(&self, rows: &[u32]) -> Vec<usize> {
        let nodes = (self.node_rows.len() / self.copies.max(1)).max(1);
        let mut copy_of = vec![0; self.node_rows.len()];
        self.node_rows.iter().enumerate().for_each(|(node, &row)| copy_of[row as usize] = node / nodes);
        rows.iter().map(|&row| copy_of[row as usize]).collect()
    }
}

/// Spawns a body and its blocks. Complaints go to `diagnostics`.
pub(super) fn spawn(
    assembly: &Assembly<'_>,
    name: &str,
    placed: PlacedMesh,
    world: &mut World,
    diagnostics: &mut Diagnostics,
) -> Option<BodyParts> {
    let materials = element_materials(assembly, name, &placed, diagnostics)?;
    let mesh = &placed.mesh;
    // one block for each element type and material that occur together
    let source = &assembly.scene.scene.bodies[name].mesh;
    let mut members: BTreeMap<(ElementKind, &str), Vec<u32>> = BTreeMap::new();
    for (cell, rows, _) in mesh.cells.blocks() {
        let Some(kind) = source.element_kind(cell) else {
            let message = format!("sinew has no element for {}", cell.topology().plural);
            diagnostics.error_at(format!("bodies.\"{name}\".mesh").as_str(), message);
            return None;
        };
        let mut first = rows.start as u32;
        for alike in materials[rows].chunk_by(|a, b| a == b) {
            let end = first + alike.len() as u32;
            members.entry((kind, alike[0])).or_default().extend(first..end);
            first = end;
        }
    }
    let copies = assembly.scene.scene.bodies[name].copies as usize;
    let order =
        |(key, elements): ((ElementKind, _), _)| (key, element_order(mesh, elements, copies, patch_length(key.0)));
    let members: Vec<((ElementKind, &str), Vec<u32>)> = members.into_iter().map(order).collect();
    let patches = members.iter().flat_map(|((kind, _), elements)| elements.chunks(patch_length(*kind)));
    let apart = super::surface_contacts::apart(assembly.scene, name, &placed);
    let patches = patches.map(|patch| patch.iter().map(|&e| mesh.element(e as usize)));
    let node_rows = node_rows(mesh.points.len(), patches, &apart);
    let members: Vec<((ElementKind, &str), Vec<u32>)> =
        members.into_iter().map(|(key, elements)| (key, strided(elements, key.0))).collect();

    let body = world.spawn(Label(name.to_string())).id();
    let mut element_rows = vec![(0, 0); mesh.element_count()];
    let mut blocks = Vec::new();
    for (place, ((kind, material), elements)) in members.iter().enumerate() {
        for (row, &element) in elements.iter().enumerate() {
            element_rows[element as usize] = (place as u32, row as u32);
        }
        let (kind, material) = (*kind, assembly.materials[*material]);
        let builder = BlockBuilder { assembly, mesh, copies, node_rows: &node_rows, kind, material, elements };
        blocks.push(builder.spawn(world, body, name, diagnostics));
    }
    let authoring = Authoring {
        node_rows: node_rows.clone(),
        node_ids: mesh.point_ids.clone(),
        element_rows: element_rows.clone(),
        element_ids: mesh.element_ids.clone(),
        cells: mesh.cells.clone(),
        blocks: blocks.clone(),
        sets: if copies > 1 { BTreeMap::new() } else { mesh.nodes_of_sets() },
    };
    super::body_columns::insert_node_columns(assembly, name, mesh, &node_rows, &authoring, world, body);
    world.entity_mut(body).insert(authoring);
    if !apart.is_empty() {
        let mut rows: Vec<u32> = apart.iter().map(|&node| node_rows[node as usize]).collect();
        rows.sort_unstable();
        world.entity_mut(body).insert(SurfaceRows(rows));
    }
    insert_forces(assembly.scheme, body, world);
    super::skins::insert(assembly, name, &placed, body, world, diagnostics);
    Some(BodyParts { entity: body, placed, copies, node_rows, element_rows, blocks })
}

/// The name of each element's material.
fn element_materials<'a>(
    assembly: &'a Assembly<'_>,
    name: &str,
    placed: &PlacedMesh,
    diagnostics: &mut Diagnostics,
) -> Option<Vec<&'a str>> {
    let body = &assembly.scene.scene.bodies[name];
    let mut materials = vec![body.material.as_str(); placed.mesh.element_count()];
    for (number, region) in body.regions.iter().enumerate() {
        let path = format!("bodies.\"{name}\".regions[{number}].on");
        match select::pick(placed, &region.on).and_then(|picked| picked.elements(placed)) {
            Err(problem) => {
                diagnostics.error_at(path.as_str(), problem.message).notes(problem.notes);
            }
            Ok(marked) => {
                for (material, _) in materials.iter_mut().zip(&marked).filter(|(_, marked)| **marked) {
                    *material = &region.material;
                }
            }
        }
    }
    (!diagnostics.has_errors()).then_some(materials)
}

pub(super) struct BlockBuilder<'a> {
    assembly: &'a Assembly<'a>,
    mesh: &'a Mesh,
    copies: usize,
    node_rows: &'a [u32],
    pub(super) kind: ElementKind,
    material: Entity,
    pub(super) elements: &'a [u32],
}

impl BlockBuilder<'_> {
    fn spawn(&self, world: &mut World, body: Entity, name: &str, diagnostics: &mut Diagnostics) -> Entity {
        let law = ElasticLaw::of(world.entity(self.material));
        let of_all = law.map_or(0.0, |law| young(law.small_strain_moduli()));
        let hourglass = self.assembly.scene.scene.bodies[name].hourglass;
        let material_name = world.get::<Label>(self.material).map(|label| label.0.clone()).unwrap_or_default();
        let scene = &self.assembly.scene.scene;
        let copies: Arc<[u32]> = self.copies().collect();
        let of_copies = OfCopies::of(scene, scene, name, &material_name);
        let members = Members {
            mesh: self.mesh,
            elements: self.elements,
            body: name,
            material: &material_name,
            copies: &copies,
            of_copies: of_copies.as_ref().and_then(OfCopies::directions),
        };
        let material = &called_for(&scene.materials[&material_name]);
        let (fibre_directions, varying) = members.directions(material, self.assembly.precision, diagnostics);
        let per_copy = match &law {
            Some(ElasticLaw::CorotationalFrame(law)) => self.framed(law, (name, &material_name), diagnostics),
            _ => of_copies.as_ref().and_then(OfCopies::laws).map(|laws| LawCopies::new(laws, Arc::clone(&copies))),
        };
        let stiffness = |row: usize| {
            let of_copy = per_copy.as_ref().map(|copies| young(copies.of_row(row).elastic.small_strain_moduli()));
            hourglass * of_copy.unwrap_or(of_all)
        };
        let block = Block {
            body,
            material: self.material,
            kind: self.kind,
            count: self.elements.len(),
            force_offset: 0,
            force_length: 0,
            simple: self.is_simple(),
            fibre_directions,
        };
        let shapes = with_element_of!(block, E => self.rest_shapes::<E>(stiffness));
        let connectivity = self.connectivity();
        let mut entity = world.spawn((
            Label(format!("{name}/{material_name}/{:?}", self.kind)),
            OfBody(body),
            block,
            Connectivity(connectivity.clone()),
            RestShape(shapes),
            FirstInverted(vec![u32::MAX; 2]),
            OnInversion(material.inversion()),
        ));
        if averages(self.kind) {
            let corners = block_corners(self.kind, self.elements.len(), &connectivity, self.mesh.points.len());
            let precision = self.assembly.precision;
            entity.insert((
                corners,
                ElementVolume(Reals::zeros(precision, 2 * self.padded())),
                NodalVolumeChange(Reals::zeros(precision, self.mesh.points.len())),
            ));
        }
        if let Some(directions) = varying {
            entity.insert(FibreDirection(directions));
        }
        if let Some(copies) = per_copy {
            entity.insert(PerCopyLaw(Arc::new(copies)));
        }
        if let Some(memories) = of_copies.as_ref().and_then(OfCopies::memories) {
            entity.insert(memories);
        }
        if let Some(inertia) = of_copies.as_ref().and_then(|of_copies| of_copies.inertia(&copies)) {
            entity.insert(inertia);
        }
        entity.id()
    }

    /// The copy of each element.
    fn copies(&self) -> impl Iterator<Item = u32> {
        let points = self.mesh.points.len().div_ceil(self.copies).max(1);
        self.elements.iter().map(move |&element| self.mesh.element(element as usize)[0] / points as u32)
    }

    fn padded(&self) -> usize {
        self.elements.len().div_ceil(LANES) * LANES
    }

    fn connectivity(&self) -> Vec<u32> {
        let nodes = node_count(self.kind);
        let mut connectivity = vec![0; self.padded() * nodes];
        for row in 0..self.padded() {
            // elements that fill up the last group have the last element's nodes and no volume
            let element = self.mesh.element(self.elements[row.min(self.elements.len() - 1)] as usize);
            for corner in 0..nodes {
                connectivity[lane_place(row, nodes, corner)] = self.node_rows[element[corner] as usize];
            }
        }
        connectivity
    }

    /// Rest positions of an element's nodes (m).
    pub(super) fn points(&self, element: u32) -> [DVec3; MOST_NODES] {
        let mut points = [DVec3::ZERO; MOST_NODES];
        for (place, &node) in self.mesh.element(element as usize).iter().enumerate() {
            points[place] = self.mesh.points[node as usize];
        }
        points
    }

    /// Whether the type for [specialised](Element::Specialisation) shapes describes all elements.
    fn is_simple(&self) -> bool {
        with_element!(self.kind, E => self.elements.iter().all(|&e| <E as Element>::Specialisation::describes(&self.points(e)[..E::NODES])))
    }

    /// Rest shapes for an element type, whose hourglass control is as stiff as `young` says of each row (Pa).
    fn rest_shapes<E: Element>(&self, young: impl Fn(usize) -> f64) -> Reals {
        let mut shapes = Reals::zeros(self.assembly.precision, self.padded() * E::ROWS);
        for row in 0..self.padded() {
            // elements that fill up the last group have the last element's shape and no volume
            let last = row.min(self.elements.len() - 1);
            let shape = E::rest_shape(&self.points(self.elements[last])[..E::NODES], young(last));
            for k in 0..E::ROWS {
                let exerts = Some(k) == E::FORCE_ROW || k == E::VOLUME_ROW;
                let number = if exerts && row >= self.elements.len() { 0.0 } else { shape[k] };
                shapes.set(lane_place(row, E::ROWS, k), number);
            }
        }
        shapes
    }
}

/// Small-strain Young's modulus (Pa) from shear and bulk modulus.
pub(super) fn young([shear, bulk]: [f64; 2]) -> f64 {
    9.0 * bulk * shear / (3.0 * bulk + shear)
}
