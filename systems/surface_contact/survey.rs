//! What the surfaces of the bodies are, where they are, and what may be near what.

use super::body_slices::Kept;
use super::crossings::Crossings;
use super::look::Motion;
use super::meet::share_at;
use super::{MeetingColumns, Surface, SurfaceContacts};
use crate::backend::cpu::Cpu;
use crate::components::*;
use crate::contact::{DEEPEST, Finder, Lists, Point, Surfaces, Tree, face_points, triangles_of};
use crate::mesh::SurfaceFace;
use bevy_ecs::prelude::*;
use glam::DVec3;
use std::ops::{Deref, DerefMut, Range};

/// Points and faces that are nearer than this at rest, in reaches, are never in each other's way.
pub(super) const NEAR_AT_REST: f64 = 1.5;

/// Numbers of a point that are of its last step: what it has slid and lost since the start stays.
const OF_A_STEP: usize = 6;

/// Which triangles a step looks at beyond those within thickness and motion, in the smaller edges of both bodies.
pub(super) const MARGIN: f64 = 1e-2;

impl SurfaceContacts {
    /// How near points and faces of one piece of a body, by its place among all, are at rest that are never in each
    /// other's way (m); nothing where it does not meet itself.
    pub fn near_at_rest(&self, body: usize) -> Option<f64> {
        let itself = self.meeting(body as u32, body as u32)?;
        Some(NEAR_AT_REST * (itself.thickness + MARGIN * itself.edge))
    }
}

/// Finds the surfaces anew where elements are gone, and in the first step.
pub(super) fn follow(
    contacts: &mut SurfaceContacts,
    bodies: &mut Query<(Entity, MeetingColumns)>,
    authorings: &Query<&Authoring>,
    blocks: &Query<Ref<Alive>>,
) {
    let mut is_other = false;
    if contacts.surface.elements.is_none() || blocks.iter().any(|alive| alive.is_changed()) {
        let all = contacts.bodies.iter().filter_map(|&body| authorings.get(body).ok());
        let elements = Some(marks(all.flat_map(|authoring| &authoring.blocks), blocks));
        if contacts.surface.elements != elements {
            let figures = contacts.surface.figures;
            contacts.surface = Surface { elements, figures, ..Surface::default() };
            survey(contacts, bodies, authorings, blocks);
            clear_apart(contacts, bodies);
            is_other = true;
        }
    }
    remember(contacts, bodies, is_other);
}

/// A number for which elements are there, another one of as many others: whoever goes back in time may find those.
fn marks<'a>(blocks: impl Iterator<Item = &'a Entity>, alive: &Query<Ref<Alive>>) -> u64 {
    let mut marks: u64 = 0xcbf2_9ce4_8422_2325;
    for alive in blocks.filter_map(|&block| alive.get(block).ok()) {
        marks = alive.iter().fold(marks, |marks, &is| (marks ^ u64::from(is == 1)).wrapping_mul(0x100_0000_01b3));
    }
    marks
}

/// Clears what nodes bore and touched, and what points of faces touched, that are on no surface any more: nobody else
/// would.
fn clear_apart(contacts: &SurfaceContacts, bodies: &mut Query<(Entity, MeetingColumns)>) {
    for (number, &body) in (0..).zip(&contacts.bodies) {
        let Ok((_, mut columns)) = bodies.get_mut(body) else { continue };
        let nodes = &contacts.surface.nodes;
        let of_body = nodes.partition_point(|&(other, _)| other < number)..;
        let mut rows = nodes[of_body].iter().take_while(|(other, _)| *other == number).map(|&(_, row)| row).peekable();
        for row in 0..columns.nodes.rest.0.len() {
            if rows.next_if_eq(&(row as u32)).is_some() {
                continue;
            }
            let touch = MEETING_NUMBERS * row;
            clear(&mut columns.force, 3 * row..3 * row + 3);
            clear(&mut columns.touch, touch..touch + OF_A_STEP);
            clear(&mut columns.touch, share_at(row as u32)..share_at(row as u32) + 1);
        }
        let Some(touch) = &mut columns.face_touch else { continue };
        let mut is_there = vec![false; touch.len() / MEETING_NUMBERS];
        let Surface { points, places_kept, .. } = &contacts.surface;
        let of_body = points.iter().zip(places_kept).filter(|(of, _)| of.triangle.is_some() && of.body == number);
        of_body.for_each(|(_, &place)| is_there[place as usize] = true);
        for (place, _) in is_there.iter().enumerate().filter(|(_, is_there)| !**is_there) {
            clear(touch, MEETING_NUMBERS * place..MEETING_NUMBERS * place + OF_A_STEP);
        }
    }
}

