//! Whether a text has its form, that of a law say: the functions, one uniform of numbers, nothing else that kernels
//! have.

use super::form::{Form, Function};
use super::names::{Declared, declared, member};
use super::{About, Complaint, text};
use crate::backend::kernel::{Composed, KernelError, compose};
use naga::AddressSpace;
use std::collections::BTreeMap;

/// The parameters of a text, in the order of its struct.
pub(super) struct Parameters {
    pub(super) values: Vec<f64>,
    /// As they lie in the uniform buffer, in f32.
    pub(super) bytes: Vec<u8>,
}

/// Checks the form of a text and packs its parameters.
pub(super) fn check(
    form: &Form,
    path: &str,
    text: &str,
    given: &BTreeMap<String, f64>,
) -> Result<Parameters, Vec<Complaint>> {
    let declared = declared(text);
    let mut complaints = Vec::new();
    for Declared { name, at, .. } in &declared {
        if let Some(owner) = form.owners.get(name) {
            let message = format!("`{name}` is a name of sinew's own ({owner})");
            complaints.push(Complaint::new(About::Bytes(at.clone()), message).note("choose another name"));
        }
    }
    if !complaints.is_empty() {
        return Err(complaints);
    }
    let composed = compose(&text::fragments(form, path, text)).map_err(|error| vec![of_kernel(path, error)])?;
    foreign(form, &composed, &declared, &mut complaints);
    functions(form, &composed, &declared, text, &mut complaints);
    let parameters = parameters(form, &composed, &declared, (path, text), given, &mut complaints);
    if complaints.is_empty() { Ok(parameters) } else { Err(complaints) }
}

/// What the compiler says, at the place in the user's own text.
fn of_kernel(path: &str, error: KernelError) -> Complaint {
    let KernelError::Wgsl { message, places, notes, .. } = error else {
        return Complaint::new(About::File, error.to_string());
    };
    let own = places.into_iter().find(|(file, ..)| file == path);
    let (about, label) = own.map_or((About::File, String::new()), |(_, bytes, label)| (About::Bytes(bytes), label));
    // that a function is invalid is no news to one who is shown the line
    let notes = notes.into_iter().filter(|note| !note.ends_with("is invalid")).collect();
    Complaint { label, notes, ..Complaint::new(about, message) }
}

fn place(declared: &[Declared], name: &str) -> About {
    declared.iter().find(|d| d.name == name).map_or(About::File, |d| About::Bytes(d.at.clone()))
}

/// What other kernels have and a text of the user's own cannot.
fn foreign(form: &Form, composed: &Composed, declared: &[Declared], complaints: &mut Vec<Complaint>) {
    let (module, Form { word, parameters, .. }) = (composed.module(), form);
    let mut complain = |name: &str, message: String, note: &str| {
        complaints.push(Complaint::new(place(declared, name), message).note(note));
    };
    for point in &module.entry_points {
        let message = format!("`{}` is an entry point: a {word} has none", point.name);
        complain(&point.name, message, &format!("{}; leave out @compute and @workgroup_size", form.called_by));
    }
    for (_, value) in module.overrides.iter() {
        let name = value.name.as_deref().unwrap_or_default();
        let note = format!("parameters are members of the struct of `var<uniform> {parameters}`");
        complain(name, format!("`{name}` is an `override`: nothing would set it"), &note);
    }
    for (_, variable) in module.global_variables.iter() {
        let name = variable.name.as_deref().unwrap_or_default();
        match variable.space {
            AddressSpace::Uniform if name == *parameters => {}
            AddressSpace::Uniform => complain(
                name,
                format!("the parameters of a {word} must be called `{parameters}`, found `{name}`"),
                &format!("@group(0) @binding(0) var<uniform> {parameters}: YourStruct;"),
            ),
            AddressSpace::Storage { .. } => {
                complain(name, format!("`{name}` is a storage buffer: a {word} has none"), form.depends_on);
            }
            AddressSpace::Private | AddressSpace::WorkGroup => {
                let message = format!("`{name}` is a variable outside of all functions: a {word} has none");
                complain(name, message, form.depends_on);
            }
            _ => {
                let message = format!("`{name}` is no uniform buffer: a {word} has only one of these");
                complain(name, message, form.depends_on);
            }
        }
    }
}

