//! Mesh files: the format is told from the content.

pub mod cursor;
pub mod draft;
mod fault;
mod orientation;

pub use fault::Fault;

use super::{Mesh, MeshError, gmsh, vtk, vtu};
use std::path::Path;

const FORMATS: &str =
    "sinew reads Gmsh (formats 1, 2.x, 4.1), legacy VTK and VTU files with tetrahedra, hexahedra or wedges";

impl Mesh {
    /// Reads a mesh file: Gmsh 1, 2.x or 4.1, legacy VTK, or VTU, each as text or binary.
    ///
    /// Physical groups become named sets, and so does integer cell data of at most 64 values (`NAME=VALUE`); cell data
    /// of three components become vectors of elements. A file that lists all its elements inside out is turned round
    /// with a note; `flip_inverted` does the same to single elements. What cannot be simulated is an error with all
    /// findings.
    pub fn read(path: impl AsRef<Path>, flip_inverted: bool) -> Result<Mesh, MeshError> {
        let path = path.as_ref();
        let bytes = std::fs::read(path).map_err(|source| MeshError::Unreadable { file: path.into(), source })?;
        Self::from_bytes(path, &bytes, flip_inverted)
    }

    /// As [`Self::read`], from what a file holds; `path` is its name in messages.
    ///
    /// # Errors
    /// As [`Self::read`].
    pub fn from_bytes(path: impl AsRef<Path>, bytes: &[u8], flip_inverted: bool) -> Result<Mesh, MeshError> {
        let path = path.as_ref();
        let mut mesh = parse(bytes, path).map_err(|fault| fault.in_file(path))?;
        mesh.orient(flip_inverted);
        mesh.require_sound(&path.display().to_string())?;
        Ok(mesh)
    }
}

fn parse(bytes: &[u8], path: &Path) -> Result<Mesh, Fault> {
    let start = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes).trim_ascii_start();
    if start.starts_with(b"$") {
        gmsh::read(start_at(bytes, start))?.finish()
    } else if start.starts_with(b"# vtk DataFile") {
        vtk::read(start_at(bytes, start))?.draft()?.finish()
    } else if start.starts_with(b"<") {
        vtu::parse(bytes)?.draft()?.finish()
    } else {
        Err(unknown(start, path))
    }
}

/// The file from its first word on; lines before it still count.
fn start_at<'a>(bytes: &'a [u8], start: &[u8]) -> cursor::Cursor<'a> {
    cursor::Cursor::new(bytes, bytes.len() - start.len())
}

fn unknown(start: &[u8], path: &Path) -> Fault {
    let extension = path.extension().map(|name| name.to_string_lossy().to_lowercase()).unwrap_or_default();
    let what = match (start, extension.as_str()) {
        ([], _) => "the file is empty".to_string(),
        ([0x1f, 0x8b, ..], _) => "the file is compressed with gzip: unpack it first".to_string(),
        (_, "stl" | "obj" | "ply" | "off") => {
            format!("a .{extension} file holds a surface, sinew needs volume elements")
        }
        (_, "msh" | "vtk" | "vtu") => format!("the file does not begin as a .{extension} file does"),
        (_, "") => "the format is not known".to_string(),
        _ => format!("the format of .{extension} files is not known"),
    };
    Fault::whole(what, FORMATS)
}
