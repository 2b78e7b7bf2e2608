//! What the words of a scene mean, as their own documentation says: messages quote it.

use super::schema::{LOADS, texts};

/// The first sentence on a field of a struct or of a variant, with its unit: `duration` of `Scene` is
/// "Simulated time (s)."
pub fn meaning(owner: &str, field: &str) -> Option<String> {
    // loads are made of a list, which has what they must have
    if let Some((.., fields)) = LOADS.iter().find(|(_, word, _)| *word == owner) {
        return fields.iter().find(|(name, _)| *name == field).map(|(_, means)| (*means).to_owned());
    }
    let mut lines = texts().flat_map(|file| file.lines()).map(str::trim).skip_while(|line| {
        let named = line.strip_prefix("pub struct ").and_then(|rest| rest.strip_prefix(owner));
        !(named.is_some_and(|rest| rest.starts_with([' ', '<'])) || *line == format!("{owner} {{"))
    });
    lines.next()?;
    let mut doc = String::new();
    for line in lines {
        if let Some(text) = line.strip_prefix("///") {
            let blank = if doc.is_empty() { "" } else { " " };
            doc.push_str(&format!("{blank}{}", text.trim()));
        } else if line.trim_start_matches("pub ").starts_with(&format!("{field}: ")) {
            return Some(doc).filter(|doc| !doc.is_empty());
        } else if line.starts_with('}') {
            return None;
        } else if !line.starts_with("#[") {
            doc.clear();
        }
    }
    None
}

#[cfg(test)]
mod tests;
