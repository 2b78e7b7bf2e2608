//! From a state of the driver to the surfaces that are drawn of it.

mod body;
mod pick;

use crate::scene3d::{Surface, Tissue};
use crate::settings::{Settings, about};
use body::{BodyMesh, Part};
use glam::{DVec3, Vec3};
use sinew::SceneFile;
use sinew::driver::{Loaded, State};
use sinew::scene::schema::Cut;
use sinew_pictures::render::{
    Camera, Extent, Finish, Image, Layer, Lines, Placed, Plane, Scale, SeenValues, Tools, image_file,
};
use std::hash::{Hash, Hasher};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Pictures on skins have so many bytes and pixels at most: what is larger is no picture of a skin.
const MOST_BYTES: u64 = 64 << 20;
const MOST_PIXELS: usize = 1 << 26;

/// What is kept from frame to frame of a scene.
#[derive(Default)]
pub struct Scenery {
    loaded: Option<Arc<Loaded>>,
    /// Whether bodies that are on a GPU are drawn from there: it must be the device of the picture.
    pub lends: bool,
    /// The folder of a finished run, which keeps what its tools and skins look like.
    pub folder: Option<PathBuf>,
    bodies: Vec<BodyMesh>,
    tools: Tools,
    /// How bodies look.
    pub tissues: Vec<Tissue>,
    /// Tools, and pictures on skins, that cannot be drawn, and why.
    pub missing: Vec<String>,
}

/// What is drawn of a state.
pub struct Drawn<'a> {
    loaded: Option<Arc<Loaded>>,
    /// Another one whenever what is drawn from where it is on the device has other faces.
    pub key: u64,
    parts: Vec<Part>,
    tools: Vec<Placed<'a>>,
    /// What bodies fill.
    pub bodies: Extent,
    /// What bodies and tools near them fill.
    pub all: Extent,
    /// The colours of values.
    pub scale: Scale,
    /// What cuts bodies open.
    pub plane: Option<Plane>,
}

impl Scenery {
    /// Nothing yet; `lends`: whether bodies that are on a GPU are drawn from there.
    pub fn new(lends: bool, folder: Option<PathBuf>) -> Self {
        Self { lends, folder, ..Self::default() }
    }

    /// Goes over to the scene of a state: whether it is another one.
    pub fn follow(&mut self, state: &State) -> bool {
        let number = |loaded: &Option<Arc<Loaded>>| loaded.as_ref().map(|loaded| loaded.number);
        if number(&state.loaded) == number(&self.loaded) {
            return false;
        }
        self.loaded = state.loaded.clone();
        let Some(loaded) = &self.loaded else { return false };
        self.bodies = loaded.bodies.iter().map(BodyMesh::new).collect();
        for (mesh, body) in self.bodies.iter_mut().zip(&loaded.bodies) {
            mesh.lends = self.lends && body.on_gpu.is_some();
        }
        (self.tools, self.missing) = match &self.folder {
            Some(folder) => Tools::of_scene(&loaded.scene, folder),
            None => Tools::live(&loaded.scene),
        };
        for (mesh, body) in self.bodies.iter_mut().zip(&loaded.bodies) {
            match picture_of(&loaded.scene, self.folder.as_deref(), &body.name) {
                Ok(picture) => mesh.picture = picture.map(Arc::new),
                Err(why) => {
                    self.missing.push(format!("the picture on the skin of `{}` is not drawn: {why}", body.name))
                }
            }
        }
        let tissue = |name: &String| {
            let of = loaded.scene.scene.bodies.get(name).map(|body| format!("{name} {:?}", body.material));
            Tissue::of_name(of.as_deref().unwrap_or(name))
        };
        self.tissues = loaded.bodies.iter().map(|body| tissue(&body.name)).collect();
        true
    }

