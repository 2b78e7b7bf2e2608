//! One frame, ready to be drawn: its surfaces in groups of the same finish, and what colours them.

use super::RenderError;
use super::camera::Fit;
use super::draw::RenderOptions;
use super::field::Field;
use super::frame::{FieldAssociation, FrameFile};
use super::ghost::Ghosts;
use super::groups::Groups;
use super::legend::Key;
use super::nodal::Averages;
use super::picture::{Colouring, Layer, Lines};
use super::plane::Plane;
use super::range::SeenValues;
use super::raster::Finish;
use super::section::Section;
use super::skins::{self, Skins};
use super::surface::{Faces, Outer, Skin};
use glam::Vec3;
use sinew::mesh::Cells;
use sinew::mesh::topology::MOST_NODES;
use sinew::output::WHOLE;
use sinew::scene::schema::Colours;
use std::path::Path;

/// What frames of a series share.
pub struct Reader {
    field: Field,
    smooth: bool,
    groups: Groups,
    plane: Option<Plane>,
    mesh: Mesh,
    /// The surface of what the bodies began with.
    skin: Skin,
    /// Fine surfaces that bodies have.
    skins: Skins,
    /// What is drawn of the shape at rest.
    ghosts: Option<Ghosts>,
}

struct Mesh {
    cells: Cells,
    faces: Faces,
    points: usize,
}

/// One frame.
pub struct State {
    rest: Vec<Vec3>,
    vertices: Vec<Vec3>,
    parts: Vec<Part>,
    /// Whether values are one a vertex: else one a corner of each face.
    values: Option<Vec<f32>>,
    sections: Vec<(Finish, Section)>,
    /// Fine surfaces, each with one value a vertex.
    skins: Vec<(Finish, skins::Skin, Vec<f32>)>,
}

/// Faces of one finish.
struct Part {
    finish: Finish,
    faces: Vec<[u32; 4]>,
    /// One a corner; empty where there is one a vertex.
    values: Vec<[f32; 4]>,
}

impl Mesh {
    fn read(frame: &FrameFile) -> Result<Mesh, RenderError> {
        let cells = frame.cells()?;
        Ok(Mesh { faces: Faces::new(&cells), cells, points: frame.points })
    }
}

impl Reader {
    /// Prepares for a series that begins with a frame; `folder`: of the series.
    pub fn new(folder: &Path, first: &FrameFile, options: &RenderOptions) -> Result<Reader, RenderError> {
        let picture = &options.picture;
        let field = Field::find(first, options.field.as_deref().unwrap_or(picture.field.array()))?;
        let mesh = Mesh::read(first)?;
        let points = points(first)?;
        let whole = whole(folder, &mesh)?;
        let began = whole.as_ref().unwrap_or(&mesh);
        let skins = Skins::open(folder);
        let ghosts = picture.ghost.then(|| Ghosts::new(first, &points, &began.faces, &skins)).transpose()?;
        let (low, high) = points.iter().fold((Vec3::MAX, Vec3::MIN), |(low, high), p| (low.min(*p), high.max(*p)));
        Ok(Reader {
            smooth: field.real && picture.colours == Colours::Smooth,
            field,
            groups: Groups::new(folder, &picture.opacity)?,
            plane: picture.cut.as_ref().map(|cut| Plane::new(cut, low.distance(high))),
            skin: began.faces.skin(),
            skins,
            mesh,
            ghosts,
        })
    }

    /// What gives the colour.
    pub fn field(&self) -> &Field {
        &self.field
    }

    /// What takes away.
    pub fn plane(&self) -> Option<Plane> {
        self.plane
    }

