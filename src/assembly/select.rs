//! Selections: names, places and numbers become marks on the author's nodes, faces and elements.

use super::PlacedMesh;
use crate::math::coordinates;
use crate::mesh::{SurfaceFace, nodes_of_face, rotation_about_axes};
use crate::scene::choice;
use crate::scene::schema::Select;
use glam::DVec3;

/// What a [`Select`] picks; asked for nodes, faces or elements.
pub struct Selection {
    select: Select,
}

/// Why a selection picks nothing.
#[derive(Clone, Debug)]
pub struct Problem {
    /// What is wrong.
    pub message: String,
    /// What is allowed.
    pub notes: Vec<String>,
}

/// Checks the names and numbers in a selection.
///
/// # Errors
/// The first name or number that the mesh does not have.
pub fn pick(placed: &PlacedMesh, select: &Select) -> Result<Selection, Problem> {
    check(placed, select)?;
    Ok(Selection { select: select.clone() })
}

fn check(placed: &PlacedMesh, select: &Select) -> Result<(), Problem> {
    let mesh = &placed.mesh;
    let missing = |word: &str, wanted: &[u64], has: &dyn Fn(u64) -> bool, count: usize| {
        let missing: Vec<String> = wanted.iter().filter(|&&id| !has(id)).map(u64::to_string).take(5).collect();
        match missing.is_empty() {
            true => Ok(()),
            false => Err(Problem {
                message: format!("the mesh has no {word} {}", missing.join(", ")),
                notes: vec![format!("it has {count} {word}s, numbered as in its file (from 0 when it is generated)")],
            }),
        }
    };
    match select {
        Select::Set(name) => {
            let names: Vec<&str> = set_names(placed);
            if names.contains(&name.as_str()) {
                return Ok(());
            }
            Err(Problem { message: format!("the mesh has no set named {name:?}"), notes: choice(name, names) })
        }
        Select::Nodes(ids) => {
            let known = mesh.point_rows();
            missing("node", ids, &|id| known.contains_key(&id), mesh.points.len())
        }
        Select::Elements(ids) => {
            let known = numbers(mesh.element_count(), &mesh.element_ids);
            missing("element", ids, &|id| known.contains_key(&id), mesh.element_count())
        }
        Select::And(all) | Select::Or(all) => all.iter().try_for_each(|one| check(placed, one)),
        Select::Not(one) => check(placed, one),
        _ => Ok(()),
    }
}

fn set_names(placed: &PlacedMesh) -> Vec<&str> {
    let mesh = &placed.mesh;
    let mut names: Vec<&str> = mesh
        .node_sets
        .keys()
        .chain(mesh.face_sets.keys())
        .chain(mesh.element_sets.keys())
        .map(String::as_str)
        .collect();
    names.sort_unstable();
    names.dedup();
    names
}

fn numbers(count: usize, ids: &crate::mesh::Ids) -> std::collections::HashMap<u64, usize> {
    (0..count).map(|row| (ids.of(row), row)).collect()
}

impl Selection {
    /// A mark for each of the author's nodes.
    ///
    /// # Errors
    /// That none is picked.
    pub fn nodes(&self, placed: &PlacedMesh) -> Result<Vec<bool>, Problem> {
        some(placed, &self.select, nodes(placed, &self.select), "node")
    }

    /// The places in [`PlacedMesh::surface`] of the faces picked.
    ///
    /// # Errors
    /// That none is picked.
    pub fn faces(&self, placed: &PlacedMesh) -> Result<Vec<usize>, Problem> {
        let marks = some(placed, &self.select, faces(placed, &self.select), "face of the surface")?;
        Ok(marks.iter().enumerate().filter(|(_, marked)| **marked).map(|(place, _)| place).collect())
    }

    /// A mark for each of the author's elements.
    ///
    /// # Errors
    /// That none is picked.
    pub fn elements(&self, placed: &PlacedMesh) -> Result<Vec<bool>, Problem> {
        some(placed, &self.select, elements(placed, &self.select), "element")
    }
}

fn some(placed: &PlacedMesh, select: &Select, marks: Vec<bool>, word: &str) -> Result<Vec<bool>, Problem> {
    if marks.contains(&true) {
        return Ok(marks);
    }
    let message = format!("no {word} is here");
    Err(Problem { message, notes: where_it_is(placed, select) })
}

