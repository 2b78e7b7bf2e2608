//! Skins of bodies: fine surfaces that are drawn in place of the bodies' own faces.

use super::RenderError;
use super::frame::{FieldAssociation, FrameFile};
use glam::Vec3;
use sinew::mesh::topology::MOST_NODES;
use std::collections::HashMap;
use std::fs;
use std::path::{Path, PathBuf};

/// The skins of a run, by what their files are called.
pub struct Skins {
    folder: PathBuf,
    names: Vec<String>,
}

/// A skin in one frame.
pub struct Skin {
    /// The number of its body.
    pub body: u32,
    /// Before anything moves (m), and now.
    pub rest: Vec<Vec3>,
    pub vertices: Vec<Vec3>,
    /// Outward normals now, of length 1: where texture coordinates differ at a place it has several points, with one
    /// normal.
    pub normals: Vec<Vec3>,
    /// Texture coordinates (u, v), v upwards; nothing of skins without.
    pub texture: Vec<[f32; 2]>,
    /// Triangles; the last point is repeated.
    pub faces: Vec<[u32; 4]>,
    /// What carries each point: a cell of the frame, and the shares of its nodes.
    pub carriers: Vec<(usize, [f32; MOST_NODES])>,
}

impl Skins {
    /// Of an output folder.
    pub fn open(folder: &Path) -> Skins {
        let entries = fs::read_dir(folder).into_iter().flatten().flatten();
        let name = |entry: fs::DirEntry| {
            Some(entry.file_name().to_str()?.strip_suffix(".pvd").filter(|name| name.starts_with("skin_"))?.to_string())
        };
        let mut names: Vec<String> = entries.filter_map(name).collect();
        names.sort();
        Skins { folder: folder.to_path_buf(), names }
    }

    /// Those that belong to a frame.
    pub fn of_frame(&self, frame: &FrameFile) -> Result<Vec<Skin>, RenderError> {
        let stem = frame.path.file_stem().and_then(|stem| stem.to_str());
        let Some(number) = stem.and_then(|stem| stem.strip_prefix("fields_")).filter(|_| !self.names.is_empty()) else {
            return Ok(Vec::new());
        };
        let cells = rows(frame)?;
        let paths = self.names.iter().map(|name| self.folder.join(format!("{name}_{number}.vtu")));
        paths.filter(|path| path.exists()).map(|path| Skin::read(&path, &cells)).collect()
    }
}

/// Rows of the cells by the numbers of body and element.
fn rows(frame: &FrameFile) -> Result<HashMap<(u32, i64), usize>, RenderError> {
    let numbers = |name: &str| match frame.entry(FieldAssociation::Cells, name) {
        Some(entry) => frame.integers(entry),
        None => Ok(vec![0; frame.cells]),
    };
    let pairs = numbers("body")?.into_iter().zip(numbers("element")?).enumerate();
    Ok(pairs.map(|(row, (body, element))| ((body as u32, element), row)).collect())
}

impl Skin {
    fn read(path: &Path, cells: &HashMap<(u32, i64), usize>) -> Result<Skin, RenderError> {
        let file = FrameFile::open(path)?;
        let array = |place: FieldAssociation, name: &str| {
            let missing = || RenderError::damaged(path, format!("the array {name} is missing"));
            file.entry(place, name).ok_or_else(missing)
        };
        let rest = file.vectors(array(FieldAssociation::Mesh, "Points")?)?;
        let displacement = file.vectors(array(FieldAssociation::Points, "displacement")?)?;
        let normals = file.vectors(array(FieldAssociation::Points, "normal")?)?;
        let texture = file.entry(FieldAssociation::Points, "texture").filter(|entry| entry.components == 2);
        let texture = texture.map(|entry| file.floats(entry)).transpose()?.unwrap_or_default();
        let body = file.integers(array(FieldAssociation::Points, "body")?)?.first().map_or(0, |body| *body as u32);
        let elements = file.integers(array(FieldAssociation::Points, "element")?)?;
        let weights = file.floats(array(FieldAssociation::Points, "weights")?)?;
        if weights.len() != MOST_NODES * rest.len() {
            return Err(RenderError::damaged(path, format!("the array weights has not {MOST_NODES} values a row")));
        }
        let carrier = |(element, weights): (i64, &[f32])| {
            let row = cells.get(&(body, element)).copied().unwrap_or(usize::MAX);
            (row, std::array::from_fn(|node| weights[node]))
        };
        Ok(Skin {
            body,
            normals,
            texture: texture.as_chunks::<2>().0.to_vec(),
            vertices: rest.iter().zip(&displacement).map(|(rest, by)| *rest + *by).collect(),
            faces: file.triangles()?.into_iter().map(|[a, b, c]| [a, b, c, c]).collect(),
            carriers: elements.into_iter().zip(weights.chunks_exact(MOST_NODES)).map(carrier).collect(),
            rest,
        })
    }

    /// Values at the points; `value`: at a corner of a cell.
    pub fn values(&self, corners: impl Fn(usize) -> Vec<f32>) -> Vec<f32> {
        let value = |(cell, weights): &(usize, [f32; MOST_NODES])| {
            // a colour does not go beyond those around it, as a place outside of its element does
            let parts = corners(*cell).into_iter().zip(weights).map(|(value, weight)| (value, weight.max(0.0)));
            let (sum, all) = parts.fold((0.0, 0.0), |(sum, all), (value, weight)| (sum + value * weight, all + weight));
            if all > 0.0 { sum / all } else { 0.0 }
        };
        self.carriers.iter().map(value).collect()
    }
}