    /// Reads a frame.
    pub fn read(&mut self, path: &Path) -> Result<State, RenderError> {
        let frame = FrameFile::open(path)?;
        if (self.mesh.points, self.mesh.cells.len()) != (frame.points, frame.cells) {
            // elements have gone, or it is another mesh
            self.mesh = Mesh::read(&frame)?;
        }
        let alive = frame.entry(FieldAssociation::Cells, "alive").filter(|entry| entry.components == 1);
        let alive = alive.map(|entry| frame.floats(entry)).transpose()?;
        let rest = points(&frame)?;
        let mut vertices = rest.clone();
        if let Some(entry) = frame.entry(FieldAssociation::Points, "displacement") {
            frame.vectors(entry)?.iter().zip(&mut vertices).for_each(|(by, point)| *point += *by);
        }
        let of_cells = self.groups.of_cells(&frame)?;
        let group = |cell: u32| {
            let there = alive.as_ref().is_none_or(|alive| alive[cell as usize] != 0.0);
            there.then(|| of_cells.get(cell as usize).copied().unwrap_or(0))
        };
        let mut outer = self.mesh.faces.surface(group, Some(&self.skin));
        let skins = self.skins.of_frame(&frame)?;
        let bodies = frame.entry(FieldAssociation::Cells, "body").filter(|_| !skins.is_empty());
        let bodies = bodies.map(|entry| frame.floats(entry)).transpose()?.unwrap_or_default();
        let of_body = |cell: u32| bodies.get(cell as usize).map_or(0, |body| *body as u32);
        // where elements went the body's own faces close the hole
        outer.retain(|face| face.bared || !skins.iter().any(|skin| skin.body == of_body(face.cell)));
        let values = self.field.values(&frame)?;
        let source = match self.field.place {
            FieldAssociation::Cells if self.smooth => {
                let there = |cell: usize| group(cell as u32).is_some();
                FieldValues::Smooth(Averages::new(&frame, &rest, &self.mesh.cells, &values, there)?)
            }
            FieldAssociation::Cells => FieldValues::Cells(values),
            _ => FieldValues::Points(values),
        };
        let sections = self.sections(&vertices, &source, group);
        let parts = self.parts(&outer, &source);
        let skins = self.with_values(skins, &source, group);
        let values = if let FieldValues::Points(values) = source { Some(values) } else { None };
        Ok(State { rest, vertices, parts, values, sections, skins })
    }

    /// Skins with their values and what they are made of: as their bodies' faces.
    fn with_values(
        &self,
        skins: Vec<skins::Skin>,
        source: &FieldValues,
        group: impl Fn(u32) -> Option<u8>,
    ) -> Vec<(Finish, skins::Skin, Vec<f32>)> {
        let nodes: Vec<&[u32]> =
            if skins.is_empty() { Vec::new() } else { self.mesh.cells.iter().map(|c| c.1).collect() };
        let corners = |cell: usize| -> Vec<f32> {
            nodes.get(cell).into_iter().flat_map(|nodes| nodes.iter()).map(|node| source.value(cell, *node)).collect()
        };
        let seen = |skin: skins::Skin| {
            let first = skin.carriers.iter().find_map(|(cell, _)| group(u32::try_from(*cell).ok()?))?;
            let values = skin.values(corners);
            Some((self.groups.finish(first, false)?, skin, values))
        };
        skins.into_iter().filter_map(seen).collect()
    }

    /// Faces by finish.
    fn parts(&self, outer: &[Outer], source: &FieldValues) -> Vec<Part> {
        let mut parts: Vec<Part> = Vec::new();
        for face in outer {
            let Some(finish) = self.groups.finish(face.group, face.bared) else { continue };
            let place = parts.iter().position(|part| part.finish == finish).unwrap_or_else(|| {
                parts.push(Part { finish, faces: Vec::new(), values: Vec::new() });
                parts.len() - 1
            });
            parts[place].faces.push(face.points);
            if !matches!(source, FieldValues::Points(_)) {
                let values = face.points.map(|point| source.value(face.cell as usize, point));
                parts[place].values.push(values);
            }
        }
        parts
    }

    /// The cut through all cells that are there, by finish.
    fn sections(
        &self,
        vertices: &[Vec3],
        source: &FieldValues,
        group: impl Fn(u32) -> Option<u8>,
    ) -> Vec<(Finish, Section)> {
        let mut sections: Vec<(Finish, Section)> = Vec::new();
        let Some(plane) = &self.plane else { return sections };
        for (cell, (kind, corners)) in self.mesh.cells.iter().enumerate() {
            let Some(finish) = group(cell as u32).and_then(|group| self.groups.finish(group, false)) else { continue };
            let mut places = [Vec3::ZERO; MOST_NODES];
            let mut values = [0.0; MOST_NODES];
            for (row, corner) in corners.iter().enumerate() {
                places[row] = vertices[*corner as usize];
                values[row] = source.value(cell, *corner);
            }
            let place = sections.iter().position(|section| section.0 == finish).unwrap_or_else(|| {
                sections.push((finish, Section::default()));
                sections.len() - 1
            });
            sections[place].1.add(plane, kind, &places[..corners.len()], &values[..corners.len()]);
        }
        sections
    }

