//! OBJ files: points, texture coordinates and polygons, as text.

use super::{Triangles, polygon};
use crate::{Cursor, Fault};
use glam::DVec3;

/// Lines `v X Y Z` of points, `vt U V` of texture coordinates and `f A/T B/T C/T ...` of polygons, whose corners are
/// counted from 1, or backwards from -1; what else stands behind a corner's `/` belongs to pictures, as all other lines
/// do. Corners without texture coordinates have (0, 0) where others have some.
pub(super) fn read(mut cursor: Cursor<'_>) -> Result<Triangles, Fault> {
    let mut read = Triangles::default();
    let mut texture: Vec<[f32; 2]> = Vec::new();
    let mut has_texture = false;
    while let Some(mut line) = cursor.try_line() {
        while line.ends_with('\\') {
            line.pop();
            let Some(more) = cursor.try_line() else { break };
            line.push_str(&more);
        }
        let text = line.split('#').next().unwrap_or_default();
        let mut words = text.split_whitespace();
        match words.next() {
            Some("v") => {
                let [x, y, z] = numbers(&mut words);
                let place = x.zip(y).zip(z).ok_or_else(|| {
                    cursor.fault(format!("`{text}` is no point"), "a point is `v X Y Z`, with finite numbers")
                })?;
                let ((x, y), z) = place;
                read.points.push([x, y, z].into());
            }
            Some("vt") => {
                // V may be left out
                let [u, v] = numbers(&mut words);
                let u = u.ok_or_else(|| {
                    let allowed = "texture coordinates are `vt U V`, with finite numbers";
                    cursor.fault(format!("`{text}` has no texture coordinates"), allowed)
                })?;
                texture.push([u as f32, v.unwrap_or(0.0) as f32]);
            }
            Some("f") => {
                let mut corners = Vec::new();
                for word in words {
                    let found = corner(word, read.points.len(), texture.len());
                    let (point, at) = found.map_err(|(what, allowed)| cursor.fault(what, allowed))?;
                    has_texture |= at.is_some();
                    corners.push((point, at.map_or([0.0; 2], |row| texture[row as usize])));
                }
                if corners.len() < 3 {
                    return Err(too_few(&cursor, text));
                }
                let places: Vec<DVec3> = corners.iter().map(|(point, _)| read.points[*point as usize]).collect();
                let wrong = |what: String| cursor.fault(format!("the polygon {what}"), polygon::RULE);
                for triangle in polygon::triangles(&places).map_err(wrong)? {
                    read.triangles.push(triangle.map(|corner| corners[corner].0));
                    read.texture.push(triangle.map(|corner| corners[corner].1));
                }
            }
            _ => {}
        }
    }
    if !has_texture {
        read.texture = Vec::new();
    }
    Ok(read)
}

/// The next numbers of a line; `None` where there is none that is finite.
fn numbers<'a, const N: usize>(words: &mut impl Iterator<Item = &'a str>) -> [Option<f64>; N] {
    std::array::from_fn(|_| words.next()?.parse().ok().filter(|number: &f64| number.is_finite()))
}

fn too_few(cursor: &Cursor<'_>, text: &str) -> Fault {
    cursor.fault(format!("`{text}` is no polygon"), "a polygon is `f A B C ...`, with three corners at least")
}

/// The rows of a corner's point and texture coordinates, as `7`, `7/1`, `7//2` or `-1/-1`; else what is wrong and what
/// is allowed.
fn corner(word: &str, points: usize, texture: usize) -> Result<(u32, Option<u32>), (String, String)> {
    let wrong = |of: &str, count: usize| {
        let allowed = format!("corners are numbers of the {count} {of} above, from 1 on, or backwards from -1 on");
        (format!("`{word}` is no corner"), allowed)
    };
    let mut numbers = word.split('/');
    let point = row(numbers.next().unwrap_or_default(), points).ok_or_else(|| wrong("points", points))?;
    let at = match numbers.next() {
        None | Some("") => None,
        Some(number) => Some(row(number, texture).ok_or_else(|| wrong("texture coordinates", texture))?),
    };
    Ok((point, at))
}

/// The row of a number that counts from 1, or backwards from -1.
fn row(number: &str, count: usize) -> Option<u32> {
    let row = match number.parse::<i64>().ok()? {
        number @ 1.. => number - 1,
        0 => return None,
        number => count as i64 + number,
    };
    u32::try_from(row).ok().filter(|&row| (row as usize) < count)
}
