//! A surface of triangles as a PLY or an OBJ file: for programs that read no VTU files.

use crate::output::{OutputError, SurfaceFrame, replace};
use crate::scene::schema::SkinFormat;
use std::fs::File;
use std::io::{BufWriter, Result, Write};
use std::path::Path;

/// Writes a surface; the file appears when it is complete. Places are written with as many digits as give each back
/// exactly.
///
/// # Errors
/// What the system says.
pub fn write(path: &Path, format: SkinFormat, surface: &SurfaceFrame<'_>) -> std::result::Result<(), OutputError> {
    replace(path, |file| {
        let written = match format {
            SkinFormat::Ply => ply(file, surface),
            SkinFormat::Obj => obj(file, surface),
        };
        written.map_err(OutputError::system("write", path))
    })
}

/// Binary, in little-endian order: places in double, normals and texture coordinates in single precision.
fn ply(file: &mut BufWriter<File>, surface: &SurfaceFrame<'_>) -> Result<()> {
    let SurfaceFrame { time, points, normals, texture, triangles } = surface;
    writeln!(file, "ply\nformat binary_little_endian 1.0\ncomment t = {time:?} s\nelement vertex {}", points.len())?;
    ["x", "y", "z"].iter().try_for_each(|name| writeln!(file, "property double {name}"))?;
    ["nx", "ny", "nz"].iter().try_for_each(|name| writeln!(file, "property float {name}"))?;
    let of_pictures = if texture.is_empty() { &[][..] } else { &["s", "t"] };
    of_pictures.iter().try_for_each(|name| writeln!(file, "property float {name}"))?;
    writeln!(file, "element face {}\nproperty list uchar uint vertex_indices\nend_header", triangles.len())?;
    for (row, (point, normal)) in points.iter().zip(*normals).enumerate() {
        for number in point.to_array() {
            file.write_all(&number.to_le_bytes())?;
        }
        for number in normal.as_vec3().to_array().into_iter().chain(texture.get(row).copied().into_iter().flatten()) {
            file.write_all(&number.to_le_bytes())?;
        }
    }
    for corners in *triangles {
        file.write_all(&[3])?;
        for corner in corners {
            file.write_all(&corner.to_le_bytes())?;
        }
    }
    Ok(())
}

fn obj(file: &mut BufWriter<File>, surface: &SurfaceFrame<'_>) -> Result<()> {
    let SurfaceFrame { time, points, normals, texture, triangles } = surface;
    writeln!(file, "# t = {time:?} s")?;
    points.iter().try_for_each(|x| writeln!(file, "v {:?} {:?} {:?}", x.x, x.y, x.z))?;
    texture.iter().try_for_each(|[u, v]| writeln!(file, "vt {u:?} {v:?}"))?;
    normals
        .iter()
        .map(|normal| normal.as_vec3())
        .try_for_each(|n| writeln!(file, "vn {:?} {:?} {:?}", n.x, n.y, n.z))?;
    for corners in *triangles {
        let corner = |row: u32| match (row + 1, texture.is_empty()) {
            (row, true) => format!("{row}//{row}"),
            (row, false) => format!("{row}/{row}/{row}"),
        };
        writeln!(file, "f {}", corners.map(corner).join(" "))?;
    }
    Ok(())
}
