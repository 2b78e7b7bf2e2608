//! The surfaces of one body.

use super::lines;
use crate::scene3d::{Lent, Surface};
use crate::settings::{Settings, number};
use glam::Vec3;
use sinew::driver::{Body, BodyState, Loaded};
use sinew::mesh::Cells;
use sinew::mesh::topology::MOST_NODES;
use sinew::scene::schema::OutputField;
use sinew_pictures::render::{
    Averages, Colouring, Faces, Finish, Image, Layer, Lines, Outer, Plane, Section, Skin, creases,
};
use std::collections::HashMap;
use std::sync::Arc;

/// What is known of a body's mesh, and where it is drawn.
pub struct BodyMesh {
    pub(super) cells: Cells,
    faces: Faces,
    /// What it began with.
    skin: Skin,
    rest: Vec<Vec3>,
    ghost: Vec<[u32; 4]>,
    creases: Vec<u8>,
    /// Places of elements by their numbers.
    places: HashMap<i64, usize>,
    /// Faces that are seen, and since when.
    pub(super) outer: (u64, Vec<Outer>),
    /// Where its nodes are drawn (m).
    pub vertices: Vec<Vec3>,
    /// Whether it may be drawn from where its nodes are on the device.
    pub lends: bool,
    /// A picture on its skin.
    pub picture: Option<Arc<Image>>,
}

/// Faces of one finish.
pub struct Part {
    pub vertices: Vec<Vec3>,
    rest: Vec<Vec3>,
    /// Where they are known.
    normals: Vec<Vec3>,
    faces: Vec<[u32; 4]>,
    /// One a vertex; empty without a field.
    pub values: Vec<f32>,
    pub finish: Finish,
    tissue: Option<u8>,
    /// Lines of each face, where they are not those of elements.
    sides: Option<Vec<u8>>,
    wireframe: bool,
    flat: Option<Vec3>,
    cut: bool,
    /// Where it is drawn from where its nodes are on the device: of which body, and how many times as far moved.
    pub lent: Option<(usize, f32)>,
    /// What is on it; `rest` are then places in that.
    picture: Option<Arc<Image>>,
}

/// What the faces of a body's own surface share.
struct Common {
    values: Vec<f32>,
    tissue: Option<u8>,
    lent: Option<(usize, f32)>,
}

impl BodyMesh {
    pub fn new(body: &Body) -> Self {
        let faces = Faces::new(&body.cells);
        let rest: Vec<Vec3> = body.rest.iter().map(|place| Vec3::from_array(*place)).collect();
        let ghost: Vec<[u32; 4]> = faces.surface(|_| Some(0), None).iter().map(|face| face.points).collect();
        let places = (0..body.cells.len()).map(|place| (body.elements.of(place) as i64, place)).collect();
        Self {
            creases: creases(&rest, &ghost),
            skin: faces.skin(),
            cells: body.cells.clone(),
            outer: (u64::MAX, Vec::new()),
            vertices: rest.clone(),
            faces,
            rest,
            ghost,
            places,
            lends: false,
            picture: None,
        }
    }

    /// Goes to where a state has it, moved from its shape at rest by a multiple of its displacement.
    pub fn move_to(&mut self, now: &BodyState, deformation: f32) {
        for ((vertex, rest), place) in self.vertices.iter_mut().zip(&self.rest).zip(&now.positions) {
            *vertex = *rest + (Vec3::from_array(*place) - *rest) * deformation;
        }
        if self.outer.0 != now.topology {
            let there = |cell: u32| now.alive.get(cell as usize).filter(|alive| **alive != 0).map(|_| 0);
            self.outer = (now.topology, self.faces.surface(there, Some(&self.skin)));
        }
    }

