//! A scene without parts: what they hold, placed, under the names that it has in the scene.

use super::placement::Placement;
use crate::scene::copied_material::{Part as Of, split};
use crate::scene::schema::{
    Attachment, Constraint, Contact, Curve, Load, LoadPartsMut, Part, PartScene, PerCopy, Quantity, Scene, When,
};
use crate::scene::suggest::list;
use crate::scene::syntax::Path;
use std::collections::BTreeMap;
use std::collections::btree_map::Entry;

/// What keeps a part from being a part of its scene.
pub struct Problem {
    /// Where it stands in the scene as it is written.
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
fn whole(name: &str, part: Part, path: &Path, problems: &mut Vec<Problem>) -> Option<PartScene> {
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
        return None;
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
    let mut naming = Naming { part: name, only: Only::of(&content), path: inside, problems };
    naming.rename(&mut content);
    if !placement.is_none() {
        naming.place(&placement, &mut content);
    }
    Some(content)
}

/// The name that something has in its part.
fn inner_name<'a>(name: &'a str, part: &str) -> &'a str {
    name.strip_prefix(part).and_then(|rest| rest.strip_prefix('.')).unwrap_or(name)
}

/// Whether a name can stand before a dot.
fn is_plain(name: &str) -> bool {
    !name.is_empty() && name.chars().all(|letter| letter.is_alphanumeric() || matches!(letter, '_' | '-'))
}

/// What stands for a body that is not named.
enum Only {
    Body(String),
    None,
    OneOf(Vec<String>),
}

impl Only {
    fn of(content: &PartScene) -> Self {
        let mut names: Vec<String> = content.bodies.keys().cloned().collect();
        match names.len() {
            0 => Self::None,
            1 => Self::Body(names.remove(0)),
            _ => Self::OneOf(names),
        }
    }
}

/// Gives what a part holds the names that it has in the scene around it.
struct Naming<'a> {
    part: &'a str,
    only: Only,
    /// The way to what the part holds.
    path: Path,
    problems: &'a mut Vec<Problem>,
}

