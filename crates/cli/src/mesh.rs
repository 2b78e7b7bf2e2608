//! `sinew mesh`: what a mesh is and where it lies, of a mesh file or of the bodies of a scene, with a picture of its
//! quality.

use super::arguments::{MeshArguments, allowed, default_folder};
use super::failure::Failure;
use super::run::PICTURES;
use super::wording::{count, counted, digits, quantity};
use super::{Outcome, terminal};
use sinew::SceneFile;
use sinew::assembly::mesh_of;
use sinew::glam::DVec3;
use sinew::mesh::quality::BINS;
use sinew::mesh::topology::singular;
use sinew::mesh::{Cells, Mesh, MeshReport};
use sinew::output::{Array, Folder, Frame, Series, Values};
use sinew::scene::schema::{Colours, Picture};
use sinew_pictures::render::{RenderOptions, draw};
use std::collections::BTreeMap;
use std::path::Path;

/// The longest bar of a histogram.
const BAR: usize = 40;

/// Tells of all meshes, and draws them.
pub fn command(arguments: &MeshArguments) -> Outcome {
    let meshes = meshes(arguments)?;
    let mut reports = Vec::new();
    for (name, mesh) in &meshes {
        reports.push((name, mesh.summary()));
    }
    if arguments.json {
        let all: BTreeMap<_, _> = reports.iter().map(|(name, report)| (name, report)).collect();
        let text = serde_json::to_string_pretty(&all).map_err(|error| Failure::Silent(error.into()))?;
        return terminal::say(&format!("{text}\n"));
    }
    for ((name, report), (_, mesh)) in reports.iter().zip(&meshes) {
        terminal::say(&page(name, report, mesh))?;
    }
    if arguments.no_picture {
        return Ok(());
    }
    let mut name = default_folder(&arguments.what).into_os_string();
    name.push("-mesh");
    let path = arguments.out.clone().unwrap_or_else(|| name.into());
    let drawn = picture(&meshes, &path)?;
    terminal::say(&format!(
        "see it      {} (colour: quality); in ParaView {}/fields.pvd\n",
        drawn.display(),
        path.display()
    ))
}

/// The mesh of a file, or those of a scene's bodies, placed as the scene wants them; each with its name.
fn meshes(arguments: &MeshArguments) -> Result<Vec<(String, Mesh)>, Failure> {
    let refused = |error: sinew::mesh::MeshError| Failure::Options(error.to_string());
    let what = &arguments.what;
    if what.extension().is_none_or(|ending| ending != "ron") {
        return Ok(vec![(what.display().to_string(), Mesh::read(what, arguments.flip_inverted).map_err(refused)?)]);
    }
    let scene = SceneFile::load_allowing(what, &arguments.set, allowed(arguments.allow_outside))?;
    let bodies = scene.scene.bodies.iter();
    bodies.map(|(name, body)| Ok((format!("body {name}"), mesh_of(body, &scene).map_err(refused)?))).collect()
}