    /// Adds what is drawn of it.
    pub fn parts(
        &mut self,
        now: &BodyState,
        number: usize,
        (settings, field): (&Settings, Option<OutputField>),
        plane: Option<&Plane>,
        parts: &mut Vec<Part>,
    ) {
        let values = field.map(|field| self.values(now, field, settings.component)).unwrap_or_default();
        let tissue = values.is_empty().then_some(number.min(255) as u8);
        let skin = now.skin.as_ref().filter(|_| settings.skins);
        // what has values, is cut or has lines that fade is made on the host
        let lends = self.lends && values.is_empty() && skin.is_none() && plane.is_none() && !settings.wireframe;
        let common = Common { values, tissue, lent: lends.then_some((number, settings.deformation)) };
        for bared in [false, true] {
            // where elements went the body's own faces close the hole
            let faces = self.outer.1.iter().filter(|face| face.bared == bared && (bared || skin.is_none()));
            let faces: Vec<[u32; 4]> = faces.map(|face| face.points).collect();
            if !faces.is_empty() {
                parts.push(self.part(faces, bared, settings.wireframe, &common));
            }
        }
        if let Some(skin) = skin {
            parts.push(self.skin_part(skin, settings, &common));
        }
        if let Some(plane) = plane {
            parts.push(self.section(now, plane, settings.wireframe, &common));
        }
        if settings.removed && now.alive.contains(&0) {
            parts.push(self.removed_part(now));
        }
        if settings.ghost {
            parts.push(Part {
                vertices: self.rest.clone(),
                rest: Vec::new(),
                normals: Vec::new(),
                faces: self.ghost.clone(),
                values: Vec::new(),
                finish: Finish::Ghost,
                tissue: None,
                sides: Some(self.creases.clone()),
                wireframe: false,
                flat: None,
                cut: true,
                lent: None,
                picture: None,
            });
        }
    }

    /// Elements that are gone, where their nodes are now.
    fn removed_part(&self, now: &BodyState) -> Part {
        let gone = |cell: u32| now.alive.get(cell as usize).filter(|alive| **alive == 0).map(|_| 0);
        let faces: Vec<[u32; 4]> = self.faces.surface(gone, None).iter().map(|face| face.points).collect();
        Part {
            vertices: self.vertices.clone(),
            rest: Vec::new(),
            normals: Vec::new(),
            sides: Some(vec![0b1111; faces.len()]),
            faces,
            values: Vec::new(),
            finish: Finish::Ghost,
            tissue: None,
            wireframe: false,
            flat: None,
            cut: true,
            lent: None,
            picture: None,
        }
    }

    fn part(&self, faces: Vec<[u32; 4]>, bared: bool, wireframe: bool, common: &Common) -> Part {
        Part {
            vertices: self.vertices.clone(),
            rest: self.rest.clone(),
            normals: Vec::new(),
            faces,
            values: common.values.clone(),
            finish: if bared && common.tissue.is_none() { Finish::Bared } else { Finish::Plain },
            tissue: common.tissue,
            sides: None,
            wireframe,
            flat: None,
            cut: true,
            lent: common.lent,
            picture: None,
        }
    }

    /// One value a node; of fields of elements the mean over those around it, weighted by their volumes.
    fn values(&self, now: &BodyState, field: OutputField, component: usize) -> Vec<f32> {
        let numbers: Vec<f32> =
            now.values.chunks_exact(now.components.max(1)).map(|row| number(row, field, component)).collect();
        if field.is_of_nodes() {
            return if numbers.len() == self.rest.len() { numbers } else { Vec::new() };
        }
        if numbers.len() != self.cells.len() {
            return Vec::new();
        }
        let alive = |cell: usize| now.alive.get(cell).is_some_and(|alive| *alive != 0);
        let averages = Averages::of(vec![0; numbers.len()], &self.rest, &self.cells, &numbers, alive);
        let mut values = vec![0.0; self.rest.len()];
        for (cell, (_, nodes)) in self.cells.iter().enumerate().filter(|(cell, _)| alive(*cell)) {
            nodes.iter().for_each(|node| values[*node as usize] = averages.at(cell, *node));
        }
        values
    }

