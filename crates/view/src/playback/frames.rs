//! Frames of a finished run, as bodies: what `sinew run` writes has all bodies in one mesh.

use glam::{DVec3, Vec3};
use sinew::driver::{Body, BodyState};
use sinew::mesh::{Cells, Ids};
use sinew::observation::SkinState;
use sinew::output::WHOLE;
use sinew::scene::schema::OutputField;
use sinew_pictures::render::{FieldAssociation, FrameFile, RenderError, Series, Skins};
use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

/// Reads frames.
pub struct Frames {
    /// Their times and files.
    pub series: Series,
    skins: Skins,
    /// All cells that the run began with.
    whole: Cells,
    /// Of each of those its body, and its place there.
    homes: Vec<(u32, u32)>,
    rest: Vec<Vec3>,
    /// The points of each body.
    points: Vec<Range<usize>>,
    /// Whether displacements were written.
    pub moves: bool,
    /// Which elements of each body are there, and since when.
    alive: Vec<(Arc<Vec<u8>>, u64)>,
}

/// Numbers of the arrays of a frame; nothing where it does not have it.
fn numbers(frame: &FrameFile, of: FieldAssociation, name: &str) -> Result<Option<(Vec<f32>, usize)>, RenderError> {
    let entry = frame.entry(of, name);
    entry.map(|entry| Ok((frame.floats(entry)?, entry.components))).transpose()
}

/// Numbers of things, of such an array.
fn integers(frame: &FrameFile, of: FieldAssociation, name: &str) -> Result<Option<Vec<i64>>, RenderError> {
    frame.entry(of, name).map(|entry| frame.integers(entry)).transpose()
}

fn damaged_file(path: &Path, what: &str) -> RenderError {
    RenderError::Damaged { path: path.to_path_buf(), reason: what.into() }
}

/// Of each cell of a frame its place among all: a frame lacks cells that are gone, and keeps the order of the others.
fn places(of: &Cells, whole: &Cells) -> Option<Vec<usize>> {
    let mut all = whole.iter().enumerate();
    of.iter().map(|cell| all.find(|(_, known)| *known == cell).map(|(place, _)| place)).collect()
}

impl Frames {
    /// Of an output folder; bodies and materials have names by their numbers.
    pub fn open(folder: &Path, bodies: &[String], materials: &[String]) -> Result<(Self, Vec<Body>), RenderError> {
        let series = Series::open(folder)?;
        let first = FrameFile::open(&series.frames[0].1)?;
        let of_first = first.cells()?;
        let whole = match folder.join(WHOLE) {
            path if path.exists() => FrameFile::open(&path)?.cells()?,
            _ => of_first.clone(),
        };
        let damaged = |what: &str| damaged_file(&first.path, what);
        let entry =
            first.entry(FieldAssociation::Mesh, "Points").ok_or_else(|| damaged("the array Points is missing"))?;
        let rest = first.vectors(entry)?;
        let of_points = integers(&first, FieldAssociation::Points, "body")?.unwrap_or_default();
        let mut points = Vec::new();
        for alike in of_points.chunk_by(|a, b| a == b) {
            let begin = points.last().map_or(0, |range: &Range<usize>| range.end);
            points.push(begin..begin + alike.len());
        }
        if points.is_empty() {
            points.push(0..rest.len());
        }
        let mut own: Vec<Cells> = vec![Cells::default(); points.len()];
        let mut homes = Vec::with_capacity(whole.len());
        for (kind, nodes) in whole.iter() {
            let body = points.partition_point(|range| range.end <= nodes[0] as usize);
            let begin = points.get(body).ok_or_else(|| damaged("a cell has points of no body"))?.start as u32;
            homes.push((body as u32, own[body].len() as u32));
            own[body].extend_kind(kind, nodes.iter().map(|node| node.wrapping_sub(begin)));
        }
        let names = NamesOfRows::read(&first, &of_first, &whole, &homes, &own)
            .map_err(|error| error.unwrap_or_else(|| damaged("its cells are not those of the whole")))?;
        let known = |number: usize| bodies.get(number).cloned().unwrap_or_else(|| format!("body {number}"));
        let of_body = |(number, (cells, range)): (usize, (Cells, &Range<usize>))| Body {
            name: known(number),
            rest: rest[range.clone()].iter().map(|place| place.to_array()).collect(),
            nodes: Ids::Named(names.nodes[range.clone()].to_vec()),
            elements: Ids::Named(names.elements[number].clone()),
            materials: materials.to_vec(),
            element_materials: names.materials[number].clone(),
            constrained: vec![0; range.len()],
            sets: Default::default(),
            on_gpu: None,
            cells,
        };
        let found = own.into_iter().zip(&points).enumerate().map(of_body).collect();
        let skins = Skins::open(folder);
        let moves = first.entry(FieldAssociation::Points, "displacement").is_some();
        Ok((Self { series, skins, whole, homes, rest, points, moves, alive: Vec::new() }, found))
    }