    /// What is drawn of a state.
    pub fn draw(&mut self, state: &State, settings: &Settings) -> Drawn<'_> {
        let field = state.field.filter(|field| settings.field == Some(*field));
        let mut seen = SeenValues::default();
        let mut extent = Extent::NOTHING;
        for (mesh, now) in self.bodies.iter_mut().zip(&state.bodies) {
            mesh.move_to(now, settings.deformation);
            mesh.vertices.iter().for_each(|point| extent.add(*point));
        }
        let plane = settings.cut.then(|| plane(settings, &extent));
        let mut parts = Vec::new();
        for (number, (mesh, now)) in self.bodies.iter_mut().zip(&state.bodies).enumerate() {
            let first = parts.len();
            mesh.parts(now, number, (settings, field), plane.as_ref(), &mut parts);
            let values = parts[first..].iter().flat_map(|part: &Part| &part.values);
            values.for_each(|value| seen.value(*value));
        }
        let known = field.map(|field| about(field, settings.component));
        let sizes = field.is_some_and(|field| crate::settings::components(field).first() == Some(&"length"));
        let mut scale = seen.scale(known.and_then(|known| known.centre), sizes && settings.component == 0);
        if let Some(range) = settings.range.filter(|range| range.0 < range.1) {
            scale.range = range;
        }
        let pose = |name: &str| {
            let tool = state.tools.iter().find(|tool| tool.name == name)?;
            Some((tool.place, tool.rotation))
        };
        let tools = if settings.tools { self.tools.at(pose, &extent) } else { Vec::new() };
        let mut all = extent;
        // planes reach far, instruments beyond what is looked at
        let near = state.tools.iter().map(|tool| tool.place.as_vec3()).filter(|place| extent.grown(0.25).has(*place));
        near.for_each(|place| all.add(place));
        let loaded = self.loaded.clone();
        let mut hasher = std::hash::DefaultHasher::new();
        loaded.as_ref().map(|loaded| loaded.number).hash(&mut hasher);
        let lent: Vec<usize> = parts.iter().filter_map(|part| Some(part.lent?.0)).collect();
        (lent, state.bodies.iter().map(|body| body.topology).collect::<Vec<_>>()).hash(&mut hasher);
        Drawn { loaded, key: hasher.finish(), parts, tools, bodies: extent, all, scale, plane }
    }
}

/// The picture on the skin of a body, if it has one: from what the folder of a finished run keeps, or the scene's file.
fn picture_of(scene: &SceneFile, folder: Option<&Path>, body: &str) -> Result<Option<Image>, String> {
    let skin = scene.scene.bodies.get(body).and_then(|body| body.skin.as_ref());
    let Some(name) = skin.and_then(|skin| skin.image.as_ref()) else { return Ok(None) };
    let kept = folder.and_then(|folder| std::fs::read(folder.join(image_file(body))).ok());
    let bytes = match kept {
        None => scene.bytes(name, MOST_BYTES).map_err(|error| format!("{name}: {error}"))?,
        Some(bytes) => bytes.into(),
    };
    let image = Image::from_png(&bytes, MOST_PIXELS).map_err(|error| format!("{name}: {error}"))?;
    Ok(Some(image))
}

/// The plane that cuts, between where it takes all of an extent away and nothing.
fn plane(settings: &Settings, extent: &Extent) -> Plane {
    let normal = settings.cut_normal.normalize_or(Vec3::NEG_Y);
    let corner =
        |high: bool| Vec3::select(normal.cmpgt(Vec3::ZERO) ^ glam::BVec3::splat(!high), extent.high, extent.low);
    let (low, high) = (normal.dot(corner(false)), normal.dot(corner(true)));
    let at = low + (high - low) * settings.cut_at.clamp(0.0, 1.0);
    let point: DVec3 = (normal * at).into();
    Plane::new(&Cut { point, normal: normal.into() }, extent.diagonal())
}

impl Drawn<'_> {
    /// The surfaces, as an eye sees them.
    pub fn surfaces(&self, camera: &Camera) -> Vec<Surface<'_>> {
        let mut surfaces: Vec<Surface<'_>> =
            self.parts.iter().map(|part| part.surface(self.loaded.as_deref())).collect();
        let vertices = || self.parts.iter().filter(|part| part.finish != Finish::Ghost).flat_map(|part| &part.vertices);
        let depth = |normal: Vec3| vertices().map(|point| -normal.dot(*point)).fold(f32::MIN, f32::max);
        for placed in &self.tools {
            let layer = placed.layer(camera, &self.bodies, depth);
            surfaces.push(Surface { layer, rest: &[], tissue: None, picture: None, lent: None });
        }
        surfaces
    }

    /// Whether a plane of the scene is what bodies stand on.
    pub fn has_table(&self, surfaces: &[Surface<'_>]) -> bool {
        !self.tools.is_empty() && surfaces.iter().any(|surface| surface.layer.finish == Finish::Table)
    }

    /// The layers, for a picture drawn without a graphics device.
    pub fn layers(&self, camera: &Camera) -> Vec<Layer<'_>> {
        self.surfaces(camera).into_iter().map(|surface| surface.layer).collect()
    }
}

/// Which sides of faces are drawn as lines.
fn lines(wanted: bool) -> Lines<'static> {
    if wanted { Lines::All } else { Lines::None }
}
