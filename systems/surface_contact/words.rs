//! What kernels know of surfaces, and of what may be near what: words of buffers, floats as their bits.

use super::survey::MARGIN;
use super::{Surface, SurfaceContacts};
use crate::components::*;
use bevy_ecs::prelude::*;
use glam::DVec3;

/// Words of `surface_faces` about two bodies that may meet.
const MEETING_WORDS: usize = 9;

/// What meets of two bodies.
const NODES_MEET: u32 = 1;
const FACES_MEET: u32 = 2;
const EDGES_MEET: u32 = 4;

/// Of what is near a node, a point of a face or an edge there is room for so much, on average, and besides.
const ROOM_OF_NODES: usize = 16;
const ROOM_OF_FACE_POINTS: usize = 10;
const ROOM_OF_EDGES: usize = 16;
const ROOM_BESIDES: usize = 4096;

/// Contacts that an edge has room for where there is none for all in its list; on average, and besides.
const EDGE_CONTACTS: usize = 4;

/// Words of `surface_faces`, and where its parts begin.
pub(super) struct FaceWords {
    pub words: Vec<u32>,
    pub around: usize,
    pub meetings: usize,
    pub apart: usize,
    pub face_points: usize,
    pub facets: usize,
    pub edges: usize,
    pub begins: usize,
}

/// Where parts of `surface_lists` begin, and how much there is room for.
pub(super) struct Layout {
    pub list: usize,
    pub inverse: usize,
    pub displacements: usize,
    /// Contacts of points and edges.
    pub contacts: usize,
    /// Those of edges.
    edge_contacts: usize,
    /// Pairs in lists.
    pairs: usize,
}

/// Words of `surface_lists`: pieces that hold something, each with its place, of so many in all.
pub(super) struct ListWords {
    pub pieces: Vec<(usize, Vec<u32>)>,
    pub count: usize,
}

impl ListWords {
    /// All of them.
    pub fn whole(&self) -> Vec<u32> {
        let mut words = vec![0; self.count];
        for (at, piece) in &self.pieces {
            words[*at..at + piece.len()].copy_from_slice(piece);
        }
        words
    }
}

impl Layout {
    pub fn of(contacts: &SurfaceContacts) -> Self {
        let surface = &contacts.surface;
        let [nodes, points, edges] = [surface.nodes.len(), surface.points.len(), surface.crossings.edges.len()];
        let (face_points, besides) = (points - nodes, |count: usize| if count > 0 { ROOM_BESIDES } else { 0 });
        let of_nodes = if contacts.meetings.iter().flatten().any(|of| !of.faces) { nodes } else { 0 };
        let edge_contacts = EDGE_CONTACTS * edges + besides(edges);
        let room = ROOM_OF_NODES * of_nodes + ROOM_OF_FACE_POINTS * face_points + ROOM_OF_EDGES * edges;
        let pairs = room + besides(room);
        let inverse = 2 + points + edges + 1 + pairs;
        // an item's own nodes, and those of each thing that is near it
        let (own, of_near) = (of_nodes + 4 * face_points + 2 * edges, if face_points > 0 { 4 } else { 3 });
        let displacements = inverse + nodes + 1 + own + of_near * pairs;
        Self { list: 2, inverse, displacements, contacts: 2 * points + edge_contacts, edge_contacts, pairs }
    }
}

impl Surface {
    /// What is near each point and then each edge, of pairs of which `others` are the second edges.
    fn near_items<'a>(&'a self, mut others: &'a [u32]) -> Vec<&'a [u32]> {
        let points = self.points.len();
        let mut near: Vec<&[u32]> = vec![&[]; points + self.crossings.edges.len()];
        for (place, &point) in self.lists.points.iter().enumerate() {
            near[point as usize] = self.lists.triangles(place);
        }
        for pairs in self.crossings.near.chunk_by(|a, b| a[0] == b[0]) {
            let (of_edge, left) = others.split_at(pairs.len());
            (near[points + pairs[0][0] as usize], others) = (of_edge, left);
        }
        near
    }

    /// The nodes on which a contact of an item with what is near it may act, its own first; nodes may be there twice.
    fn acted_on(&self, item: usize, near: &[u32]) -> Vec<u32> {
        let Some(point) = self.points.get(item) else {
            let own = (item - self.points.len()) as u32;
            let ends = |edge: u32| self.crossings.edges[edge as usize].nodes;
            return std::iter::once(own).chain(near.iter().copied()).flat_map(ends).collect();
        };
        let corners = |&triangle: &u32| match point.triangle {
            Some(_) => self.facets[triangle as usize],
            None => {
                let [a, b, c] = self.triangles.triangles[triangle as usize];
                [a, b, c, c]
            }
        };
        point.parts().map(|(node, _)| node).chain(near.iter().flat_map(corners)).collect()
    }
}

/// Adds rows in compressed form: where each starts and the last one ends, then what is in them.
fn rows<R: AsRef<[u32]>>(words: &mut Vec<u32>, rows: impl Iterator<Item = R>) -> usize {
    let (mut starts, mut all) = (vec![0], Vec::new());
    for row in rows {
        all.extend_from_slice(row.as_ref());
        starts.push(all.len() as u32);
    }
    let begin = words.len();
    words.extend(starts);
    words.extend(all);
    begin
}

