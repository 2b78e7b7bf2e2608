//! Files of triangles: STL, as text or binary, OBJ, PLY, and glTF. The format is told from the content.

use super::Triangles;
use super::gltf::{self, Beside};
use super::obj;
use super::ply;
use crate::{Cursor, Fault, MeshError, NumberForm};
use glam::DVec3;
use std::path::{Component, Path};

const FORMATS: &str = "surfaces are read from STL (text or binary), OBJ, PLY and glTF files";

/// What stands in a binary STL file before its triangles, and the bytes of one of these.
const HEAD: usize = 84;
const RECORD: usize = 50;

impl Triangles {
    /// Reads a file of triangles, STL, OBJ, PLY or glTF, whose coordinates are taken for metres. Points of equal
    /// coordinates are made one; polygons become fans about their first corner, and where these would fold, as those of
    /// polygons that are not convex may, other triangles of all their corners; texture coordinates are kept, of OBJ and
    /// glTF; normals, colours and the like are not read.
    ///
    /// # Errors
    /// When the file cannot be read or breaks the rules of its format, with the line or the byte.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, MeshError> {
        let path = path.as_ref();
        let bytes = std::fs::read(path).map_err(|source| MeshError::Unreadable { file: path.into(), source })?;
        let folder = path.parent().unwrap_or(Path::new(""));
        Self::from_bytes_beside(path, &bytes, &|name| {
            let within = Path::new(name).components().all(|part| matches!(part, Component::Normal(_)));
            let bytes = within.then(|| std::fs::read(folder.join(name)));
            bytes.ok_or("the file is not in the same folder")?.map_err(|error| error.to_string())
        })
    }

    /// As [`Self::read`], from what a file holds that needs no other; `path` is its name in messages.
    ///
    /// # Errors
    /// As [`Self::read`].
    pub fn from_bytes(path: impl AsRef<Path>, bytes: &[u8]) -> Result<Self, MeshError> {
        Self::from_bytes_beside(path, bytes, &|_| Err("no other file is read here".into()))
    }

    /// The same of a file that may need others: `beside` gives what these hold, by their names seen from its folder.
    ///
    /// # Errors
    /// As [`Self::read`].
    pub fn from_bytes_beside(path: impl AsRef<Path>, bytes: &[u8], beside: Beside<'_>) -> Result<Self, MeshError> {
        let path = path.as_ref();
        let mut read = parse(bytes, path, beside).map_err(|fault| fault.in_file(path))?;
        read.merge_points();
        Ok(read)
    }
}

fn parse(bytes: &[u8], path: &Path, beside: Beside<'_>) -> Result<Triangles, Fault> {
    let start = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes).trim_ascii_start();
    let extension = path.extension().map(|name| name.to_string_lossy().to_lowercase()).unwrap_or_default();
    // a binary file may begin as one of text does; its length tells them apart
    let read = if claimed(bytes).is_some_and(|count| bytes.len() as u64 == HEAD as u64 + RECORD as u64 * count) {
        stl_binary(bytes)?
    } else if start.starts_with(b"ply\n") || start.starts_with(b"ply\r\n") {
        ply::read(start)?
    } else if start.starts_with(b"glTF") || start.starts_with(b"{") {
        gltf::read(start, beside)?
    } else if start.get(..5).is_some_and(|word| word.eq_ignore_ascii_case(b"solid")) {
        stl_text(Cursor::new(bytes, bytes.len() - start.len()))?
    } else if has_vertices(start) {
        obj::read(Cursor::new(bytes, bytes.len() - start.len()))?
    } else {
        return Err(unknown(bytes, start, &extension));
    };
    if read.triangles.is_empty() {
        return Err(Fault::whole("the file has no triangles", "tools and skins are surfaces of triangles"));
    }
    Ok(read)
}

/// The triangles that a binary STL file says it has.
fn claimed(bytes: &[u8]) -> Option<u64> {
    let count: [u8; 4] = bytes.get(HEAD - 4..HEAD)?.try_into().ok()?;
    Some(u32::from_le_bytes(count).into())
}

/// Whether a line begins as those of points in an OBJ file do.
fn has_vertices(text: &[u8]) -> bool {
    let mut lines = text.split(|&byte| byte == b'\n').map(<[u8]>::trim_ascii_start);
    lines.any(|line| matches!(line, [b'v', b' ' | b'\t', ..]))
}

