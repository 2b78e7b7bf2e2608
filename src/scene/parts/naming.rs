//! What a part holds, under the names and at the places that it has in the scene around it.

use super::flatten::{Problem, inner_name};
use super::placement::Placement;
use crate::scene::copied_material::{Part as Of, split};
use crate::scene::schema::{
    Attachment, Constraint, Contact, Curve, Load, LoadPartsMut, PartScene, PerCopy, Quantity, When,
};
use crate::scene::suggest::list;
use crate::scene::syntax::Path;
use std::collections::BTreeMap;

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

/// Gives what a part holds, that of its parts among it, the names that it has in the scene around it.
pub(super) struct Naming<'a> {
    part: &'a str,
    only: Only,
    /// The way to what the part holds.
    path: Path,
    problems: &'a mut Vec<Problem>,
}

impl<'a> Naming<'a> {
    /// `path`: the way to the content of the part.
    pub(super) fn of(part: &'a str, content: &PartScene, path: Path, problems: &'a mut Vec<Problem>) -> Self {
        Self { part, only: Only::of(content), path, problems }
    }

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
        self.body_or(path, body, "");
    }

    /// The same, with more to say where there are several.
    fn body_or(&mut self, path: &Path, body: &mut Option<String>, more: &str) {
        if body.is_none() {
            match &self.only {
                Only::Body(name) => *body = Some(name.clone()),
                Only::None => {
                    let note = "what acts on bodies outside of the part belongs into the scene around it";
                    return self.tell(path.clone(), format!("the part `{}` has no body", self.part), note);
                }
                Only::OneOf(names) => {
                    let names: Vec<&str> = names.iter().map(String::as_str).collect();
                    let note = format!("`body` is one of: {}{more}", list(&names));
                    *body = names.first().map(ToString::to_string);
                    self.tell(path.clone(), format!("which body? The part `{}` has {}", self.part, names.len()), note);
                }
            }
        }
        body.iter_mut().for_each(|name| self.name(name));
    }

    /// A body at which a tool of the part does something: an instrument without a body leaves open which it is, and the
    /// scene around it has one only or is asked. The tool has its name in the scene around the part.
    fn touched(&mut self, path: &Path, tool: &str, body: &mut Option<String>) {
        let tool = inner_name(tool, self.part);
        let more = match tool.contains('.') {
            true => format!(
                "; a part of it names none of them: leave the entry out there, and write it in the part `{}`, \
                 of `{tool}`",
                self.part
            ),
            false => String::new(),
        };
        if body.is_some() || !matches!(self.only, Only::None) {
            self.body_or(path, body, &more);
        }
    }

    pub(super) fn rename(&mut self, content: &mut PartScene) {
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
            if on.is_some() {
                self.body(&path, body);
                self.curve(curve);
            }
        }
        for tool in content.tools.values_mut() {
            tool.moves.iter_mut().for_each(|part| self.curve(&mut part.curve));
            // what has no name is told of as that
            let ports = tool.port.iter_mut().filter(|port| !port.name.is_empty());
            ports.for_each(|port| self.name(&mut port.name));
        }
        for (number, contact) in content.contacts.iter_mut().enumerate() {
            let path = self.path.name("contacts").index(number);
            match contact {
                Contact::Tool { tool, body, .. } => {
                    self.name(tool);
                    self.touched(&path, tool, body);
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
                self.touched(&path, tool, &mut removal.body);
            } else {
                self.body(&path, &mut removal.body);
            }
        }
        for (number, suction) in content.suction.iter_mut().enumerate() {
            let path = self.path.name("suction").index(number);
            self.name(&mut suction.tool);
            self.curve(&mut suction.curve);
            self.touched(&path, &suction.tool, &mut suction.body);
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

    pub(super) fn place(&mut self, placement: &Placement, content: &mut PartScene) {
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