    /// The bodies in a frame, with the numbers of a field and vectors for arrows where it has them.
    pub fn read(
        &mut self,
        row: usize,
        bodies: &[Body],
        field: Option<OutputField>,
        arrows: Option<OutputField>,
    ) -> Result<Vec<BodyState>, RenderError> {
        let frame = FrameFile::open(&self.series.frames[row].1)?;
        let damaged = |what: &str| damaged_file(&frame.path, what);
        let cells = frame.cells()?;
        let places =
            places(&cells, &self.whole).ok_or_else(|| damaged("its cells are not those of the first frame"))?;
        if frame.points != self.rest.len() {
            return Err(damaged("its points are not those of the first frame"));
        }
        self.note_alive(&frame, &places, bodies)?;
        let moved = numbers(&frame, FieldAssociation::Points, "displacement")?.map(|found| found.0);
        let arrows = match arrows {
            Some(field) => numbers(&frame, FieldAssociation::Points, field.array())?,
            None => None,
        };
        let of = |field: OutputField| match field.is_of_nodes() {
            true => FieldAssociation::Points,
            false => FieldAssociation::Cells,
        };
        let values = match field {
            Some(field) => numbers(&frame, of(field), field.array())?.map(|found| (field, found)),
            None => None,
        };
        let mut skins = self.skin_states(&frame, bodies)?;
        let mut states = Vec::new();
        for (number, range) in self.points.iter().enumerate() {
            let three = |all: &[f32]| all[3 * range.start..3 * range.end].as_chunks::<3>().0.to_vec();
            let by: Vec<[f32; 3]> = moved.as_deref().map_or_else(|| vec![[0.0; 3]; range.len()], three);
            let positions = self.rest[range.clone()].iter().zip(by);
            let (alive, topology) = self.alive[number].clone();
            let (values, components) = match &values {
                None => (Vec::new(), 0),
                Some((field, (all, components))) if field.is_of_nodes() => {
                    (all[components * range.start..components * range.end].to_vec(), *components)
                }
                Some((_, (all, components))) => {
                    let own = self.of_elements(number, bodies[number].cells.len(), &places, (all, *components));
                    (own, *components)
                }
            };
            states.push(BodyState {
                positions: positions.map(|(rest, by)| (*rest + Vec3::from_array(by)).to_array()).collect(),
                alive,
                topology,
                values,
                components,
                arrows: arrows.as_ref().filter(|found| found.1 == 3).map(|found| three(&found.0)).unwrap_or_default(),
                skin: skins.get_mut(number).and_then(Option::take),
            });
        }
        Ok(states)
    }