impl SurfaceContacts {
    /// Words of `surface_faces`.
    pub(super) fn face_words(&self) -> FaceWords {
        let surface = &self.surface;
        let of = &surface.triangles;
        let mut words = Vec::new();
        for (number, corners) in of.triangles.iter().enumerate() {
            words.extend(corners);
            words.extend(of.beside(number as u32));
            words.extend([of.bodies[number], (of.depths[number] as f32).to_bits()]);
        }
        let nodes = surface.nodes.len();
        let around = rows(&mut words, (0..nodes as u32).map(|node| of.around(node)));
        let meetings = words.len();
        for meeting in &self.meetings {
            words.extend(meeting_words(meeting.as_ref()));
        }
        let apart = rows(
            &mut words,
            (0..surface.points.len() as u32).map(|point| {
                let begin = surface.apart.partition_point(|&(other, _)| other < point);
                let end = surface.apart.partition_point(|&(other, _)| other <= point);
                surface.apart[begin..end].iter().map(|&(_, triangle)| triangle).collect::<Vec<u32>>()
            }),
        );
        let face_points = words.len();
        for point in &surface.points[nodes..] {
            words.extend(point.nodes);
            words.extend(point.weights.map(|weight| (weight as f32).to_bits()));
            words.extend(point.triangle);
        }
        let facets = words.len();
        if surface.points.len() > nodes {
            words.extend(surface.facets.iter().flatten());
        }
        let edges = words.len();
        let all = &surface.crossings.edges;
        for edge in all {
            words.extend([edge.nodes, edge.triangles, edge.across].as_flattened());
            words.push(edge.body);
        }
        let mut of_nodes: Vec<Vec<u32>> = vec![Vec::new(); if all.is_empty() { 0 } else { nodes }];
        (0..).zip(all).for_each(|(number, edge)| of_nodes[edge.nodes[0] as usize].push(number));
        let begins = rows(&mut words, of_nodes.iter());
        FaceWords { words, around, meetings, apart, face_points, facets, edges, begins }
    }

    /// Words of `surface_rows`: row and place at rest of each node.
    pub(super) fn row_words(&self, world: &World) -> Vec<u32> {
        let word = |&(body, row): &(u32, u32)| {
            let rest = world.get::<RestPosition>(self.bodies[body as usize]);
            let rest = rest.map_or(self.reference, |rest| rest.0[row as usize]) - self.reference;
            let [x, y, z] = bits(rest);
            [row, x, y, z]
        };
        self.surface.nodes.iter().flat_map(word).collect()
    }

    /// Words of `surface_lists`. Lists that there is no room for hold nothing: then kernels go through all.
    pub(super) fn list_words(&self, world: &World) -> ListWords {
        let (surface, layout) = (&self.surface, Layout::of(self));
        let of_edges = surface.crossings.near.len();
        let fits = surface.lists.triangles.len() + of_edges <= layout.pairs;
        let radius = if fits { surface.lists.radius.min(f64::from(f32::MAX)) as f32 } else { -1.0 };
        let mut pieces = Vec::new();
        let mut first = vec![radius.to_bits(), u32::from(of_edges <= layout.edge_contacts)];
        if fits {
            let others: Vec<u32> = surface.crossings.near.iter().map(|pair| pair[1]).collect();
            let near = surface.near_items(&others);
            let mut of_nodes: Vec<Vec<u32>> = vec![Vec::new(); surface.nodes.len()];
            for (item, near) in near.iter().enumerate().filter(|(_, near)| !near.is_empty()) {
                for node in surface.acted_on(item, near) {
                    let of_node = &mut of_nodes[node as usize];
                    if of_node.last() != Some(&(item as u32)) {
                        of_node.push(item as u32);
                    }
                }
            }
            rows(&mut first, near.iter());
            let mut inverse = Vec::new();
            rows(&mut inverse, of_nodes.iter());
            pieces.push((layout.inverse, inverse));
        }
        pieces.push((0, first));
        let displacement = |&(body, row): &(u32, u32)| {
            let u = world.get::<Displacement>(self.bodies[body as usize]);
            bits(u.map_or(DVec3::ZERO, |u| u.vector(row as usize)))
        };
        pieces.push((layout.displacements, surface.nodes.iter().flat_map(displacement).collect()));
        ListWords { pieces, count: layout.displacements + 3 * surface.nodes.len() }
    }
}

fn bits(vector: DVec3) -> [u32; 3] {
    vector.as_vec3().to_array().map(f32::to_bits)
}

fn meeting_words(meeting: Option<&super::Meeting>) -> [u32; MEETING_WORDS] {
    let Some(of) = meeting else { return [0; MEETING_WORDS] };
    let spring = of.spring.unwrap_or(ContactSpring { share: 0.0, damping: 0.0 });
    let points = if of.faces { FACES_MEET } else { NODES_MEET };
    let [stick, slide] = of.friction;
    let of_spring = [of.thickness, spring.share, spring.damping];
    let [stick, slide] = [stick, slide].map(|number| (number as f32).to_bits());
    let [thickness, share, damping] = of_spring.map(|number| (number as f32).to_bits());
    let [edge, margin, settling] = [of.edge, MARGIN * of.edge, of.settling].map(|number| (number as f32).to_bits());
    let what = points | if of.edges { EDGES_MEET } else { 0 };
    [what, stick, slide, thickness, share, damping, edge, margin, settling]
}
