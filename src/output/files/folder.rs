//! The output folder: made, recognised and cleared of the previous run.

use super::{FIELDS, Lock};
use crate::output::{OutputError, WHOLE, summary};
use serde_json::{Value, json};
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The mark of an output folder, written before anything else; it also names the tables of the run.
const MARK: &str = "sinew.json";
/// Files that every run may leave.
const KNOWN: [&str; 6] = [FIELDS, WHOLE, "last_states.pvd", "energy.csv", "nodes.csv", "summary.json"];

/// A folder that a run may write into, and no other: it is locked until the last one that writes into it is gone.
pub struct Folder {
    path: PathBuf,
    /// Names of files beyond those that every run may leave.
    claimed: BTreeSet<String>,
    lock: Arc<Lock>,
}

impl Folder {
    /// Makes the folder, or takes one that is empty (hidden files aside) or holds an earlier output, which is removed:
    /// the files that sinew writes and no other.
    ///
    /// # Errors
    /// A folder with anything else in it, one that another process writes into, or the system refuses.
    pub fn create(path: &Path) -> Result<Folder, OutputError> {
        Self::create_for(path, "")
    }

    /// As [`Folder::create`]; others that want the folder meanwhile are told what it is for: a scene.
    ///
    /// # Errors
    /// As [`Folder::create`].
    pub fn create_for(path: &Path, what: &str) -> Result<Folder, OutputError> {
        if path.exists() && !path.is_dir() {
            return Err(OutputError::NotAFolder { path: path.to_path_buf() });
        }
        fs::create_dir_all(path).map_err(OutputError::system("create", path))?;
        let names = names_in(path)?;
        let foreign = names.iter().find(|name| !name.starts_with('.'));
        if let Some(found) = foreign.filter(|_| !names.contains(MARK)) {
            return Err(OutputError::ForeignFolder { path: path.to_path_buf(), found: found.clone() });
        }
        let lock = Arc::new(Lock::of_a_run(path, what)?);
        // a picture that is being drawn of what is cleared now would be one of the new run
        let _pictures = Lock::of_pictures(path, what)?;
        clear(path, &names_in(path)?)?;
        let folder = Folder { path: path.to_path_buf(), claimed: BTreeSet::new(), lock };
        folder.mark()?;
        Ok(folder)
    }

    /// The folder's lock, for all who write into it.
    pub fn lock(&self) -> Arc<Lock> {
        Arc::clone(&self.lock)
    }

    /// The folder's path.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The path of a file in the folder. A name that sinew does not know of itself (a probe's table) is noted in the
    /// mark, so that the next run can clear it. Claim names when a run begins: each one rewrites the mark.
    pub fn claim(&mut self, name: &str) -> Result<PathBuf, OutputError> {
        if !is_plain(name) || name == MARK {
            return Err(OutputError::FileName { name: name.to_string() });
        }
        if !is_known(name) && self.claimed.insert(name.to_string()) {
            self.mark()?;
        }
        Ok(self.path.join(name))
    }

    fn mark(&self) -> Result<(), OutputError> {
        let mark = json!({ "output_of": "sinew", "version": env!("CARGO_PKG_VERSION"), "files": self.claimed });
        summary::write(&self.path.join(MARK), &mark)
    }
}

fn names_in(path: &Path) -> Result<BTreeSet<String>, OutputError> {
    let mut names = BTreeSet::new();
    for entry in fs::read_dir(path).map_err(OutputError::system("read", path))? {
        let entry = entry.map_err(OutputError::system("read", path))?;
        names.insert(entry.file_name().to_string_lossy().into_owned());
    }
    Ok(names)
}

/// Removes the files of the previous run. Names are taken from what is in the folder, so that no list can point
/// elsewhere; the mark stays until it is written anew, so that a run that breaks meanwhile leaves a folder that is
/// still known.
fn clear(folder: &Path, names: &BTreeSet<String>) -> Result<(), OutputError> {
    let mark = fs::read_to_string(folder.join(MARK)).unwrap_or_default();
    let mark: Value = serde_json::from_str(&mark).unwrap_or_default();
    let listed: BTreeSet<&str> = mark["files"].as_array().into_iter().flatten().filter_map(Value::as_str).collect();
    for name in names {
        let whole = name.strip_suffix(".partial").unwrap_or(name);
        let path = folder.join(name);
        if (is_known(whole) || listed.contains(whole)) && !path.is_dir() {
            fs::remove_file(&path).map_err(OutputError::system("remove", &path))?;
        }
    }
    Ok(())
}

/// Whether every run may leave a file of that name.
fn is_known(name: &str) -> bool {
    let number = name
        .strip_prefix("fields_")
        .or_else(|| name.strip_prefix("last_states_"))
        .and_then(|rest| rest.strip_suffix(".vtu"));
    let is_number = |digits: &str| digits.len() >= 6 && digits.bytes().all(|byte| byte.is_ascii_digit());
    let frame = number.is_some_and(is_number);
    let of_skin = name.strip_prefix("skin_").and_then(|rest| rest.rsplit_once('.'));
    let of_skin = of_skin.filter(|(_, ending)| ["vtu", "ply", "obj"].contains(ending));
    let skin = of_skin.and_then(|(rest, _)| rest.rsplit_once('_')).is_some_and(|(_, digits)| is_number(digits));
    let number = name.strip_prefix("snapshot_").and_then(|rest| rest.strip_suffix(".sinew"));
    let snapshot = number.is_some_and(|digits| digits.len() >= 9 && digits.bytes().all(|byte| byte.is_ascii_digit()));
    frame || skin || snapshot || KNOWN.contains(&name)
}

/// A name that stays in the folder on every system.
fn is_plain(name: &str) -> bool {
    let allowed = |letter: char| letter.is_alphanumeric() || matches!(letter, '_' | '-' | '.' | ' ');
    !name.is_empty() && !name.starts_with('.') && name.chars().all(allowed)
}
