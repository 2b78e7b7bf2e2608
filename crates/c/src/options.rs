//! What a simulation is made of.

use crate::memory::{Structure, maybe_text, text, values};
use crate::status::{Failure, Outcome};
use sinew::components::Precision;
use sinew::{BackendChoice, Error, Options, SceneFile};
use std::collections::BTreeMap;
use std::ffi::c_char;
use std::path::Path;

/// A hardware GPU if there is one and the numbers are f32, else the CPU.
pub const SINEW_BACKEND_AUTO: i32 = 0;
/// The CPU.
pub const SINEW_BACKEND_CPU: i32 = 1;
/// The GPU, a software device if there is no other.
pub const SINEW_BACKEND_GPU: i32 = 2;

/// Numbers of 32 bits.
pub const SINEW_PRECISION_F32: i32 = 0;
/// Numbers of 64 bits: the reference, for the CPU.
pub const SINEW_PRECISION_F64: i32 = 1;

/// What a simulation is made of. All that is 0 or NULL is left out: `SinewOptions options; SINEW_INIT(&options);`
///
/// The scene is in the file `path`, or the text `scene`. Meshes and laws that it names are in its folder, or that of
/// the text in `folder`, or in memory (`file_names` and so on), where nothing is read from a disk.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct SinewOptions {
    /// `sizeof(SinewOptions)`.
    pub size: usize,
    /// The scene's file, or the name of the text in messages.
    pub path: *const c_char,
    /// The scene's text (RON, UTF-8).
    pub scene: *const c_char,
    /// The folder of the files that a text names; left out: the present one.
    pub folder: *const c_char,
    /// The names of files in memory, as the scene gives them.
    pub file_names: *const *const c_char,
    /// What these files hold.
    pub file_contents: *const *const u8,
    /// The bytes in each of them.
    pub file_sizes: *const usize,
    /// How many they are.
    pub file_count: usize,
    /// Values put in, as by `--set`: `"duration=2"`.
    pub sets: *const *const c_char,
    /// How many they are.
    pub set_count: usize,
    /// `SINEW_BACKEND_AUTO`, `_CPU` or `_GPU`.
    pub backend: i32,
    /// `SINEW_PRECISION_F32` or `_F64`.
    pub precision: i32,
    /// CPU threads; 0: one a core, and one only for bodies too small to share.
    pub threads: u32,
    /// 1: bodies can be grabbed while it runs; they have forces on nodes then.
    pub grabs: i32,
}

// SAFETY: it is repr(C), begins with its size, and has pointers and numbers only
unsafe impl Structure for SinewOptions {
    const NAME: &'static str = "SinewOptions";
}

impl SinewOptions {
    /// The scene.
    pub(crate) unsafe fn scene(&self) -> Outcome<SceneFile> {
        // SAFETY: as the header asks of callers
        let (path, scene, folder, sets) = unsafe {
            let (path, scene) = (maybe_text(self.path, "options->path")?, maybe_text(self.scene, "options->scene")?);
            (
                path,
                scene,
                maybe_text(self.folder, "options->folder")?,
                texts(self.sets, self.set_count, "options->sets")?,
            )
        };
        let read = match (scene, path) {
            (Some(_), _) if self.file_count > 0 && folder.is_some() => {
                return Err(Failure::argument(
                    "`options->folder` and files in memory are both given: a scene's files are in one or the other",
                ));
            }
            // SAFETY: as the header asks of callers
            (Some(scene), name) if self.file_count > 0 => unsafe {
                SceneFile::from_memory(name.unwrap_or("scene"), scene, self.files()?, &sets)
            },
            (Some(scene), name) => {
                SceneFile::from_text(name.unwrap_or("scene"), scene, Path::new(folder.unwrap_or("")), &sets)
            }
            (None, _) if folder.is_some() || self.file_count > 0 => {
                return Err(Failure::argument(
                    "`options->folder` and files in memory belong to a text, and `options->scene` is NULL",
                ));
            }
            (None, Some(path)) => SceneFile::load(path, &sets),
            (None, None) => return Err(Failure::argument("`options->path` and `options->scene` are both NULL")),
        };
        Ok(read.map_err(Error::from)?)
    }

    unsafe fn files(&self) -> Outcome<BTreeMap<String, Vec<u8>>> {
        // SAFETY: as the header asks of callers
        unsafe {
            let names = texts(self.file_names, self.file_count, "options->file_names")?;
            let contents = values(self.file_contents, self.file_count, "options->file_contents")?;
            let sizes = values(self.file_sizes, self.file_count, "options->file_sizes")?;
            let bytes = |(&from, &size): (&*const u8, &usize)| values(from, size, "options->file_contents[]");
            names
                .into_iter()
                .zip(contents.iter().zip(sizes))
                .map(|(name, at)| Ok((name, bytes(at)?.to_vec())))
                .collect()
        }
    }

    /// How to run it.
    pub(crate) fn of_the_run(&self) -> Outcome<Options> {
        let wrong = |what: &str, value: i32, allowed: &str| {
            Err(Failure::argument(format!("`options->{what}` is {value}; {allowed} are allowed")))
        };
        let backend = match self.backend {
            SINEW_BACKEND_AUTO => BackendChoice::Auto,
            SINEW_BACKEND_CPU => BackendChoice::Cpu,
            SINEW_BACKEND_GPU => BackendChoice::Gpu,
            other => {
                return wrong("backend", other, "SINEW_BACKEND_AUTO (0), SINEW_BACKEND_CPU (1), SINEW_BACKEND_GPU (2)");
            }
        };
        let precision = match self.precision {
            SINEW_PRECISION_F32 => Precision::F32,
            SINEW_PRECISION_F64 => Precision::F64,
            other => return wrong("precision", other, "SINEW_PRECISION_F32 (0) and SINEW_PRECISION_F64 (1)"),
        };
        let grabs = match self.grabs {
            0 => false,
            1 => true,
            other => return wrong("grabs", other, "0 and 1"),
        };
        Ok(Options { backend, precision, threads: self.threads as usize, grabs, ..Options::default() })
    }
}

/// A list of texts.
pub(crate) unsafe fn texts(from: *const *const c_char, count: usize, what: &str) -> Outcome<Vec<String>> {
    // SAFETY: as the header asks of callers
    unsafe { values(from, count, what)?.iter().map(|&at| Ok(text(at, &format!("{what}[]"))?.to_string())).collect() }
}
