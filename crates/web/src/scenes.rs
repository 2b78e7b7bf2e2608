//! The scenes that ship with the page, and the files that they name.

use sinew_view::Bundle;

macro_rules! scenes {
    ($($name:literal),* $(,)?) => {
        [$(($name, include_str!(concat!("../../../scenes/", $name, ".ron")))),*]
    };
}

macro_rules! files {
    ($($name:literal),* $(,)?) => {
        [$(($name, &include_bytes!(concat!("../../../scenes/", $name))[..])),*]
    };
}

/// Those that a browser runs at a speed that is worth looking at, by the names of their files.
pub fn bundle() -> Bundle {
    let scenes = scenes![
        "cube_under_gravity",
        "stretched_bar",
        "twisted_column",
        "retracted_lobe",
        "grasped_liver",
        "lens_tets",
        "indentation",
        "probe",
        "needle",
        "trocar",
        "ball_on_tissue",
        "traction",
        "stacked_blocks",
        "folded_strip",
    ];
    let files = files![
        "meshes/lens_814.msh",
        "meshes/liver.msh",
        "meshes/liver_skin.obj",
        "tools/ball.ron",
        "tools/forceps.ron",
        "tools/phaco.ron",
        "tools/probe.ron",
    ];
    Bundle {
        scenes: scenes.map(|(name, text)| (format!("{name}.ron"), text.to_string())).to_vec(),
        files: files.map(|(name, bytes)| (name.to_string(), bytes.to_vec())).into(),
    }
}