impl Naming<'_> {
    fn tell(&mut self, path: Path, message: String, note: impl Into<String>) {
        self.problems.push(Problem { path, message, note: note.into() });
    }

    fn name(&self, name: &mut String) {
        *name = format!("{}.{name}", self.part);
    }

    /// The place of a parameter under `materials`; what is none is told when the scene is validated.
    fn parameter(&self, key: String) -> String {
        let Ok((mut material, way)) = split(&key) else { return key };
        self.name(&mut material);
        let mut place = Path::default().name(material);
        place.0.extend(way.0);
        place.to_string()
    }

    fn keys<T>(&self, map: &mut BTreeMap<String, T>) {
        *map = std::mem::take(map).into_iter().map(|(key, value)| (format!("{}.{key}", self.part), value)).collect();
    }

    /// An attachment has a name in its part, too.
    fn attached(&self, number: usize, name: &mut Option<String>) {
        self.name(name.get_or_insert_with(|| number.to_string()));
    }

    fn curve(&self, curve: &mut Curve) {
        if let Curve::Input { name, .. } = curve {
            self.name(name);
        }
    }

    /// A body of the part; the only one where none is named.
    fn body(&mut self, path: &Path, body: &mut Option<String>) {
        if body.is_none() {
            match &self.only {
                Only::Body(name) => *body = Some(name.clone()),
                Only::None => {
                    let note = "what acts on bodies outside of the part belongs into the scene around it";
                    return self.tell(path.clone(), format!("the part `{}` has no body", self.part), note);
                }
                Only::OneOf(names) => {
                    let names: Vec<&str> = names.iter().map(String::as_str).collect();
                    let note = format!("`body` is one of: {}", list(&names));
                    *body = names.first().map(ToString::to_string);
                    self.tell(path.clone(), format!("which body? The part `{}` has {}", self.part, names.len()), note);
                }
            }
        }
        body.iter_mut().for_each(|name| self.name(name));
    }

    /// A body at which a tool of the part does something: an instrument without a body leaves open which it is, and the
    /// scene around it has one only or is asked.
    fn touched(&mut self, path: &Path, body: &mut Option<String>) {
        if body.is_some() || !matches!(self.only, Only::None) {
            self.body(path, body);
        }
    }

    fn rename(&mut self, content: &mut PartScene) {
        for body in content.bodies.values_mut() {
            self.name(&mut body.material);
            body.regions.iter_mut().for_each(|region| self.name(&mut region.material));
            let per_copy = std::mem::take(&mut body.per_copy).into_iter();
            body.per_copy = per_copy.map(|(key, values)| (self.parameter(key), values)).collect();
        }
        for (number, constraint) in content.constraints.iter_mut().enumerate() {
            let path = self.path.name("constraints").index(number);
            match constraint {
                Constraint::Fixed { body, .. } => self.body(&path, body),
                Constraint::Prescribed { body, curve, .. } => {
                    self.body(&path, body);
                    self.curve(curve);
                }
            }
        }
        for (number, load) in content.loads.iter_mut().enumerate() {
            let path = self.path.name("loads").index(number);
            let LoadPartsMut { body, on, curve, .. } = load.parts_mut();
            let Some(_) = on else {
                let note = "it acts on all that the scene holds, and does not turn with a part; with `body: \"part.name\"` \
                            on one body only";
                let message = format!("{} belongs into the whole scene, not into a part", load.parts().name);
                self.tell(path, message, note);
                continue;
            };
            self.body(&path, body);
            self.curve(curve);
        }
        for tool in content.tools.values_mut() {
            tool.moves.iter_mut().for_each(|part| self.curve(&mut part.curve));
        }
        for (number, contact) in content.contacts.iter_mut().enumerate() {
            let path = self.path.name("contacts").index(number);
            match contact {
                Contact::Tool { tool, body, .. } => {
                    self.name(tool);
                    self.touched(&path, body);
                }
                Contact::Between { bodies: (a, b), .. } => {
                    self.name(a);
                    self.name(b);
                }
                Contact::Itself { body, .. } => self.body(&path, body),
            }
        }
        for (number, attachment) in content.attachments.iter_mut().enumerate() {
            let path = self.path.name("attachments").index(number);
            match attachment {
                Attachment::Grasp { tool, body, closed, .. } => {
                    self.name(tool);
                    self.body(&path, body);
                    self.curve(closed);
                }
                Attachment::Suture { name, from, to, curve, .. } => {
                    self.attached(number, name);
                    self.body(&path.name("from"), &mut from.body);
                    self.body(&path.name("to"), &mut to.body);
                    self.curve(curve);
                }
                Attachment::Tie { name, from, to, .. } => {
                    self.attached(number, name);
                    self.body(&path.name("from"), &mut from.body);
                    self.body(&path.name("to"), &mut to.body);
                }
                Attachment::Glue { name, bodies: (a, b), .. } => {
                    self.attached(number, name);
                    self.name(a);
                    self.name(b);
                }
            }
        }
        for (number, removal) in content.removal.iter_mut().enumerate() {
            let path = self.path.name("removal").index(number);
            if let When::InTool { tool, curve, .. } = &mut removal.when {
                self.name(tool);
                self.curve(curve);
                self.touched(&path, &mut removal.body);
            } else {
                self.body(&path, &mut removal.body);
            }
        }
        for (number, suction) in content.suction.iter_mut().enumerate() {
            let path = self.path.name("suction").index(number);
            self.name(&mut suction.tool);
            self.curve(&mut suction.curve);
            self.touched(&path, &mut suction.body);
        }
        for (name, probe) in &mut content.probes {
            let path = self.path.name("probes").name(name);
            match &mut probe.what {
                Quantity::ToolForce { tool }
                | Quantity::ToolTorque { tool }
                | Quantity::ToolPlace { tool }
                | Quantity::ToolPose { tool }
                | Quantity::ToolVelocity { tool } => {
                    self.name(tool);
                    probe.body.iter_mut().for_each(|body| self.name(body));
                }
                Quantity::AttachmentForce { attachment } | Quantity::SutureLength { attachment } => {
                    self.name(attachment);
                    probe.body.iter_mut().for_each(|body| self.name(body));
                }
                _ => self.body(&path, &mut probe.body),
            }
        }
        self.keys(&mut content.bodies);
        self.keys(&mut content.materials);
        self.keys(&mut content.tools);
        self.keys(&mut content.probes);
    }

    fn place(&mut self, placement: &Placement, content: &mut PartScene) {
        for (name, body) in &mut content.bodies {
            placement.body(body);
            if body.rest_shape.is_some() {
                let path = self.path.name("bodies").name(inner_name(name, self.part)).name("rest_shape");
                let message = format!("the part `{}` is placed, and a `rest_shape` is not", self.part);
                self.problems.push(Problem { path, message, note: "it says where nodes are in the scene".to_string() });
            }
            let of_direction = |key: &&String| split(key).is_ok_and(|(_, way)| Of::of(&way) == Of::Direction);
            if let Some(key) = body.per_copy.keys().find(of_direction) {
                let path = self.path.name("bodies").name(inner_name(name, self.part)).name("per_copy");
                let message = format!("the part `{}` is placed, and `{key}` is not", self.part);
                self.problems.push(Problem { path, message, note: "directions of copies are the scene's".to_string() });
            }
        }
        if placement.turns() {
            self.no_vectors_of_copies(content);
        }
        content.materials.values_mut().for_each(|material| placement.material(material));
        for (number, constraint) in content.constraints.iter_mut().enumerate() {
            if placement.constraint(constraint).is_none() {
                let path = self.path.name("constraints").index(number).name("axes");
                let message =
                    format!("as the part `{}` is turned, these axes lie along none of the scene's", self.part);
                self.tell(path, message, "hold or move all three, or turn the part by right angles");
            }
        }
        content.loads.iter_mut().for_each(|load| placement.load(load));
        content.tools.values_mut().for_each(|tool| placement.tool(tool));
        content.contacts.iter_mut().for_each(|contact| placement.contact(contact));
        content.suction.iter_mut().for_each(|suction| placement.suction(suction));
        content.attachments.iter_mut().for_each(|attachment| placement.attachment(attachment));
        content.removal.iter_mut().for_each(|removal| placement.removal(removal));
        content.probes.values_mut().for_each(|probe| placement.probe(probe));
    }

    /// Vectors of copies are along the axes of the scene, and what they multiply has been turned with the part.
    fn no_vectors_of_copies(&mut self, content: &PartScene) {
        let of_constraint = |constraint: &Constraint| match constraint {
            Constraint::Prescribed { per_copy, .. } => per_copy.as_ref().is_some_and(|values| values.is_vector()),
            Constraint::Fixed { .. } => false,
        };
        let of_load = |load: &Load| load.parts().on.per_copy().is_some_and(PerCopy::is_vector);
        let constraints = content.constraints.iter().map(of_constraint).enumerate();
        let constraints = constraints.map(|(number, found)| ("constraints", number, found));
        let loads = content.loads.iter().map(of_load).enumerate().map(|(number, found)| ("loads", number, found));
        for (list, number, _) in constraints.chain(loads).filter(|(.., found)| *found) {
            let path = self.path.name(list).index(number).name("per_copy");
            let message = format!("the part `{}` is turned, and vectors of copies are not", self.part);
            self.tell(path, message, "one number a copy turns with the part");
        }
    }
}