    /// The layers of a frame.
    pub fn layers<'a>(&'a self, state: &'a State, edges: bool) -> Vec<Layer<'a>> {
        let lines = if edges { Lines::All } else { Lines::None };
        let surface = state.parts.iter().map(|part| Layer {
            vertices: &state.vertices,
            faces: &part.faces,
            values: state.values.as_deref().map_or(Colouring::Corners(&part.values), Colouring::Vertices),
            finish: part.finish,
            lines,
            normals: &[],
            flat: None,
            cut: true,
        });
        let sections = state.sections.iter().map(|(finish, section)| Layer {
            vertices: &section.vertices,
            faces: &section.faces,
            values: Colouring::Vertices(&section.values),
            finish: *finish,
            lines: if edges { Lines::Sides(&section.sides) } else { Lines::None },
            normals: &[],
            flat: self.plane.map(|plane| plane.normal),
            cut: false,
        });
        let ghosts = self.ghosts.iter().flat_map(Ghosts::layers);
        let skins = state.skins.iter().map(|(finish, skin, values)| Layer {
            vertices: &skin.vertices,
            faces: &skin.faces,
            values: Colouring::Vertices(values),
            finish: *finish,
            // their triangles are fine, and say nothing of elements
            lines: Lines::None,
            normals: &skin.normals,
            flat: None,
            cut: true,
        });
        surface.chain(skins).chain(sections).chain(ghosts).collect()
    }
}

/// The mesh that the bodies began with, where the first frame lacks some of it already.
fn whole(folder: &Path, first: &Mesh) -> Result<Option<Mesh>, RenderError> {
    let path = folder.join(WHOLE);
    if !path.exists() {
        return Ok(None);
    }
    let mesh = Mesh::read(&FrameFile::open(&path)?)?;
    match mesh.points == first.points {
        true => Ok(Some(mesh)),
        false => Err(RenderError::damaged(&path, "its points are not those of the frames")),
    }
}

/// The places of points at rest (m).
fn points(frame: &FrameFile) -> Result<Vec<Vec3>, RenderError> {
    let missing = || RenderError::damaged(&frame.path, "the array Points is missing");
    frame.vectors(frame.entry(FieldAssociation::Mesh, "Points").ok_or_else(missing)?)
}

/// Where values come from.
enum FieldValues {
    Points(Vec<f32>),
    Cells(Vec<f32>),
    Smooth(Averages),
}

impl FieldValues {
    /// At a corner of a cell.
    fn value(&self, cell: usize, corner: u32) -> f32 {
        match self {
            FieldValues::Points(values) => values[corner as usize],
            FieldValues::Cells(values) => values[cell],
            FieldValues::Smooth(averages) => averages.at(cell, corner),
        }
    }
}

impl State {
    /// Moves it from its shape at rest by a multiple of its displacement.
    pub fn scale(&mut self, factor: f32) {
        for (point, rest) in self.vertices.iter_mut().zip(&self.rest) {
            *point = *rest + (*point - *rest) * factor;
        }
        for (_, skin, _) in &mut self.skins {
            for (point, rest) in skin.vertices.iter_mut().zip(&skin.rest) {
                *point = *rest + (*point - *rest) * factor;
            }
            // those of where it was
            skin.normals.clear();
        }
    }

    /// What its surfaces are, beside coloured by values.
    pub fn keys(&self, reader: &Reader) -> Vec<Key> {
        let bared = self.parts.iter().any(|part| part.finish == Finish::Bared);
        let keys = [(bared, Key::Bared), (reader.ghosts.is_some(), Key::Ghost)];
        keys.into_iter().filter(|key| key.0).map(|key| key.1).collect()
    }

    /// How far its bodies are behind a plane through the origin with a normal (m).
    pub fn depth(&self, normal: Vec3) -> f32 {
        let points = self.parts.iter().flat_map(|part| part.faces.iter().flatten());
        let of_skins = self.skins.iter().flat_map(|(_, skin, _)| &skin.vertices);
        let points = points.map(|point| &self.vertices[*point as usize]).chain(of_skins);
        points.map(|point| -normal.dot(*point)).fold(f32::MIN, f32::max)
    }

    /// Adds what this frame shows.
    pub fn measure(&self, reader: &Reader, seen: &mut SeenValues, fit: &mut Fit) {
        for part in &self.parts {
            for (row, face) in part.faces.iter().enumerate() {
                face.iter().for_each(|point| fit.see(self.vertices[*point as usize]));
                match &self.values {
                    Some(values) => face.iter().for_each(|point| seen.value(values[*point as usize])),
                    None => part.values[row].iter().for_each(|value| seen.value(*value)),
                }
            }
        }
        for (_, skin, values) in &self.skins {
            for &point in skin.faces.iter().flatten() {
                fit.see(skin.vertices[point as usize]);
                seen.value(values[point as usize]);
            }
        }
        let cut = self.sections.iter().flat_map(|section| &section.1.values);
        cut.for_each(|value| seen.value(*value));
        reader.ghosts.iter().flat_map(Ghosts::corners).for_each(|point| fit.see(point));
    }
}