/// All that is known of a mesh, as text.
fn page(name: &str, report: &MeshReport, mesh: &Mesh) -> String {
    let mut text = format!("{name}\n");
    let mut line = |word: &str, rest: String| text += &format!("  {word:<10}{rest}\n");
    let kinds: Vec<String> = report
        .elements
        .iter()
        .filter(|(_, number)| *number > 0)
        .map(|(plural, number)| match number {
            1 => format!("1 {}", singular(plural)),
            n => format!("{} {plural}", count(*n as u64)),
        })
        .collect();
    line("consists", format!("{}, {}", counted(report.nodes as u64, "node"), kinds.join(", ")));
    let size = report.max - report.min;
    line(
        "lies",
        format!(
            "from {} to {} m: {} × {} × {}",
            place(report.min),
            place(report.max),
            quantity(size.x, "m"),
            quantity(size.y, "m"),
            quantity(size.z, "m")
        ),
    );
    line("volume", format!("{:.4e} m³ ({} ml)", report.volume, digits(1e6 * report.volume)));
    line(
        "surface",
        format!("{}, {}", counted(report.surface_faces as u64, "face"), counted(report.surface_nodes as u64, "node")),
    );
    line("unit", units(report));
    // the nodes of a set of faces or elements have its name, too
    for sets in report.sets.chunk_by(|a, b| a.name == b.name) {
        let parts: Vec<String> = sets.iter().map(|set| format!("{} {}", count(set.count as u64), set.of)).collect();
        let set = &sets[0];
        line("set", format!("{:?}: {}, between {} and {}", set.name, parts.join(", "), place(set.min), place(set.max)));
    }
    if report.sets.is_empty() {
        line("sets", "none: constraints and loads can be placed by Plane, Box, Sphere, Surface or Nodes".into());
    }
    for field in &report.fields {
        line("field", format!("{field:?}: a vector in each element, as a direction of fibres: Field({field:?})"));
    }
    let quality = &report.quality;
    line(
        "quality",
        format!(
            "1 is regular, 0 flat; mean {:.2}, worst {:.3}",
            quality.mean,
            quality.worst.first().map_or(1.0, |w| w.1)
        ),
    );
    let most = quality.histogram.iter().copied().max().unwrap_or(0).max(1);
    for (bin, number) in quality.histogram.iter().enumerate().filter(|(_, number)| **number > 0) {
        let (from, to) = (bin as f64 / BINS as f64, (bin + 1) as f64 / BINS as f64);
        let bar = "█".repeat((BAR * number).div_ceil(most));
        line("", format!("{from:.1} to {to:.1}  {:>9}  {bar}", count(*number as u64)));
    }
    // of a regular mesh none is worse than the others
    let alike = report.worst.iter().all(|worst| quality.mean - worst.1 < 0.05);
    if !alike {
        for (id, quality, at) in &report.worst {
            line("worst", format!("element {id}: {quality:.3}, at {}", place(*at)));
        }
    }
    mesh.notes.iter().for_each(|note| line("note", note.clone()));
    mesh.soundness().warnings.iter().for_each(|finding| line("warning", finding.to_string()));
    text
}

fn place(at: DVec3) -> String {
    format!("({}, {}, {})", digits(at.x), digits(at.y), digits(at.z))
}

/// What unit the lengths could be in.
fn units(report: &MeshReport) -> String {
    let size = (report.max - report.min).max_element();
    let of = |(name, factor): &(String, f64)| match *factor {
        1.0 => format!("m ({})", quantity(size, "m")),
        factor => format!("{name} ({}): put scale: {factor} into the body", quantity(size * factor, "m")),
    };
    match &report.units[..] {
        [] => format!("no usual unit makes {size:.3e} the length of tissue: look at `scale`"),
        [(_, factor)] if *factor == 1.0 => format!("metres, as sinew takes it: {} long", quantity(size, "m")),
        all => format!("could be {}", all.iter().map(of).collect::<Vec<_>>().join(", or ")),
    }
}

/// Draws all meshes at rest, coloured by quality, into a folder; the picture's file.
fn picture(meshes: &[(String, Mesh)], path: &Path) -> Result<std::path::PathBuf, Failure> {
    let mut folder = Folder::create(path)?;
    let out = folder.claim(PICTURES[0])?;
    let (mut points, mut cells) = (Vec::new(), Cells::default());
    let mut of_kinds: BTreeMap<_, Vec<f32>> = BTreeMap::new();
    for (_, mesh) in meshes {
        let first = points.len() as u32;
        points.extend_from_slice(&mesh.points);
        cells.extend_moved(&mesh.cells, first);
        for row in 0..mesh.element_count() {
            of_kinds.entry(mesh.cells.kind(row)).or_default().push(mesh.element_quality(row) as f32);
        }
    }
    let quality: Vec<f32> = of_kinds.into_values().flatten().collect();
    let (displacement, alive) = (vec![0.0_f32; 3 * points.len()], vec![1_u8; quality.len()]);
    let frame = Frame {
        time: 0.0,
        points: &points,
        cells: &cells,
        point_arrays: vec![Array { name: "displacement", components: 3, values: Values::F32(&displacement) }],
        cell_arrays: vec![
            Array { name: "quality", components: 1, values: Values::F32(&quality) },
            Array { name: "alive", components: 1, values: Values::U8(&alive) },
        ],
    };
    Series::create(&folder)?.write(&frame)?;
    let how = Picture { range: Some((0.0, 1.0)), colours: Colours::Elements, ..Picture::default() };
    let (field, captions) = (Some("quality".into()), vec!["at rest".into()]);
    let options = RenderOptions { field, captions, ..RenderOptions::new(how, out) };
    Ok(draw(path, &options)?.out)
}
