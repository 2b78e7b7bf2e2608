//! Scenes read files in their own folder, and others only where that is allowed by name.

use crate::good::with;
use sinew::scene::{Allowed, SceneFile};
use sinew::systems::Registry;
use sinew::{Simulation, scene};
use std::fs;
use std::path::PathBuf;

const MESH: &str = "mesh: Box(size: (0.1, 0.1, 0.1), cells: (4, 4, 4), elements: Hex8)";
const REFUSED: &str = "lies outside the scene's folder";

/// A folder with a scene's folder in it, and a mesh in both.
struct Workspace {
    root: tempfile::TempDir,
}

impl Workspace {
    fn new() -> Self {
        let root = tempfile::tempdir().unwrap();
        let tet = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 0.1\n$EndNodes\n\
                   $Elements\n1\n1 4 2 1 1 1 2 3 4\n$EndElements\n";
        fs::create_dir_all(root.path().join("scenes/meshes")).unwrap();
        for file in ["outer.msh", "scenes/inner.msh", "scenes/meshes/inner.msh"] {
            fs::write(root.path().join(file), tet).unwrap();
        }
        fs::write(root.path().join("law.wgsl"), "fn secret() {}").unwrap();
        Self { root }
    }

    fn folder(&self) -> PathBuf {
        self.root.path().join("scenes")
    }

    /// What is said of the good scene with a piece replaced.
    fn told(&self, old: &str, new: &str, allowed: Allowed) -> String {
        let scene = SceneFile::from_text_allowing("a.ron", &with(old, new), &self.folder(), &[], allowed).unwrap();
        Simulation::check(&scene, &Registry::default()).to_string()
    }

    fn mesh(&self, path: &str, allowed: Allowed) -> String {
        self.told(MESH, &format!("mesh: File(path: {path:?})"), allowed)
    }
}

#[test]
fn meshes_lie_in_the_folder_of_the_scene_or_below() {
    let place = Workspace::new();
    let inner = place.folder().join("inner.msh");
    for path in ["inner.msh", "./inner.msh", "meshes/inner.msh", "meshes/../inner.msh", inner.to_str().unwrap()] {
        assert_eq!(place.mesh(path, Allowed::default()), "", "{path}");
    }
    let outer = place.root.path().join("outer.msh");
    let missing = "/no/where/at/all.msh";
    for path in ["../outer.msh", "meshes/../../outer.msh", outer.to_str().unwrap(), "../nothing.msh", missing] {
        let told = place.mesh(path, Allowed::default());
        assert!(told.contains(REFUSED) && told.contains("--allow-outside"), "{path}: {told}");
        assert!(!told.contains("there are"), "what lies there is nobody's business: {told}");
    }
    assert_eq!(place.mesh("../outer.msh", Allowed::files_anywhere()), "");
    assert!(place.mesh(missing, Allowed::files_anywhere()).contains("there is no file"));
}

#[cfg(unix)]
#[test]
fn links_lead_where_they_lead() {
    let place = Workspace::new();
    std::os::unix::fs::symlink(place.root.path().join("outer.msh"), place.folder().join("link.msh")).unwrap();
    std::os::unix::fs::symlink(place.root.path(), place.folder().join("up")).unwrap();
    for path in ["link.msh", "up/outer.msh"] {
        assert!(place.mesh(path, Allowed::default()).contains(REFUSED), "{path}");
        assert_eq!(place.mesh(path, Allowed::files_anywhere()), "", "{path}");
    }
    assert_eq!(place.mesh("up/scenes/inner.msh", Allowed::default()), "", "out and in again is in");
}

#[test]
fn laws_and_references_are_files_too() {
    let place = Workspace::new();
    let law = "law: (file: \"../law.wgsl\")";
    let old = "neo_hookean: Young(young: 3e3, poisson: 0.45)";
    assert!(place.told(old, law, Allowed::default()).contains(REFUSED));
    let told = place.told(old, law, Allowed::files_anywhere());
    assert!(!told.contains(REFUSED) && told.contains("the law has no function"), "{told}");
    let files = "accuracy: (reference: Files([\"tables\", \"..\"])), loads: [";
    let told = place.told("loads: [", files, Allowed::default());
    assert!(told.contains("`..` lies outside") && !told.contains("`tables` lies"), "{told}");
    assert_eq!(place.told("loads: [", files, Allowed::files_anywhere()), "");
}

/// Mistakes in the words of a scene do not make an allowed file a mistake.
#[test]
fn what_is_allowed_counts_beside_other_mistakes_too() {
    let place = Workspace::new();
    let text = with(MESH, "mesh: File(path: \"../outer.msh\")").replace("duration", "duraton");
    let told =
        |allowed| SceneFile::from_text_allowing("a.ron", &text, &place.folder(), &[], allowed).unwrap_err().to_string();
    assert!(told(Allowed::default()).contains(REFUSED));
    assert!(!told(Allowed::files_anywhere()).contains(REFUSED));
}

/// A name that passes is one that an output folder takes.
#[test]
fn names_of_bodies_and_probes_stay_in_the_output_folder() {
    let place = Workspace::new();
    let out = place.root.path().join("out");
    let mut folder = sinew::output::Folder::create(&out).unwrap();
    for name in
        ["../x", "..", "a/b", "a\\b", "/x", "C:x", "a:b", "x\u{7}", "a\0", "con", "tip of it", "größe", "a*b", ".x", ""]
    {
        let quoted = format!("\"{}\": (what", name.escape_default());
        let scene = SceneFile::from_text("a.ron", &with("\"tip\": (what", &quoted), &place.folder(), &[]);
        let scene = scene.unwrap_or_else(|wrong| panic!("{name:?}: {wrong}"));
        let mut found = scene.diagnostics();
        scene::validate(&scene, &mut found);
        if !found.has_errors() {
            let path = folder.claim(&format!("probe_{name}.csv")).unwrap_or_else(|wrong| panic!("{name:?}: {wrong}"));
            assert_eq!(path.parent(), Some(out.as_path()), "{name:?}");
        }
        assert_eq!(found.has_errors(), !["con", "tip of it", "größe"].contains(&name), "{name:?}: {found}");
    }
}
