//! A scene without parts: what they hold, placed, under the names that it has in the scene.

use super::naming::Naming;
use super::placement::Placement;
use crate::scene::schema::{On, Part, PartScene, Scene};
use crate::scene::syntax::Path;
use std::collections::BTreeMap;
use std::collections::btree_map::Entry;

/// What keeps a part from being a part of its scene.
pub struct Problem {
    /// Where it stands in the scene: in a part, behind the last `content` under the names that this knows, as
    /// [`super::find`] takes them.
    pub path: Path,
    /// What is wrong.
    pub message: String,
    /// What to do about it.
    pub note: String,
}

/// Puts what parts hold into the scene, in the order of their names and behind what the scene itself holds.
pub fn flatten(scene: &mut Scene) -> Vec<Problem> {
    let mut problems = Vec::new();
    for (name, part) in std::mem::take(&mut scene.parts) {
        let path = Path::default().name("parts").name(&name);
        let Some(found) = whole(&name, part, &path, &mut problems) else { continue };
        let mut taken = Taken { part: &name, path: &path, problems: &mut problems };
        taken.join(&mut scene.bodies, found.bodies, "bodies");
        taken.join(&mut scene.materials, found.materials, "materials");
        taken.join(&mut scene.tools, found.tools, "tools");
        taken.join(&mut scene.probes, found.probes, "probes");
        scene.constraints.extend(found.constraints);
        scene.loads.extend(found.loads);
        scene.contacts.extend(found.contacts);
        scene.suction.extend(found.suction);
        scene.attachments.extend(found.attachments);
        scene.removal.extend(found.removal);
    }
    problems
}

/// Joins names of a part to those that are there.
struct Taken<'a> {
    part: &'a str,
    path: &'a Path,
    problems: &'a mut Vec<Problem>,
}

impl Taken<'_> {
    fn join<T>(&mut self, all: &mut BTreeMap<String, T>, added: BTreeMap<String, T>, field: &str) {
        for (name, value) in added {
            match all.entry(name) {
                Entry::Vacant(free) => {
                    free.insert(value);
                }
                Entry::Occupied(taken) => {
                    let name = taken.key();
                    self.problems.push(Problem {
                        path: self.path.name("content").name(field).name(inner_name(name, self.part)),
                        message: format!("`{name}` is in the scene already"),
                        note: format!("name the part, or the other one of the {field}, otherwise"),
                    });
                }
            }
        }
    }
}

/// All that a part and its parts hold, placed and named; nothing where that is not known.
fn whole(name: &str, mut part: Part, path: &Path, problems: &mut Vec<Problem>) -> Option<PartScene> {
    let mut tell = |path: &Path, message: String, note: &str| {
        problems.push(Problem { path: path.clone(), message, note: note.to_string() });
    };
    if !is_plain(name) {
        let note = "letters, digits, _ and - do everywhere; a dot stands between a part and what is in it";
        tell(path, format!("the part `{name}` needs another name"), note);
    }
    if !(part.scale > 0.0 && part.scale.is_finite()) {
        tell(
            &path.name("scale"),
            format!("`scale` must be above 0, found {}", part.scale),
            "1 leaves sizes as they are",
        );
        // what it holds is told of, too, and stands in the lists where it is looked for
        part.scale = 1.0;
    }
    let placement = Placement::of(&part);
    let inside = path.name("content");
    let Some(mut content) = part.content else {
        tell(path, format!("the part `{name}` has no `scene`"), "scene: \"eye.ron\", a file beside this one");
        return None;
    };
    let bodies = content.bodies.keys().map(|key| ("bodies", key));
    let materials = content.materials.keys().map(|key| ("materials", key));
    let tools = content.tools.keys().map(|key| ("tools", key));
    let probes = content.probes.keys().map(|key| ("probes", key));
    for (field, key) in bodies.chain(materials).chain(tools).chain(probes).filter(|(_, key)| key.contains('.')) {
        let note = "a dot stands between a part and what is in it";
        tell(&inside.name(field).name(key), format!("the name `{key}` in a part has a dot"), note);
    }
    // before those of parts of the part are beside them, which are told of by themselves
    for (number, load) in content.loads.iter().enumerate() {
        let load = load.parts();
        if let On::Bodies(_) = load.on {
            let note = "it acts on all that the scene holds, and does not turn with a part; with `body: \"part.name\"` \
                        on one body only";
            let message = format!("{} belongs into the whole scene, not into a part", load.name);
            tell(&inside.name("loads").index(number), message, note);
        }
    }
    for (inner, part) in std::mem::take(&mut content.parts) {
        let path = inside.name("parts").name(&inner);
        let Some(found) = whole(&inner, part, &path, problems) else { continue };
        // no name of the part has a dot, all of these have
        content.bodies.extend(found.bodies);
        content.materials.extend(found.materials);
        content.tools.extend(found.tools);
        content.probes.extend(found.probes);
        content.constraints.extend(found.constraints);
        content.loads.extend(found.loads);
        content.contacts.extend(found.contacts);
        content.suction.extend(found.suction);
        content.attachments.extend(found.attachments);
        content.removal.extend(found.removal);
    }
    let mut naming = Naming::of(name, &content, inside, problems);
    naming.rename(&mut content);
    if !placement.is_none() {
        naming.place(&placement, &mut content);
    }
    Some(content)
}

/// The name that something has in its part.
pub(super) fn inner_name<'a>(name: &'a str, part: &str) -> &'a str {
    name.strip_prefix(part).and_then(|rest| rest.strip_prefix('.')).unwrap_or(name)
}

/// Whether a name can stand before a dot.
fn is_plain(name: &str) -> bool {
    !name.is_empty() && name.chars().all(|letter| letter.is_alphanumeric() || matches!(letter, '_' | '-'))
}