fn unknown(bytes: &[u8], start: &[u8], extension: &str) -> Fault {
    let what = match (start, extension) {
        ([], _) => "the file is empty".to_string(),
        ([0x1f, 0x8b, ..], _) => "the file is compressed with gzip: unpack it first".to_string(),
        (_, "stl") => match claimed(bytes) {
            Some(count) => format!(
                "the file begins with neither `solid` nor a head for its length: it claims {count} triangles, which \
                 take {} bytes, and has {}",
                HEAD as u64 + RECORD as u64 * count,
                bytes.len()
            ),
            None => "the file does not begin as a .stl file does".to_string(),
        },
        (_, "obj") => "the file has no lines of points, which begin with `v`".to_string(),
        (_, "msh" | "vtk" | "vtu") => format!("a .{extension} file holds a volume mesh, a tool is a surface"),
        (_, "") => "the format is not known".to_string(),
        _ => format!("the format of .{extension} files is not known"),
    };
    Fault::whole(what, FORMATS)
}

/// A coordinate (m).
fn finite(cursor: &Cursor<'_>, value: f64) -> Result<f64, Fault> {
    if value.is_finite() {
        return Ok(value);
    }
    Err(cursor.fault(format!("a coordinate is {value}"), "coordinates must be finite numbers"))
}

/// A head of 80 bytes, the number of triangles, and for each of them its normal and corners in f32, and two bytes.
fn stl_binary(bytes: &[u8]) -> Result<Triangles, Fault> {
    let mut cursor = Cursor::new(bytes, HEAD);
    cursor.form = NumberForm::LittleEndian;
    let count = (bytes.len() - HEAD) / RECORD;
    let mut read = Triangles {
        points: Vec::with_capacity(3 * count),
        triangles: Vec::with_capacity(count),
        ..Triangles::default()
    };
    for triangle in 0..count as u32 {
        cursor.take(12, "a normal")?;
        for _ in 0..3 {
            let mut point = [0.0; 3];
            for value in &mut point {
                let bytes = cursor.take(4, "a coordinate")?;
                let number = bytes.try_into().map_or(f32::NAN, f32::from_le_bytes);
                *value = finite(&cursor, number.into())?;
            }
            read.points.push(point.into());
        }
        cursor.take(2, "the end of a triangle")?;
        read.triangles.push([3 * triangle, 3 * triangle + 1, 3 * triangle + 2]);
    }
    Ok(read)
}

/// `solid NAME`, then `facet normal X Y Z outer loop vertex X Y Z vertex ... endloop endfacet` for each triangle, then
/// `endsolid NAME`; more solids may follow.
fn stl_text(mut cursor: Cursor<'_>) -> Result<Triangles, Fault> {
    const RULE: &str = "triangles are `facet normal X Y Z outer loop vertex X Y Z vertex X Y Z vertex X Y Z endloop \
                        endfacet`, between `solid NAME` and `endsolid NAME`";
    let mut read = Triangles::default();
    let mut is_open = false;
    while let Some(word) = cursor.try_word() {
        let is = |name: &str| word.eq_ignore_ascii_case(name.as_bytes());
        if is(if is_open { "endsolid" } else { "solid" }) {
            // a name, or nothing: on the same line
            cursor.try_line();
            is_open = !is_open;
        } else if is_open && is("facet") {
            cursor.expect("normal", RULE)?;
            for _ in 0..3 {
                // some programs write `nan` for triangles without area
                cursor.number::<f64>("a component of a normal")?;
            }
            cursor.expect("outer", RULE)?;
            cursor.expect("loop", RULE)?;
            let first = read.points.len() as u32;
            for _ in 0..3 {
                cursor.expect("vertex", RULE)?;
                read.points.push(point(&mut cursor)?);
            }
            cursor.expect("endloop", RULE)?;
            cursor.expect("endfacet", RULE)?;
            read.triangles.push([first, first + 1, first + 2]);
        } else {
            let found = String::from_utf8_lossy(&word[..word.len().min(40)]);
            let wanted = if is_open { "facet or endsolid" } else { "solid" };
            return Err(cursor.fault(format!("`{found}` where {wanted} should be"), RULE));
        }
    }
    if is_open {
        return Err(cursor.fault("the file ends without `endsolid`", "the file may have been cut short"));
    }
    Ok(read)
}

fn point(cursor: &mut Cursor<'_>) -> Result<DVec3, Fault> {
    let mut point = [0.0; 3];
    for value in &mut point {
        let number = cursor.number("a coordinate")?;
        *value = finite(cursor, number)?;
    }
    Ok(point.into())
}
