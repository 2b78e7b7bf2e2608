//! The tools of a scene: their surfaces, where they are in a frame, and how they are drawn.

use super::camera::{Camera, Fit};
use super::clip::Extent;
use super::kept::tool_file;
use super::picture::{Colouring, Layer, Lines};
use super::raster::Finish;
use glam::{DMat3, DQuat, DVec3, Vec3};
use sinew::SceneFile;
use sinew::assembly::motion;
use sinew::components::{Key, Pose, ToolMotion};
use sinew::mesh::Triangles;
use sinew::scene::schema::{self, Analysis, Curve, Quantity, Shape, ToolMesh};
use sinew::tools::Solid;
use std::path::Path;

/// The tools of a scene as pictures show them.
#[derive(Clone, Debug, Default)]
pub struct Tools {
    tools: Vec<Tool>,
    /// Of a static analysis the time whose loads and motions act (s).
    rest: Option<f64>,
}

/// A tool and its way.
#[derive(Clone, Debug)]
struct Tool {
    name: String,
    motion: ToolMotion,
    /// In its own frame (m); of a plane the corners of a square whose sides are 2 m long.
    points: Vec<DVec3>,
    /// Triangles; the last point is repeated.
    faces: Vec<[u32; 4]>,
    plane: bool,
}

/// A tool where it is in a frame.
pub struct Placed<'a> {
    /// Positions (m).
    vertices: Vec<Vec3>,
    faces: &'a [[u32; 4]],
    /// Outwards, of a plane.
    plane: Option<Vec3>,
}

/// Points (m) and triangles.
type Surface = (Vec<DVec3>, Vec<[u32; 3]>);

/// Segments around what is round.
const SEGMENTS: usize = 96;
/// How far around the bodies the camera leaves room for tools, in diagonals of what they fill, and for planes.
const ROOM: [f32; 2] = [0.25, 0.4];
/// How far the square that stands for a plane reaches beyond the bodies, in the same.
const BRIM: f64 = 0.2;
/// How far a body may be behind a plane that is drawn as if nothing were there, in the same.
const BEHIND: f32 = 0.02;
/// Cosine of the slope at which a plane is still the ground.
const UPWARDS: f32 = 0.9;
/// Which sides of the two triangles of a square are its sides.
const OUTLINE: [u8; 2] = [0b011, 0b110];

impl Tools {
    /// The tools of a scene that was run into a folder, and for each that cannot be drawn why: its file is gone, or has
    /// another content now. Curves that a program sets while it runs are taken as they begin.
    pub fn of_scene(scene: &SceneFile, folder: &Path) -> (Tools, Vec<String>) {
        Self::of(scene, folder, false)
    }

    /// The tools of a scene that runs, for [`Tools::at`], and for each that cannot be drawn why.
    pub fn live(scene: &SceneFile) -> (Tools, Vec<String>) {
        // nothing was copied
        Self::of(scene, Path::new(""), true)
    }

    fn of(scene: &SceneFile, folder: &Path, live: bool) -> (Tools, Vec<String>) {
        let rest = match scene.scene.analysis {
            Analysis::Static(search) => Some(search.at.unwrap_or(scene.scene.duration)),
            Analysis::Transient => None,
        };
        let (mut tools, mut missing) = (Tools { tools: Vec::new(), rest }, Vec::new());
        for (name, tool) in &scene.scene.tools {
            let surface = surface(scene, folder, name, tool);
            let way = match tool.free.as_ref().filter(|_| !live) {
                Some(_) => seen_way(scene, name, folder).map(|path| ToolMotion { path, ..motion(tool) }),
                None => Ok(motion(tool)),
            };
            match surface.and_then(|surface| Ok((surface, way?))) {
                Ok(((points, triangles), motion)) => tools.tools.push(Tool {
                    name: name.clone(),
                    motion,
                    points,
                    faces: triangles.into_iter().map(|[a, b, c]| [a, b, c, c]).collect(),
                    plane: tool.shape == Some(Shape::Plane {}),
                }),
                Err(reason) => missing.push(format!("the tool `{name}` is not drawn: {reason}")),
            }
        }
        (tools, missing)
    }

