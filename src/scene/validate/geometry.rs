//! Bodies and their meshes.

use super::{Validator, scene, select};
use crate::mesh::CellKind;
use crate::mesh::generators::cells_around;
use crate::scene::file_access::{FileKind, FileSource, Outside};
use crate::scene::limits::{MOST_COPIES, MOST_REFINEMENT};
use crate::scene::load::SceneFile;
use crate::scene::schema::{AccuracyReference, MeshSource, Start};
use crate::scene::suggest::{choice, list};
use crate::scene::syntax::Path;

/// Files of a kind: what they are called, how their names end, what the formats are, and what they begin with, where
/// that tells.
pub(super) struct KindOfFile {
    what: &'static str,
    endings: &'static [&'static str],
    formats: &'static str,
    begins: &'static [u8],
}

const MESHES: KindOfFile = KindOfFile {
    what: "mesh file",
    endings: &["msh", "vtk", "vtu"],
    formats: "Gmsh (.msh), legacy VTK (.vtk), VTU (.vtu)",
    begins: &[],
};

/// Files of triangles that are tools.
pub(super) const TOOLS: KindOfFile = KindOfFile {
    what: "surface file",
    endings: &["stl", "obj", "ply", "gltf", "glb"],
    formats: "STL (.stl), OBJ (.obj), PLY (.ply), glTF (.gltf, .glb)",
    begins: &[],
};

/// Pictures that skins have on them.
const IMAGES: KindOfFile =
    KindOfFile { what: "picture", endings: &["png"], formats: "PNG (.png)", begins: b"\x89PNG\r\n\x1a\n" };

pub(super) fn validate(file: &SceneFile, validator: &mut Validator) {
    for (name, body) in &file.scene.bodies {
        let path = scene("bodies").name(name);
        mesh(file, validator, &path.name("mesh"), &body.mesh);
        validator.above_zero(&path.name("scale"), body.scale, "");
        if body.refine > MOST_REFINEMENT {
            validator
                .must(&path.name("refine"), &format!("at most {MOST_REFINEMENT}"), body.refine)
                .note("each time makes eight elements of one: 10 times make a billion of it");
        }
        if body.copies == 0 || body.copies > MOST_COPIES {
            validator.must(&path.name("copies"), &format!("between 1 and {MOST_COPIES}"), body.copies);
        }
        if !(body.apart * f64::from(body.copies)).is_finite() {
            validator.out.error_at(path.name("apart"), "the last copy would stand beyond all numbers");
        }
        validator.not_negative(&path.name("hourglass"), body.hourglass, "");
        if let Some(Start::Scrambled { amplitude, .. }) = body.start {
            validator.not_negative(&path.name("start").name("amplitude"), amplitude, "m");
        }
        if let Some(skin) = &body.skin {
            named_file(file, validator, &path.name("skin").name("file"), &skin.file, &TOOLS);
            validator.above_zero(&path.name("skin").name("scale"), skin.scale, "");
            if let Some(image) = &skin.image {
                named_file(file, validator, &path.name("skin").name("image"), image, &IMAGES);
            }
            if body.copies > 1 {
                validator
                    .out
                    .error_at(path.name("skin"), format!("a skin on {} copies of a mesh", body.copies))
                    .note("one copy may have a skin: leave `copies` or `skin` out");
            }
        }
        if body.hourglass == 0.0 {
            validator
                .out
                .warn_at(
                    path.name("hourglass"),
                    "without hourglass control one-point hexahedra have motions that nothing resists",
                )
                .note("they grow unseen and spoil what is computed: leave `hourglass` out, or use Hex8MeanDilatation");
        }
        for (i, region) in body.regions.iter().enumerate() {
            select::validate(validator, &path.name("regions").index(i).name("on"), &region.on);
        }
    }
    accuracy(file, validator);
}