/// Where the body lies, and which of its nodes is nearest to a place where there is none.
fn where_it_is(placed: &PlacedMesh, select: &Select) -> Vec<String> {
    let (low, high) = placed.extent();
    let size = (high - low).max_element();
    let mut notes = vec![format!(
        "the body lies between ({}) and ({}), in metres, after scale, rotate and translate",
        coordinates(low, size),
        coordinates(high, size)
    )];
    let mesh = &placed.mesh;
    let nearest = distance_to(select).and_then(|distance| {
        let all = placed.points().iter().map(|&point| distance(point)).enumerate();
        all.min_by(|a, b| a.1.total_cmp(&b.1))
    });
    if let Some((row, distance)) = nearest {
        let (id, at) = (mesh.point_ids.of(row), placed.points()[row]);
        let place = coordinates(at, size);
        notes.push(match distance > 0.0 {
            true => format!("the nearest node is {id} at ({place}), {distance:.3e} m off"),
            false => format!("some nodes are there, such as {id} at ({place}), but not all of any face or element"),
        });
    }
    notes
}

/// How far a point is from a region of space (m), 0 within; `None` for selections that are none.
fn distance_to(select: &Select) -> Option<Box<dyn Fn(DVec3) -> f64>> {
    match *select {
        Select::Plane { normal, at, tolerance } => {
            let (normal, tolerance) = (normal.normalize(), tolerance.unwrap_or(0.0));
            Some(Box::new(move |x| ((normal.dot(x) - at).abs() - tolerance).max(0.0)))
        }
        Select::Box { min, max, rotate } => {
            let back = back(rotate, min.midpoint(max));
            Some(Box::new(move |x| {
                let x = back(x);
                x.distance(x.max(min).min(max))
            }))
        }
        Select::Sphere { center, radius } => Some(Box::new(move |x| (x.distance(center) - radius).max(0.0))),
        _ => None,
    }
}

/// Combines the marks that a way of marking gives to the parts of And, Or and Not; `None` for all other selections.
fn combine(placed: &PlacedMesh, select: &Select, marks: fn(&PlacedMesh, &Select) -> Vec<bool>) -> Option<Vec<bool>> {
    let merge = |all: &[Select], how: fn(bool, bool) -> bool| {
        all.iter().map(|one| marks(placed, one)).reduce(|mut a, b| {
            a.iter_mut().zip(b).for_each(|(a, b)| *a = how(*a, b));
            a
        })
    };
    match select {
        Select::And(all) => merge(all, |a, b| a && b),
        Select::Or(all) => merge(all, |a, b| a || b),
        Select::Not(one) => Some(marks(placed, one).into_iter().map(|mark| !mark).collect()),
        _ => None,
    }
}

/// Where a point would be if what is turned about a centre (degrees) were not.
fn back(rotate: DVec3, center: DVec3) -> impl Fn(DVec3) -> DVec3 {
    let turn = (rotate != DVec3::ZERO).then(|| rotation_about_axes(rotate).transpose());
    move |x| turn.map_or(x, |turn| center + turn * (x - center))
}

/// Whether a point lies in a region of space; `None` for selections that are none.
fn contains(placed: &PlacedMesh, select: &Select) -> Option<Box<dyn Fn(DVec3) -> bool>> {
    // far enough off a wall for points that were computed to lie on it
    let rounding = 1e-9 * placed.size();
    match *select {
        Select::All => Some(Box::new(|_| true)),
        Select::Plane { normal, at, tolerance } => {
            let (normal, tolerance) = (normal.normalize(), tolerance.unwrap_or(1e-6 * placed.size()));
            Some(Box::new(move |x| (normal.dot(x) - at).abs() <= tolerance))
        }
        Select::Box { min, max, rotate } => {
            let back = back(rotate, min.midpoint(max));
            let (min, max) = (min - rounding, max + rounding);
            Some(Box::new(move |x| {
                let x = back(x);
                x.cmpge(min).all() && x.cmple(max).all()
            }))
        }
        Select::Sphere { center, radius } => Some(Box::new(move |x| x.distance(center) <= radius + rounding)),
        Select::Cylinder { from, to, radius } => Some(Box::new(move |x| {
            let (axis, arm) = (to - from, x - from);
            let along = arm.dot(axis) / axis.length();
            let within = along >= -rounding && along <= axis.length() + rounding;
            within && (arm - axis * (along / axis.length())).length() <= radius + rounding
        })),
        Select::Ellipsoid { center, radii, rotate } => {
            let (back, radii) = (back(rotate, center), radii + rounding);
            Some(Box::new(move |x| ((back(x) - center) / radii).length_squared() <= 1.0))
        }
        _ => None,
    }
}