    /// Where they are at poses that are known: place of the origin (m) and how each is turned, by name. `spanned`: what
    /// planes are to reach beyond.
    pub fn at(&self, pose: impl Fn(&str) -> Option<(DVec3, DQuat)>, spanned: &Extent) -> Vec<Placed<'_>> {
        let known = self.tools.iter().filter_map(|tool| Some((tool, pose(&tool.name)?)));
        let pose = |(at, turn): (DVec3, DQuat)| Pose { at, rotation: DMat3::from_quat(turn) };
        known.map(|(tool, place)| tool.placed(&pose(place), spanned)).collect()
    }

    /// Where they are in a frame of a series, its number and its time (s): name, place of the origin (m), how each is
    /// turned.
    pub fn poses(&self, row: usize, time: f64) -> Vec<(String, DVec3, DQuat)> {
        let pose = |tool: &Tool| {
            let pose = self.pose(&tool.motion, row, time);
            (tool.name.clone(), pose.at, DQuat::from_mat3(&pose.rotation))
        };
        self.tools.iter().map(pose).collect()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.tools.is_empty()
    }

    /// Makes room for them in all frames of a series, whose times (s) are given in their order: near the bodies, which
    /// have been seen. What planes are to span.
    pub(super) fn measure(&self, times: &[f64], fit: &mut Fit) -> Extent {
        let bodies = fit.extent();
        let mut measure = |extent: &Extent, planes: bool| {
            for (row, time) in times.iter().enumerate() {
                let placed = self.placed(row, *time, extent).into_iter();
                placed.filter(|tool| tool.plane.is_some() == planes).for_each(|tool| tool.measure(extent, fit));
            }
            fit.extent()
        };
        let all = measure(&bodies, false);
        measure(&all, true);
        all
    }

    /// Where they are in a frame of a series: its number and its time (s).
    pub(super) fn placed(&self, row: usize, time: f64, spanned: &Extent) -> Vec<Placed<'_>> {
        self.tools.iter().map(|tool| tool.placed(&self.pose(&tool.motion, row, time), spanned)).collect()
    }

    /// In a static analysis motions grow as loads do: of a path the time, of curves what they are in the end.
    fn pose(&self, motion: &ToolMotion, row: usize, time: f64) -> Pose {
        let (time, share, at) = match self.rest {
            None => (time, 1.0, time),
            Some(end) => {
                let grown = Curve::Smooth { start: 0.0, end }.value(time);
                let share = if end > 0.0 { grown } else { f64::from(u8::from(row > 0)) };
                (share * end, share, end)
            }
        };
        motion.pose(time, |number| share * motion.curves[number].value(at))
    }
}

/// The surface of a tool, from its shape, or from its triangles in the output folder or the scene's file.
fn surface(scene: &SceneFile, folder: &Path, name: &str, tool: &schema::Tool) -> Result<Surface, String> {
    match (&tool.shape, &tool.mesh) {
        (Some(shape), _) => match Solid::new(shape.clone(), tool.rounding) {
            Ok(solid) => Ok(solid.surface(SEGMENTS, 1.0)),
            Err(problem) => Err(problem.to_string()),
        },
        (None, Some(mesh)) => triangles(scene, &folder.join(tool_file(name)), mesh),
        (None, None) => Err("it has neither a shape nor a mesh".into()),
    }
}

/// Where a free tool was at which time, from the table of a probe of its pose in the output folder.
fn seen_way(scene: &SceneFile, tool: &str, folder: &Path) -> Result<Vec<Key>, String> {
    let of_tool = |what: &Quantity| matches!(what, Quantity::ToolPose { tool: of } if of == tool);
    // the columns of a peak are others
    let follows = |probe: &schema::Probe| of_tool(&probe.what) && !probe.peak;
    let Some((probe, _)) = scene.scene.probes.iter().find(|(_, probe)| follows(probe)) else {
        return Err(format!("it moves freely, and no probe `ToolPose(tool: {tool:?})` tells where it is"));
    };
    let name = format!("probe_{probe}.csv");
    let text = std::fs::read_to_string(folder.join(&name)).map_err(|error| format!("{name}: {error}"))?;
    let key = |line: &str| -> Option<Key> {
        let numbers: Vec<f64> = line.split(',').map(|word| word.trim().parse().ok()).collect::<Option<_>>()?;
        let [time, x, y, z, rx, ry, rz] = numbers[..] else { return None };
        let turn = DVec3::new(rx, ry, rz) * (std::f64::consts::PI / 180.0);
        Some((time, DVec3::new(x, y, z), DQuat::from_scaled_axis(turn)))
    };
    let lines = text.lines().skip(1).filter(|line| !line.is_empty());
    let path: Option<Vec<Key>> = lines.map(key).collect();
    path.filter(|path| !path.is_empty()).ok_or_else(|| format!("{name} does not tell where it is"))
}