    /// Takes note of which elements are there, and whether that has changed.
    fn note_alive(&mut self, frame: &FrameFile, places: &[usize], bodies: &[Body]) -> Result<(), RenderError> {
        let flags = numbers(frame, FieldAssociation::Cells, "alive")?.map(|found| found.0);
        let mut alive: Vec<Vec<u8>> = bodies.iter().map(|body| vec![0; body.cells.len()]).collect();
        for (cell, place) in places.iter().enumerate() {
            let (body, at) = self.homes[*place];
            alive[body as usize][at as usize] = u8::from(flags.as_ref().is_none_or(|flags| flags[cell] != 0.0));
        }
        for (number, now) in alive.into_iter().enumerate() {
            match self.alive.get_mut(number) {
                Some(known) if *known.0 == now => {}
                Some(known) => *known = (Arc::new(now), known.1 + 1),
                None => self.alive.push((Arc::new(now), 1)),
            }
        }
        Ok(())
    }

    /// The numbers of a body's elements, of those of all cells of a frame; 0 where they are gone.
    fn of_elements(
        &self,
        number: usize,
        count: usize,
        places: &[usize],
        (all, components): (&[f32], usize),
    ) -> Vec<f32> {
        let mut own = vec![0.0; components * count];
        for (place, row) in places.iter().zip(all.chunks_exact(components.max(1))) {
            let (body, at) = self.homes[*place];
            if body as usize == number {
                own[components * at as usize..][..components].copy_from_slice(row);
            }
        }
        own
    }

    fn skin_states(&self, frame: &FrameFile, bodies: &[Body]) -> Result<Vec<Option<SkinState>>, RenderError> {
        let mut states: Vec<Option<SkinState>> = bodies.iter().map(|_| None).collect();
        let elements = integers(frame, FieldAssociation::Cells, "element")?.unwrap_or_default();
        for skin in self.skins.of_frame(frame)? {
            let wide = |places: &[Vec3]| places.iter().map(|place| DVec3::from(*place)).collect();
            let number = |cell: &usize| elements.get(*cell).copied().unwrap_or(-1);
            if let Some(state) = states.get_mut(skin.body as usize) {
                *state = Some(SkinState {
                    rest: wide(&skin.rest),
                    points: wide(&skin.vertices),
                    normals: wide(&skin.normals),
                    triangles: skin.faces.iter().map(|[a, b, c, _]| [*a, *b, *c]).collect(),
                    elements: skin.carriers.iter().map(|(cell, _)| number(cell)).collect(),
                    weights: skin.carriers.iter().map(|(_, weights)| *weights).collect(),
                    texture: skin.texture,
                });
            }
        }
        Ok(states)
    }
}

/// What the first frame calls nodes and elements, and what those are made of.
struct NamesOfRows {
    nodes: Vec<u64>,
    /// Of each body.
    elements: Vec<Vec<u64>>,
    materials: Vec<Vec<u32>>,
}

impl NamesOfRows {
    /// None where the cells are not some of the whole.
    fn read(
        first: &FrameFile,
        cells: &Cells,
        whole: &Cells,
        homes: &[(u32, u32)],
        own: &[Cells],
    ) -> Result<Self, Option<RenderError>> {
        let of_cells = |name| integers(first, FieldAssociation::Cells, name).map_err(Some);
        let nodes = integers(first, FieldAssociation::Points, "node").map_err(Some)?;
        let nodes = nodes.map_or_else(
            || (0..first.points as u64).collect(),
            |found| found.into_iter().map(|number| number as u64).collect(),
        );
        let (elements, materials) = (of_cells("element")?, of_cells("material")?);
        let places = places(cells, whole).ok_or(None)?;
        // what is gone before the first frame goes by its place
        let mut names: Vec<Vec<u64>> = own.iter().map(|cells| (0..cells.len() as u64).collect()).collect();
        let mut made_of: Vec<Vec<u32>> = own.iter().map(|cells| vec![0; cells.len()]).collect();
        for (cell, place) in places.iter().enumerate() {
            let (body, at) = homes[*place];
            if let Some(all) = &elements {
                names[body as usize][at as usize] = all[cell] as u64;
            }
            if let Some(all) = &materials {
                made_of[body as usize][at as usize] = all[cell] as u32;
            }
        }
        Ok(Self { nodes, elements: names, materials: made_of })
    }
}