/// Clears numbers; most never were any, and nothing is written there.
fn clear<C: Deref<Target = Reals> + DerefMut>(column: &mut Mut<'_, C>, numbers: Range<usize>) {
    for number in numbers {
        if column.get(number) != 0.0 {
            column.set(number, 0.0);
        }
    }
}

/// Notes what bore forces or touched in the last step, where others have written that or surfaces are others.
fn remember(contacts: &mut SurfaceContacts, bodies: &mut Query<(Entity, MeetingColumns)>, is_other: bool) {
    let is_changed = bodies.iter_mut().any(|(_, columns)| columns.force.is_changed() || columns.touch.is_changed());
    if !is_other && !is_changed {
        return;
    }
    let surface = &mut contacts.surface;
    // they may be anywhere
    surface.motion = Motion::of(&surface.nodes);
    surface.pressed.clear();
    let columns: Vec<_> = contacts.bodies.iter().filter_map(|&body| bodies.get(body).ok()).collect();
    for (node, &(body, row)) in (0..).zip(&surface.nodes) {
        // a force that f32 does not know may have left −0
        let force = columns[body as usize].1.force.vector(row as usize).to_array();
        if force.iter().any(|number| number.to_bits() != 0) {
            surface.pressed.push(node);
        }
    }
    let touches = |point: &u32| {
        let Kept { body, of_face, first } = surface.kept(*point);
        let columns = &columns[body].1;
        let of_faces = columns.face_touch.map(|touch| &touch.0);
        let numbers = if of_face { of_faces } else { Some(&columns.touch.0) };
        numbers.is_some_and(|numbers| PointState::of(numbers.get(first + 4)).did > Did::Free)
    };
    surface.touching = (0..surface.points.len() as u32).filter(touches).collect();
}

/// Finds the surfaces.
fn survey(
    contacts: &mut SurfaceContacts,
    bodies: &mut Query<(Entity, MeetingColumns)>,
    authorings: &Query<&Authoring>,
    blocks: &Query<Ref<Alive>>,
) {
    let mut surface = std::mem::take(&mut contacts.surface);
    let (mut triangles, mut owners, mut depths) = (Vec::<[u32; 3]>::new(), Vec::new(), Vec::new());
    let (mut of_faces, mut places, mut facets) = (Vec::<Point>::new(), Vec::new(), Vec::new());
    let meets_itself = (0..contacts.bodies.len()).any(|body| contacts.near_at_rest(body).is_some());
    for (number, &body) in (0..).zip(&contacts.bodies) {
        let (Ok(authoring), Ok((_, columns))) = (authorings.get(body), bodies.get(body)) else { continue };
        let is_alive = |block: u32, row: u32| {
            blocks.get(authoring.blocks[block as usize]).map_or(true, |alive| alive[row as usize] == 1)
        };
        let faces = authoring.surface(is_alive);
        let row = |node: u32| authoring.node_rows[node as usize];
        let mut rows: Vec<u32> = faces.iter().flat_map(SurfaceFace::all_nodes).map(row).collect();
        rows.sort_unstable();
        rows.dedup();
        let first = surface.nodes.len() as u32;
        let number_of = |row: u32| first + rows.binary_search(&row).unwrap_or(0) as u32;
        let room = columns.face_touch.map_or(0, |touch| touch.len() / MEETING_NUMBERS);
        let facets_of = || faces.iter().flat_map(|face| face.facets().map(move |facet| (face, facet)));
        let counted = facets_of().map(|(_, facet)| (facet, face_points(facet).len()));
        let firsts = FacePlaces::firsts(columns.face_places, counted);
        for ((face, facet), first_point) in facets_of().zip(firsts) {
            let first = triangles.len();
            for corners in triangles_of(facet).map(|corners| corners.map(row)) {
                depths.push(
                    0.5 * extent(corners, authoring.cells.nodes(face.element as usize), row, &columns.nodes.rest.0),
                );
                triangles.push(corners.map(number_of));
                owners.push(number);
                facets.push(facet.map(|node| number_of(row(node))));
            }
            let nodes = facet.map(|node| number_of(row(node)));
            for (corner, weights) in face_points(facet).iter().enumerate().take(room.saturating_sub(first_point)) {
                let is_on_first = triangles[first].contains(&nodes[corner]);
                let triangle = Some(if is_on_first { first } else { first + 1 } as u32);
                of_faces.push(Point { body: number, nodes, weights, triangle });
                places.push((first_point + corner) as u32);
            }
        }
        for &row in &rows {
            surface.points.push(Point::node(number, surface.nodes.len() as u32));
            surface.nodes.push((number, row));
        }
        if meets_itself {
            surface.pieces.extend(pieces(authoring, &rows));
        }
    }
    surface.places_kept = surface.nodes.iter().map(|&(_, row)| row).chain(places).collect();
    surface.facets = if of_faces.is_empty() { Vec::new() } else { facets };
    surface.points.extend(of_faces);
    let mut deepest = vec![0.0_f64; contacts.bodies.len()];
    for (depth, &owner) in depths.iter_mut().zip(&owners) {
        *depth = f64::min(*depth, DEEPEST * contacts.edges[owner as usize]);
        deepest[owner as usize] = deepest[owner as usize].max(*depth);
    }
    // of those that are there
    let shallowest = deepest.iter().copied().filter(|depth| *depth > 0.0).reduce(f64::min).unwrap_or(0.0);
    surface.beyond = deepest.into_iter().map(|depth| (depth - shallowest).max(0.0)).collect();
    surface.shallowest = shallowest;
    surface.triangles = Surfaces::new(surface.nodes.len(), triangles, owners, depths);
    surface.gathered.slots = vec![u32::MAX; surface.nodes.len()];
    surface.places = vec![DVec3::ZERO; surface.nodes.len()];
    surface.normals = vec![DVec3::ZERO; surface.triangles.triangles.len()];
    surface.motion = Motion::of(&surface.nodes);
    surface.numbers = contacts.bodies.iter().copied().zip(0..).collect();
    surface.numbers.sort_unstable();
    let columns: Vec<_> = contacts.bodies.iter().filter_map(|&body| bodies.get(body).ok()).collect();
    let rest: Vec<DVec3> = surface
        .nodes
        .iter()
        .map(|&(body, row)| columns[body as usize].1.nodes.rest.0[row as usize] - contacts.reference)
        .collect();
    let bodies = &surface.triangles.bodies;
    let of_body = |body: u32| {
        let range = bodies.partition_point(|&other| other < body)..bodies.partition_point(|&other| other <= body);
        Tree::new(range.start as u32..range.end as u32, |number| surface.triangles.corners(&rest, number))
    };
    surface.trees = (0..contacts.bodies.len() as u32).map(of_body).collect();
    contacts.surface = surface;
    near_at_rest(contacts, &rest);
    if contacts.meetings.iter().flatten().any(|meeting| meeting.edges) {
        contacts.surface.crossings = Crossings::of(&contacts.surface.triangles, rest);
    }
}