/// The triangles of a tool, from what the output folder keeps of them or from the scene's file.
fn triangles(scene: &SceneFile, kept: &Path, mesh: &ToolMesh) -> Result<Surface, String> {
    let mut surface = match std::fs::read(kept) {
        Ok(bytes) => Triangles::from_bytes(kept, &bytes).map_err(|error| error.to_string())?,
        Err(_) => scene.surface(&mesh.path)?,
    };
    surface.points.iter_mut().for_each(|point| *point *= mesh.scale);
    Ok((surface.points, surface.triangles))
}

impl Tool {
    fn placed(&self, pose: &Pose, spanned: &Extent) -> Placed<'_> {
        if !self.plane {
            let vertices = self.points.iter().map(|point| pose.place(*point).as_vec3()).collect();
            return Placed { vertices, faces: &self.faces, plane: None };
        }
        // below the bodies, wherever the tool's origin is
        let normal = pose.rotation.z_axis;
        let middle = spanned.middle().as_dvec3();
        let middle = middle - normal * normal.dot(middle - pose.at);
        let size = (spanned.high - spanned.low).as_dvec3();
        let across = |axis: DVec3| axis.abs().dot(size) / 2.0;
        let wide = across(pose.rotation.x_axis).max(across(pose.rotation.y_axis));
        let half = wide + BRIM * f64::from(spanned.diagonal());
        let corner = |point: &DVec3| (middle + pose.rotation * (*point * half)).as_vec3();
        let vertices = self.points.iter().map(corner).collect();
        Placed { vertices, faces: &self.faces, plane: Some(normal.as_vec3()) }
    }
}

impl Placed<'_> {
    /// Adds what of it is near an extent.
    fn measure(&self, extent: &Extent, fit: &mut Fit) {
        let room = extent.grown(ROOM[usize::from(self.plane.is_some())]);
        // a wall may reach below what bodies stand on
        let may_be_ground = self.plane.is_none_or(|normal| normal.dot(fit.ground().0) > UPWARDS);
        for face in self.faces {
            let part = room.part_of([face[0], face[1], face[2]].map(|point| self.vertices[point as usize])).into_iter();
            match may_be_ground {
                true => part.for_each(|point| fit.see(point)),
                false => part.for_each(|point| fit.see_above_ground(point)),
            }
        }
    }

    /// Whether any of it may be seen below a row of the picture.
    pub fn reaches(&self, camera: &Camera, row: f32) -> bool {
        self.vertices.iter().any(|point| {
            let place = camera.project(*point);
            place.z <= 0.0 || place.y > row
        })
    }

    /// How it is drawn. `depth`: how far bodies are behind a plane through the origin with a normal (m).
    pub fn layer(&self, camera: &Camera, spanned: &Extent, depth: impl Fn(Vec3) -> f32) -> Layer<'_> {
        let finish = self.plane.map_or(Finish::Steel, |normal| {
            let at = self.vertices.first().map_or(0.0, |point| point.dot(normal));
            // it hides nothing for an eye on the side of the bodies
            let before = camera.eye().dot(normal) > at && depth(normal) + at <= BEHIND * spanned.diagonal();
            if before { Finish::Table } else { Finish::Pane }
        });
        Layer {
            vertices: &self.vertices,
            faces: self.faces,
            values: Colouring::Nothing,
            finish,
            lines: if finish == Finish::Pane { Lines::Sides(&OUTLINE) } else { Lines::None },
            normals: &[],
            flat: self.plane,
            cut: false,
        }
    }
}
