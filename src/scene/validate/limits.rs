//! Whether a scene has more of anything than is allowed. Looked at first: all else may take its time with what is too
//! much.

use super::{Validator, scene};
use crate::scene::limits::{ACTIONS, BODIES, MOST_REFINEMENT, NAME_BYTES, SYSTEMS, TABLE_POINTS, TERMS};
use crate::scene::load::SceneFile;
use crate::scene::schema::{Curve, MeshSource};
use crate::scene::syntax::Path;

/// Whether there is not too much of anything that is looked at one by one.
pub(super) fn validate(file: &SceneFile, validator: &mut Validator) -> bool {
    let found = &file.scene;
    let mut limits = Limits { validator, kept: true };
    limits.at_most(BODIES, found.bodies.len(), "bodies", || scene("bodies"));
    limits.at_most(BODIES, found.materials.len(), "materials", || scene("materials"));
    limits.at_most(ACTIONS, found.constraints.len(), "constraints", || scene("constraints"));
    limits.at_most(ACTIONS, found.loads.len(), "loads", || scene("loads"));
    limits.at_most(SYSTEMS, found.systems.len(), "systems", || scene("systems"));
    limits.at_most(BODIES, found.tools.len(), "tools", || scene("tools"));
    limits.at_most(ACTIONS, found.contacts.len(), "contacts", || scene("contacts"));
    limits.at_most(ACTIONS, found.suction.len(), "entries", || scene("suction"));
    limits.at_most(ACTIONS, found.attachments.len(), "attachments", || scene("attachments"));
    limits.at_most(ACTIONS, found.removal.len(), "removals", || scene("removal"));
    limits.at_most(ACTIONS, found.probes.len(), "probes", || scene("probes"));
    if !limits.kept {
        return false;
    }
    for (name, body) in &found.bodies {
        limits.at_most(BODIES, body.regions.len(), "regions", || scene("bodies").name(name).name("regions"));
    }
    for (name, material) in &found.materials {
        let path = || scene("materials").name(name);
        let (families, prony) = (material.exponential_fibres.as_ref(), material.prony.as_ref());
        limits.at_most(TERMS, families.map_or(0, Vec::len), "families", || path().name("exponential_fibres"));
        for (field, terms) in [("terms", prony.map(|p| &p.terms)), ("volumetric", prony.map(|p| &p.volumetric))] {
            limits.at_most(TERMS, terms.map_or(0, Vec::len), "terms", || path().name("prony").name(field));
        }
    }
    for (name, tool) in &found.tools {
        limits.at_most(TABLE_POINTS, tool.path.len(), "places of a path", || scene("tools").name(name).name("path"));
        limits.at_most(TERMS, tool.moves.len(), "moves", || scene("tools").name(name).name("moves"));
    }
    for (path, curve) in found.curves() {
        match curve {
            Curve::Table(points) => limits.at_most(TABLE_POINTS, points.len(), "points in a table", || path.clone()),
            Curve::Input { name, .. } => {
                limits.at_most(NAME_BYTES, name.len(), "bytes in a name", || path.name("name"))
            }
            _ => {}
        }
    }
    let bodies = found.bodies.keys().map(|name| ("bodies", name));
    let materials = found.materials.keys().map(|name| ("materials", name));
    let systems = found.systems.keys().map(|name| ("systems", name));
    let probes = found.probes.keys().map(|name| ("probes", name));
    let tools = found.tools.keys().map(|name| ("tools", name));
    for (name, port) in found.tools.iter().filter_map(|(name, tool)| Some((name, tool.port.as_ref()?))) {
        let path = || scene("tools").name(name).name("port").name("name");
        limits.at_most(NAME_BYTES, port.name.len(), "bytes in a name", path);
    }
    for (what, name) in bodies.chain(materials).chain(systems).chain(probes).chain(tools) {
        limits.at_most(NAME_BYTES, name.len(), "bytes in a name", || scene(what).name(name));
    }
    limits.kept
}

struct Limits<'a, 'b> {
    validator: &'a mut Validator<'b>,
    kept: bool,
}

impl Limits<'_, '_> {
    fn at_most(&mut self, most: usize, found: usize, what: &str, path: impl Fn() -> Path) {
        if found > most {
            self.validator.out.error_at(path(), format!("{found} {what}; at most {most} are allowed"));
            self.kept = false;
        }
    }
}

/// Elements of all generated meshes, after `refine`. Those of files are counted when they are read.
pub(super) fn elements(file: &SceneFile, validator: &mut Validator) {
    let most = file.allowed.elements;
    let mut all = 0_u128;
    for (name, body) in &file.scene.bodies {
        let Some((field, cells)) = cells(&body.mesh) else { continue };
        let each = body.mesh.element_kinds().next().and_then(|kind| kind.a_cell()).map_or(1, u128::from);
        let made = cells * each * 8_u128.pow(body.refine.min(MOST_REFINEMENT)) * u128::from(body.copies);
        all += made;
        if all > u128::from(most) {
            let refined = if body.refine > 0 { format!(", refined {} times", body.refine) } else { String::new() };
            let copied = if body.copies > 1 { format!(", {} copies", body.copies) } else { String::new() };
            let message = format!("the mesh would have {made} elements: {cells} cells{refined}{copied}");
            let others = if all > made { format!(", {all} with the bodies before") } else { String::new() };
            validator
                .out
                .error_at(scene("bodies").name(name).name("mesh").name(field), message + &others)
                .note(format!("at most {most} elements are allowed in all bodies together"));
            return;
        }
    }
}

/// The cells of a generated mesh, and the field that says most about them.
fn cells(mesh: &MeshSource) -> Option<(&'static str, u128)> {
    let product = |[x, y, z]: [u32; 3]| u128::from(x) * u128::from(y) * u128::from(z);
    Some(match *mesh {
        MeshSource::File { .. } => return None,
        MeshSource::Box { cells: (x, y, z), .. }
        | MeshSource::Hexahedron { cells: (x, y, z), .. }
        | MeshSource::Tube { cells: (x, y, z), .. } => ("cells", product([x, y, z])),
        MeshSource::Cylinder { across, along, .. } => ("across", product([across, across, along])),
        MeshSource::Ellipsoid { across, .. } => ("across", product([across; 3])),
        MeshSource::Lens { across, through, .. } => ("across", product([across, across, through])),
    })
}
