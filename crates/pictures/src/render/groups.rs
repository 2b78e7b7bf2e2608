//! Cells that are seen through to the same degree.

use super::RenderError;
use super::frame::{FieldAssociation, FrameFile};
use super::raster::Finish;
use sinew::scene::schema::Opacity;
use std::path::Path;

/// Groups of cells, by opacity; the lower its number the more a group hides.
pub struct Groups {
    opacities: Vec<f32>,
    /// Which body and material is in which group; the last one that fits counts.
    rules: Vec<(Option<u32>, Option<u32>, u8)>,
}

impl Groups {
    /// What a picture asks for; `folder`: of the run, which knows the numbers of names.
    pub fn new(folder: &Path, wanted: &[Opacity]) -> Result<Groups, RenderError> {
        let mut opacities = vec![1.0];
        opacities.extend(wanted.iter().map(|entry| entry.opacity as f32));
        opacities.sort_by(|a, b| b.total_cmp(a));
        opacities.dedup();
        let needed = wanted.iter().any(|entry| entry.body.is_some() || entry.material.is_some());
        let names = if needed { Names::read(folder)? } else { Names::default() };
        let mut rules = Vec::new();
        for entry in wanted {
            let place = opacities.iter().position(|opacity| *opacity == entry.opacity as f32).unwrap_or(0);
            let body = names.number("body", &names.bodies, entry.body.as_deref())?;
            rules.push((body, names.number("material", &names.materials, entry.material.as_deref())?, place as u8));
        }
        Ok(Groups { opacities, rules })
    }

    /// The group of each cell; empty when all are in the first.
    pub fn of_cells(&self, frame: &FrameFile) -> Result<Vec<u8>, RenderError> {
        if self.rules.is_empty() {
            return Ok(Vec::new());
        }
        let numbers = |name: &str| -> Result<Vec<u32>, RenderError> {
            let entry = frame.entry(FieldAssociation::Cells, name).filter(|entry| entry.components == 1);
            let values = entry.map(|entry| frame.floats(entry)).transpose()?;
            Ok(values.unwrap_or_default().into_iter().map(|number| number as u32).collect())
        };
        let (bodies, materials) = (numbers("body")?, numbers("material")?);
        let fits = |wanted: Option<u32>, of: &[u32], cell: usize| wanted.is_none_or(|n| of.get(cell) == Some(&n));
        let group = |cell: usize| {
            let rule = self.rules.iter().rev().find(|(b, m, _)| fits(*b, &bodies, cell) && fits(*m, &materials, cell));
            rule.map_or(0, |rule| rule.2)
        };
        Ok((0..frame.cells).map(group).collect())
    }

    /// What the faces of a group are made of; nothing when they are not seen at all.
    pub fn finish(&self, group: u8, bared: bool) -> Option<Finish> {
        match self.opacities.get(usize::from(group)) {
            Some(opacity) if *opacity <= 0.0 => None,
            Some(opacity) if *opacity < 1.0 => Some(Finish::Sheet(*opacity)),
            _ if bared => Some(Finish::Bared),
            _ => Some(Finish::Plain),
        }
    }
}

/// The names of a run, in the order of their numbers.
#[derive(Default)]
struct Names {
    path: std::path::PathBuf,
    bodies: Vec<String>,
    materials: Vec<String>,
}

impl Names {
    fn read(folder: &Path) -> Result<Names, RenderError> {
        let path = folder.join("summary.json");
        let wrong = |reason: String| RenderError::Names { path: path.clone(), reason };
        let text = std::fs::read_to_string(&path).map_err(|error| wrong(error.to_string()))?;
        let summary: serde_json::Value = serde_json::from_str(&text).map_err(|error| wrong(error.to_string()))?;
        let list = |key: &str| -> Result<Vec<String>, RenderError> {
            let names = summary["names"][key].as_array().ok_or_else(|| wrong(format!("it has no names.{key}")))?;
            Ok(names.iter().map(|name| name.as_str().unwrap_or_default().to_string()).collect())
        };
        Ok(Names { bodies: list("bodies")?, materials: list("materials")?, path: path.clone() })
    }

    fn number(&self, what: &str, names: &[String], wanted: Option<&str>) -> Result<Option<u32>, RenderError> {
        let Some(wanted) = wanted else { return Ok(None) };
        let unknown = || RenderError::Names {
            path: self.path.clone(),
            reason: format!("there is no {what} {wanted:?}; there are: {}", names.join(", ")),
        };
        names.iter().position(|name| name == wanted).map(|place| Some(place as u32)).ok_or_else(unknown)
    }
}