fn functions(form: &Form, composed: &Composed, declared: &[Declared], text: &str, complaints: &mut Vec<Complaint>) {
    let word = form.word;
    let has = |name: &str| composed.signature(name).is_some();
    if let Some(instead) = form.instead.as_ref().filter(|_| !form.functions.iter().any(|f| has(&f.name))) {
        let names: Vec<&str> = declared.iter().filter(|d| d.kind == "fn").map(|d| d.name.as_str()).collect();
        let nearest = crate::scene::nearest(&instead.name, names.iter().copied());
        let about = nearest.map_or(About::File, |near| place(declared, near));
        let message = format!("the {word} has no function `{}`, and none of those of its stresses", instead.name);
        let mut complaint = Complaint::new(about, message);
        complaint.notes.extend(nearest.map(|near| format!("is `{near}` meant to be `{}`?", instead.name)));
        let all: Vec<&str> = form.functions.iter().map(|f| f.declared.as_str()).collect();
        complaint.notes.push(format!("its energy alone will do: {}", instead.declared));
        complaints.push(complaint.note(format!("else it must have all of: {}", all.join(", "))));
        return;
    }
    for Function { name, argument, result, declared: as_it_is } in &form.functions {
        let note = format!("it must be: {as_it_is}");
        match composed.signature(name) {
            Some((arguments, found)) => {
                if arguments != [*argument] || found.as_deref() != Some(*result) {
                    let found = format!("({}) -> {}", arguments.join(", "), found.as_deref().unwrap_or("nothing"));
                    let message = format!("`{name}` takes and gives something else: {found}");
                    complaints.push(Complaint::new(place(declared, name), message).note(note));
                }
            }
            None => {
                let names =
                    declared.iter().filter(|d| d.kind == "fn" && !form.functions.iter().any(|f| f.name == d.name));
                let names: Vec<&str> = names.map(|d| d.name.as_str()).collect();
                let nearest = crate::scene::nearest(name, names.iter().copied());
                let about = nearest.map_or(About::File, |near| place(declared, near));
                let mut complaint = Complaint::new(about, format!("the {word} has no function `{name}`"));
                complaint.notes.extend(nearest.map(|near| format!("is `{near}` meant to be it?")));
                complaints.push(complaint.note(note));
            }
        }
    }
    // a word that only a GPU could make sense of: said in the text's own words, not in those of a twin
    for range in crate::materials::program::words(text).filter(|range| &text[range.clone()] == "bitcast") {
        let message = format!("the bits of a number cannot be read: a {word} is computed in several precisions");
        complaints.push(Complaint::new(About::Bytes(range), message));
    }
}

fn parameters(
    form: &Form,
    composed: &Composed,
    declared: &[Declared],
    (path, text): (&str, &str),
    given: &BTreeMap<String, f64>,
    complaints: &mut Vec<Complaint>,
) -> Parameters {
    let mut packed = Parameters { values: Vec::new(), bytes: Vec::new() };
    let Form { word, parameters, .. } = form;
    let binding = composed.binding(parameters);
    let members = binding.map(|binding| composed.struct_layout(&binding.type_name));
    let members = match members {
        None => Vec::new(),
        Some(Ok(members)) => members,
        Some(Err(_)) => {
            let message = format!("`{parameters}` must be a struct of numbers");
            let note =
                format!("struct Numbers {{ first: f32 }} @group(0) @binding(0) var<uniform> {parameters}: Numbers;");
            complaints.push(Complaint::new(place(declared, parameters), message).note(note));
            return packed;
        }
    };
    packed.bytes = vec![0; binding.map_or(0, |binding| binding.size as usize)];
    let names: Vec<&str> = members.iter().map(|m| m.name.as_str()).collect();
    let needs = match names.is_empty() {
        true => format!("{path} has no parameters"),
        false => format!("the parameters of {path}: {}", names.join(", ")),
    };
    for wanted in &members {
        let of = declared.iter().find(|d| d.kind == "struct" && Some(&d.name) == binding.map(|b| &b.type_name));
        if wanted.type_name != "f32" {
            let about = of.map_or(About::File, |of| About::Bytes(member(text, of, &wanted.name)));
            let message = format!("the parameter `{}` must be of type f32, found {}", wanted.name, wanted.type_name);
            complaints.push(Complaint::new(about, message).note("a vector or a table: one member for each number"));
            continue;
        }
        let Some(&value) = given.get(&wanted.name) else {
            let message = format!("the {word} needs the parameter `{}`", wanted.name);
            complaints.push(Complaint::new(About::Parameters, message).note(needs.clone()));
            continue;
        };
        packed.values.push(value);
        let at = wanted.offset as usize;
        packed.bytes[at..at + 4].copy_from_slice(&(value as f32).to_le_bytes());
    }
    for name in given.keys().filter(|name| !names.contains(&name.as_str())) {
        let mut complaint =
            Complaint::new(About::Parameter(name.clone()), format!("the {word} has no parameter `{name}`"));
        complaint
            .notes
            .extend(crate::scene::nearest(name, names.iter().copied()).map(|n| format!("did you mean `{n}`?")));
        complaints.push(complaint.note(needs.clone()));
    }
    packed
}