    fn skin_part(&self, skin: &sinew::observation::SkinState, settings: &Settings, common: &Common) -> Part {
        let rest: Vec<Vec3> = skin.rest.iter().map(|place| place.as_vec3()).collect();
        let moved =
            skin.points.iter().zip(&rest).map(|(place, rest)| *rest + (place.as_vec3() - *rest) * settings.deformation);
        let value = |(element, weights): (&i64, &[f32; MOST_NODES])| {
            let nodes = self.places.get(element).map(|place| self.cells.nodes(*place)).unwrap_or_default();
            // a colour does not go beyond those around it
            let parts =
                nodes.iter().zip(weights).map(|(node, weight)| (common.values[*node as usize], weight.max(0.0)));
            let (sum, all) = parts.fold((0.0, 0.0), |(sum, all), (value, weight)| (sum + value * weight, all + weight));
            if all > 0.0 { sum / all } else { 0.0 }
        };
        let values = if common.values.is_empty() {
            Vec::new()
        } else {
            skin.elements.iter().zip(&skin.weights).map(value).collect()
        };
        let vertices = moved.collect();
        // where each point is in the picture, from its upper left corner on
        let is_painted = values.is_empty() && skin.texture.len() == skin.points.len();
        let picture = self.picture.clone().filter(|_| is_painted);
        let in_picture = || skin.texture.iter().map(|[u, v]| Vec3::new(*u, 1.0 - *v, 0.0)).collect();
        Part {
            vertices,
            faces: skin.triangles.iter().map(|[a, b, c]| [*a, *b, *c, *c]).collect(),
            rest: if picture.is_some() { in_picture() } else { rest },
            picture,
            normals: skin.normals.iter().map(|normal| normal.as_vec3()).collect(),
            values,
            finish: Finish::Plain,
            tissue: common.tissue,
            sides: None,
            wireframe: false,
            flat: None,
            cut: true,
            lent: None,
        }
    }

    /// What closes cells that the plane cuts.
    fn section(&self, now: &BodyState, plane: &Plane, wireframe: bool, common: &Common) -> Part {
        let mut section = Section::default();
        for (cell, (kind, nodes)) in self.cells.iter().enumerate() {
            if now.alive.get(cell).is_some_and(|alive| *alive != 0) {
                let places: Vec<Vec3> = nodes.iter().map(|node| self.vertices[*node as usize]).collect();
                let value = |node: &u32| common.values.get(*node as usize).copied().unwrap_or(0.0);
                let values: Vec<f32> = nodes.iter().map(value).collect();
                section.add(plane, kind, &places, &values);
            }
        }
        Part {
            rest: section.vertices.clone(),
            normals: Vec::new(),
            vertices: section.vertices,
            faces: section.faces,
            values: if common.values.is_empty() { Vec::new() } else { section.values },
            finish: Finish::Plain,
            tissue: common.tissue,
            sides: wireframe.then_some(section.sides),
            wireframe: false,
            flat: Some(plane.normal),
            cut: false,
            lent: None,
            picture: None,
        }
    }
}

impl Part {
    /// As it is drawn, of a body of a scene.
    pub fn surface<'a>(&'a self, loaded: Option<&'a Loaded>) -> Surface<'a> {
        let lent = self.lent.and_then(|(body, deformation)| {
            let column = loaded?.bodies.get(body)?.on_gpu.as_ref()?;
            Some(Lent { column, deformation })
        });
        let layer = Layer {
            vertices: &self.vertices,
            faces: &self.faces,
            values: if self.values.is_empty() { Colouring::Nothing } else { Colouring::Vertices(&self.values) },
            finish: self.finish,
            lines: self.sides.as_deref().map_or(lines(self.wireframe), Lines::Sides),
            normals: &self.normals,
            flat: self.flat,
            cut: self.cut,
        };
        let picture = self.picture.as_ref();
        Surface { layer, rest: &self.rest, tissue: self.tissue, picture, lent }
    }
}
