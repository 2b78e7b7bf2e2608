//! Scenes as assets: the text, and the files that it names.

use bevy_asset::io::Reader;
use bevy_asset::{Asset, AssetLoader, LoadContext};
use bevy_reflect::TypePath;
use sinew::scene::Diagnostics;
use sinew::{Error, SceneFile};
use std::collections::BTreeMap;

/// A scene: its text, with the meshes, laws and parts that it names. Loaded by the [`AssetServer`] from files that end
/// in `.ron`, or made by a program and added to [`Assets`].
///
/// [`AssetServer`]: bevy_asset::AssetServer
/// [`Assets`]: bevy_asset::Assets
#[derive(Asset, TypePath, Clone, Debug, Default)]
pub struct SceneText {
    /// The name that messages show.
    pub name: String,
    /// The scene (RON).
    pub text: String,
    /// What the files hold that the scene names, by these names.
    pub files: BTreeMap<String, Vec<u8>>,
}

impl SceneText {
    /// A scene that names no files.
    pub fn new(name: impl Into<String>, text: impl Into<String>) -> Self {
        Self { name: name.into(), text: text.into(), files: BTreeMap::new() }
    }

    /// The scene with values put in as by `--set`.
    ///
    /// # Errors
    /// All mistakes in its words.
    pub fn read(&self, sets: &[String]) -> Result<SceneFile, Error> {
        let read: Result<SceneFile, Diagnostics> =
            SceneFile::from_memory(&self.name, &self.text, self.files.clone(), sets);
        Ok(read?)
    }
}

/// Loads scenes, and the files beside them that they name: where one of these changes, the scene is loaded anew.
#[derive(Default, TypePath)]
pub struct SceneLoader;

/// Why a scene was not loaded.
#[derive(Debug, thiserror::Error)]
pub enum NotLoaded {
    /// The file cannot be read.
    #[error(transparent)]
    File(#[from] std::io::Error),
    /// It is no text.
    #[error("a scene is a text in UTF-8: {0}")]
    NoText(#[from] std::string::FromUtf8Error),
}

impl AssetLoader for SceneLoader {
    type Asset = SceneText;
    type Settings = ();
    type Error = NotLoaded;

    async fn load(
        &self,
        reader: &mut dyn Reader,
        (): &(),
        context: &mut LoadContext<'_>,
    ) -> Result<SceneText, NotLoaded> {
        let mut bytes = Vec::new();
        reader.read_to_end(&mut bytes).await?;
        let text = String::from_utf8(bytes)?;
        let files = files_beside(context, &text).await;
        Ok(SceneText { name: context.path().to_string(), text, files })
    }

    fn extensions(&self) -> &[&str] {
        &["sinew.ron", "ron"]
    }
}

/// Files that a text names, and those that these name. What there is not, the engine says of the scene.
async fn files_beside(context: &mut LoadContext<'_>, text: &str) -> BTreeMap<String, Vec<u8>> {
    let mut files = BTreeMap::new();
    let mut texts = vec![(String::new(), text.to_string())];
    while let Some((folder, text)) = texts.pop() {
        for name in file_names(&text) {
            let name = shortest(&format!("{folder}{name}"));
            let Ok(path) = context.path().resolve_embed_str(&name) else { continue };
            if files.contains_key(&name) {
                continue;
            }
            let Ok(bytes) = context.read_asset_bytes(path).await else { continue };
            if let (true, Ok(text)) = (name.ends_with(".ron") || name.ends_with(".gltf"), str::from_utf8(&bytes)) {
                let folder = name.rsplit_once('/').map_or(String::new(), |(folder, _)| format!("{folder}/"));
                // where glTF names files, spaces are written so
                let text = if name.ends_with(".gltf") { text.replace("%20", " ") } else { text.to_string() };
                texts.push((folder, text));
            }
            files.insert(name, bytes);
        }
    }
    files
}

/// Texts between quotation marks that could be files: they have an ending. Comments are left out.
fn file_names(text: &str) -> Vec<&str> {
    let mut names = Vec::new();
    let mut rest = text;
    while let Some(at) = rest.find(['"', '/']) {
        let (quoted, after) = (rest.as_bytes()[at] == b'"', &rest[at + 1..]);
        rest = after;
        if quoted {
            let Some((inside, after)) = after.split_once('"') else { break };
            rest = after;
            let is_ending = |end: &str| !end.is_empty() && end.chars().all(char::is_alphanumeric);
            let named = inside.rsplit_once('.').is_some_and(|(stem, end)| !stem.is_empty() && is_ending(end));
            if named && !inside.contains('\n') {
                names.push(inside);
            }
        } else if after.starts_with('/') {
            rest = after.split_once('\n').map_or("", |(_, lines)| lines);
        }
    }
    names
}

/// A relative path without ways down and up again.
fn shortest(name: &str) -> String {
    let mut parts: Vec<&str> = Vec::new();
    for part in name.split('/') {
        match part {
            "." => {}
            ".." if parts.last().is_some_and(|last| *last != "..") => drop(parts.pop()),
            _ => parts.push(part),
        }
    }
    parts.join("/")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_files_are_found_in_a_scene() {
        let text = r#"(title: "A lens. Cut", // "no.msh"
            bodies: {"lens": (mesh: File(path: "meshes/lens.msh"))}, parts: {"tip": (scene: "tools/tip.ron")})"#;
        assert_eq!(file_names(text), ["meshes/lens.msh", "tools/tip.ron"]);
        assert_eq!(file_names(r#"(path: "my meshes/the lens.msh", title: "One. Two")"#), ["my meshes/the lens.msh"]);
        assert_eq!(file_names("\"a.msh"), [""; 0]);
        assert_eq!(shortest("tools/../meshes/./lens.msh"), "meshes/lens.msh");
    }
}