fn accuracy(file: &SceneFile, validator: &mut Validator) {
    let wanted = &file.scene.accuracy;
    let path = scene("accuracy");
    if let Some(target) = wanted.target {
        let own = path.name("target");
        validator.above_zero(&own, target, "");
        if target >= 1.0 && target.is_finite() {
            let (percent, plain) = (100.0 * target, target / 100.0);
            validator.out.warn_at(own, format!("an error of {percent} % is allowed here: {target} % would be {plain}"));
        }
    }
    for (quantity, &size) in &wanted.uncertainty {
        let own = path.name("uncertainty").name(quantity);
        validator.not_negative(&own, size, "");
        let message = match &wanted.reference {
            AccuracyReference::SelfMade => {
                "a reference that is made knows its own uncertainty; this is for `Values` and `Files`"
            }
            AccuracyReference::Values(values) if !values.contains_key(quantity) => {
                "`reference` has no value of that name"
            }
            _ => continue,
        };
        validator.out.error_at(own, message);
    }
    if let AccuracyReference::Files(files) = &wanted.reference {
        for (i, name) in files.iter().enumerate() {
            if let Err(outside) = file.file(name) {
                tell_outside(validator, &path.name("reference").index(i), &outside);
            }
        }
    }
    let empty = match &wanted.reference {
        AccuracyReference::SelfMade => false,
        AccuracyReference::Values(values) => values.is_empty(),
        AccuracyReference::Files(files) => files.is_empty(),
    };
    if empty {
        let message = "the reference is empty: there is nothing to measure errors against";
        validator.out.error_at(path.name("reference"), message).note("leave `reference` out to have one made");
    }
}

fn mesh(file: &SceneFile, validator: &mut Validator, path: &Path, mesh: &MeshSource) {
    match mesh {
        MeshSource::File { path: name, tets, hexes, .. } => {
            mesh_file(file, validator, &path.name("path"), name);
            if tets.cell() != CellKind::Tet4 {
                validator.must(&path.name("tets"), "Tet4 or Tet4NodalPressure", format!("{tets:?}"));
            }
            if hexes.cell() != CellKind::Hex8 {
                validator.must(&path.name("hexes"), "Hex8 or Hex8MeanDilatation", format!("{hexes:?}"));
            }
        }
        MeshSource::Box { size, cells, .. } => {
            validator.all_above_zero(&path.name("size"), *size, "m");
            each_way(validator, &path.name("cells"), *cells);
        }
        MeshSource::Hexahedron { cells, .. } => each_way(validator, &path.name("cells"), *cells),
        MeshSource::Tube { inner, outer, height, angle, cells, .. } => {
            validator.above_zero(&path.name("inner"), *inner, "m");
            validator.above_zero(&path.name("height"), *height, "m");
            if outer <= inner {
                let found = super::with_unit(*outer, "m");
                let note = format!("`inner` is {}", super::with_unit(*inner, "m"));
                validator.must(&path.name("outer"), "more than `inner`", found).note(note);
            }
            if !(*angle > 0.0 && *angle <= 360.0) {
                validator.must(&path.name("angle"), "above 0 and at most 360 degrees", angle);
            } else if cells.1 > 0 && cells.1 < cells_around(*angle) {
                let be = format!("{} or more for an angle of {angle} degrees", cells_around(*angle));
                validator
                    .must(&path.name("cells").index(1), &be, cells.1)
                    .note("a cell turns by less than 180 degrees");
            }
            each_way(validator, &path.name("cells"), *cells);
        }
        MeshSource::Cylinder { radius, height, across, along, .. } => {
            validator.above_zero(&path.name("radius"), *radius, "m");
            validator.above_zero(&path.name("height"), *height, "m");
            at_least_one(validator, &path.name("across"), *across);
            at_least_one(validator, &path.name("along"), *along);
        }
        MeshSource::Ellipsoid { radii, across, .. } => {
            validator.all_above_zero(&path.name("radii"), *radii, "m");
            at_least_one(validator, &path.name("across"), *across);
        }
        MeshSource::Lens { diameter, thickness, across, through, .. } => {
            validator.above_zero(&path.name("diameter"), *diameter, "m");
            validator.above_zero(&path.name("thickness"), *thickness, "m");
            if thickness > diameter && *diameter > 0.0 {
                validator
                    .must(&path.name("thickness"), "at most the diameter", super::with_unit(*thickness, "m"))
                    .note(format!(
                        "`diameter` is {}; a lens as thick as wide is a ball",
                        super::with_unit(*diameter, "m")
                    ));
            }
            at_least_one(validator, &path.name("across"), *across);
            at_least_one(validator, &path.name("through"), *through);
        }
    }
}