/// The pieces that some rows of a body are of, as its elements made them: copies are not near each other at rest as the
/// two sides of a narrow gap are.
fn pieces(authoring: &Authoring, rows: &[u32]) -> Vec<u32> {
    let of_nodes = authoring.cells.pieces_of_nodes(authoring.node_rows.len());
    let mut of_rows = vec![0; of_nodes.len()];
    authoring.node_rows.iter().zip(of_nodes).for_each(|(&row, piece)| of_rows[row as usize] = piece);
    rows.iter().map(|&row| of_rows[row as usize]).collect()
}

/// How far an element reaches behind a face of its (m).
fn extent(corners: [u32; 3], element: &[u32], row: impl Fn(u32) -> u32, rest: &[DVec3]) -> f64 {
    let [a, b, c] = corners.map(|row| rest[row as usize]);
    let normal = (b - a).cross(c - a).normalize_or_zero();
    element.iter().map(|&node| normal.dot(a - rest[row(node) as usize])).fold(0.0, f64::max)
}

/// Notes which points and faces of one piece of a body are near each other at rest.
fn near_at_rest(contacts: &mut SurfaceContacts, rest: &[DVec3]) {
    if contacts.surface.pieces.is_empty() {
        return;
    }
    let near: Vec<f64> = (0..contacts.bodies.len()).map(|body| contacts.near_at_rest(body).unwrap_or(0.0)).collect();
    let meets = |point: u32, face: u32, of_face: bool| point == face && contacts.meets(point, face, of_face);
    let surface = &contacts.surface;
    let Surface { triangles, points, .. } = surface;
    let finder = Finder { surfaces: triangles, points, meets: &meets, apart: &[], beyond: &near };
    let cpu = Cpu::new(1, 0, Default::default());
    let lists = Lists::find(&finder, &surface.trees, rest, 0.0, &cpu);
    let mut apart = Vec::new();
    for (place, &point) in lists.points.iter().enumerate() {
        let of_point = surface.pieces[surface.points[point as usize].nodes[0] as usize];
        let of_triangle = |triangle: u32| surface.pieces[surface.triangles.triangles[triangle as usize][0] as usize];
        let of_piece = lists.triangles(place).iter().filter(|&&triangle| of_triangle(triangle) == of_point);
        apart.extend(of_piece.map(|&triangle| (point, triangle)));
    }
    contacts.surface.apart = apart;
}