fn nodes(placed: &PlacedMesh, select: &Select) -> Vec<bool> {
    let mesh = &placed.mesh;
    let mut marks = vec![false; mesh.points.len()];
    let mut mark = |node: u32| marks[node as usize] = true;
    if let Some(inside) = contains(placed, select) {
        return placed.points().iter().map(|&x| inside(x)).collect();
    }
    match select {
        Select::Set(name) => {
            mesh.node_sets.get(name).into_iter().flatten().for_each(|&node| mark(node));
            if let Some(faces) = mesh.face_sets.get(name) {
                let middles = mesh.middles();
                faces.iter().flat_map(|face| nodes_of_face(face, &middles)).for_each(&mut mark);
            }
            let members = mesh.element_sets.get(name).into_iter().flatten();
            members.flat_map(|&element| mesh.element(element as usize)).for_each(|&node| mark(node));
        }
        Select::Surface { .. } => {
            let picked = faces(placed, select);
            let picked = placed.surface().iter().zip(picked).filter(|(_, picked)| *picked);
            picked.flat_map(|(face, _)| face.all_nodes()).for_each(mark);
        }
        Select::Nodes(ids) => {
            // with the points between them that refining has made
            if let Some(rows) = mesh.point_lists.get(ids) {
                rows.iter().for_each(|&row| mark(row));
            } else {
                let known = mesh.point_rows();
                ids.iter().filter_map(|id| known.get(id)).for_each(|&row| mark(row as u32));
            }
        }
        Select::Elements(_) => {
            let picked = elements(placed, select).into_iter().enumerate().filter(|(_, picked)| *picked);
            picked.flat_map(|(element, _)| mesh.element(element)).for_each(|&node| mark(node));
        }
        _ => return combine(placed, select, nodes).unwrap_or(marks),
    }
    marks
}

fn faces(placed: &PlacedMesh, select: &Select) -> Vec<bool> {
    let mesh = &placed.mesh;
    let surface = placed.surface();
    match select {
        Select::Set(name) => {
            if let Some(set) = mesh.face_sets.get(name) {
                let key = |mut nodes: [u32; 4]| {
                    nodes.sort_unstable();
                    nodes
                };
                // a triangle's repeated node may be any of the three
                let unique = |nodes: [u32; 4]| {
                    let mut nodes = key(nodes).to_vec();
                    nodes.dedup();
                    nodes
                };
                let set: std::collections::HashSet<Vec<u32>> = set.iter().map(|&nodes| unique(nodes)).collect();
                return surface.iter().map(|face| set.contains(&unique(face.nodes))).collect();
            }
            all_nodes(placed, select)
        }
        Select::Surface { normal, within } => {
            let limit = within.to_radians().cos() - 1e-12;
            let direction = normal.map(DVec3::normalize);
            let turned = |face: &SurfaceFace| {
                direction.is_none_or(|direction| face_normal(placed, face).dot(direction) >= limit)
            };
            surface.iter().map(turned).collect()
        }
        Select::Elements(_) => {
            let picked = elements(placed, select);
            surface.iter().map(|face| picked[face.element as usize]).collect()
        }
        Select::And(_) | Select::Or(_) | Select::Not(_) => combine(placed, select, faces).unwrap_or_default(),
        _ => all_nodes(placed, select),
    }
}

fn all_nodes(placed: &PlacedMesh, select: &Select) -> Vec<bool> {
    let marks = nodes(placed, select);
    placed.surface().iter().map(|face| face.all_nodes().all(|node| marks[node as usize])).collect()
}

fn face_normal(placed: &PlacedMesh, face: &SurfaceFace) -> DVec3 {
    let [a, b, c, d] = face.nodes.map(|node| placed.points()[node as usize]);
    (c - a).cross(d - b).try_normalize().unwrap_or_else(|| (b - a).cross(c - a).normalize_or_zero())
}

fn elements(placed: &PlacedMesh, select: &Select) -> Vec<bool> {
    let mesh = &placed.mesh;
    let mut marks = vec![false; mesh.element_count()];
    if let Some(inside) = contains(placed, select) {
        return (0..marks.len()).map(|element| inside(centroid(placed, element))).collect();
    }
    let all_nodes = |nodes: Vec<bool>| {
        (0..mesh.element_count()).map(|e| mesh.element(e).iter().all(|&node| nodes[node as usize])).collect()
    };
    match select {
        Select::Set(name) => match mesh.element_sets.get(name) {
            Some(set) => set.iter().for_each(|&element| marks[element as usize] = true),
            None => return all_nodes(nodes(placed, select)),
        },
        Select::Surface { .. } => {
            let picked = faces(placed, select);
            let picked = placed.surface().iter().zip(picked).filter(|(_, picked)| *picked);
            picked.for_each(|(face, _)| marks[face.element as usize] = true);
        }
        Select::Nodes(_) => return all_nodes(nodes(placed, select)),
        Select::Elements(ids) => {
            // parts of a refined element share its number
            let wanted: std::collections::HashSet<u64> = ids.iter().copied().collect();
            (0..marks.len()).for_each(|row| marks[row] = wanted.contains(&mesh.element_ids.of(row)));
        }
        _ => return combine(placed, select, elements).unwrap_or(marks),
    }
    marks
}

/// The mean of an element's nodes.
pub fn centroid(placed: &PlacedMesh, element: usize) -> DVec3 {
    let nodes = placed.mesh.element(element);
    nodes.iter().map(|&node| placed.points()[node as usize]).sum::<DVec3>() / nodes.len() as f64
}