/// Cells in three directions: at least one in each.
fn each_way(validator: &mut Validator, path: &Path, cells: (u32, u32, u32)) {
    let cells = [cells.0, cells.1, cells.2];
    for (i, count) in cells.into_iter().enumerate() {
        at_least_one(validator, &path.index(i), count);
    }
}

fn at_least_one(validator: &mut Validator, path: &Path, count: u32) {
    if count == 0 {
        validator.must(path, "1 or more", count);
    }
}

fn mesh_file(file: &SceneFile, validator: &mut Validator, path: &Path, name: &str) {
    if !file.meshes.contains_key(name) {
        named_file(file, validator, path, name, &MESHES);
    }
}

/// Whether a file that the scene names can be one of a kind.
pub(super) fn named_file(file: &SceneFile, validator: &mut Validator, path: &Path, name: &str, kind: &KindOfFile) {
    let KindOfFile { what, endings, formats, begins } = *kind;
    let begins_so = || begins.is_empty() || file.bytes(name, u64::MAX).is_ok_and(|bytes| bytes.starts_with(begins));
    let (found, full, mut there) = match file.file(name).and_then(|full| Ok((full, file.look_up(name)?))) {
        Ok((full, (found, there))) => (found, full, there),
        Err(outside) => return tell_outside(validator, path, &outside),
    };
    let ending = full.extension().and_then(|ending| ending.to_str()).unwrap_or_default().to_ascii_lowercase();
    if name.is_empty() {
        validator.out.error_at(path, format!("the path of the {what} is empty"));
    } else if found == FileKind::Folder {
        validator.out.error_at(path, format!("`{name}` is a folder, not a {what}"));
    } else if found == FileKind::Nothing {
        let may_be =
            |name: &str| endings.iter().any(|ending| name.to_ascii_lowercase().ends_with(&format!(".{ending}")));
        there.retain(|name| may_be(name));
        let wanted = full.file_name().and_then(|name| name.to_str()).unwrap_or(name);
        let diagnostic = validator.out.error_at(path, format!("there is no file `{name}`"));
        if there.is_empty() {
            let folder = full.parent().unwrap_or(&file.folder);
            let place = match file.files {
                FileSource::Memory(_) => "among the files in memory".to_string(),
                FileSource::Disk if folder.as_os_str().is_empty() => "in this folder".to_string(),
                FileSource::Disk => format!("in the folder `{}`", folder.display()),
            };
            diagnostic
                .note(format!("no {what}s (.{}) {place}; paths are relative to the scene file", endings.join(", .")));
        } else {
            let mut notes = choice(wanted, there.iter().map(String::as_str));
            if let Some(last) = notes.last_mut() {
                *last = format!("there are: {}", list(&there.iter().map(String::as_str).collect::<Vec<_>>()));
            }
            diagnostic.notes(notes);
        }
    } else if !endings.contains(&ending.as_str()) || !begins_so() {
        validator
            .out
            .error_at(path, format!("`{name}` is no {what} that can be read"))
            .note(format!("allowed: {formats}"));
    }
}

/// Notes a file that the scene may not read.
pub(super) fn tell_outside(validator: &mut Validator, path: &Path, outside: &Outside) {
    let message = format!("`{}` lies outside the scene's folder", outside.name);
    validator.out.error_at(path, message).note(Outside::HOW);
}
