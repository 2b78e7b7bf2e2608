//! glTF 2.0: scenes of triangles as JSON (.gltf), their numbers in it or in a file beside it, or binary (.glb). Of a
//! scene places and texture coordinates are read; materials, skeletons and the like belong to pictures.

use super::Triangles;
use crate::Fault;
use ::gltf::accessor::{DataType, Dimensions};
use ::gltf::buffer::Source;
use ::gltf::mesh::Mode;
use ::gltf::{Accessor, Document, Gltf, Node, Primitive, Semantic};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use glam::{DMat4, DVec3};

const RULE: &str = "surfaces are read from glTF 2.0 files, .gltf or .glb, with triangles whose places and corners stand in \
                    the file, or in a .bin file in the same folder";

/// The most corners that meshes may have with all nodes that show them.
const MOST_CORNERS: usize = 1 << 24;

/// Gives what a file beside the one that names it holds.
pub type Beside<'a> = &'a dyn Fn(&str) -> Result<Vec<u8>, String>;

/// Reads all triangles of a file's scene, the first where it does not say which, or of all meshes where it has none.
/// Coordinates are those of the scene, through its nodes; texture coordinates the first set, with v upwards.
pub(super) fn read(bytes: &[u8], beside: Beside<'_>) -> Result<Triangles, Fault> {
    let wrong = |what: String| Fault::whole(what, RULE);
    let unchecked = Gltf::from_slice_without_validation(bytes).map_err(|error| wrong(error.to_string()))?;
    names_accessors(&unchecked.document).map_err(wrong)?;
    let Gltf { document, mut blob } = Gltf::from_slice(bytes).map_err(|error| wrong(error.to_string()))?;
    let mut buffers = Vec::new();
    for buffer in document.buffers() {
        buffers.push(match buffer.source() {
            Source::Bin => blob.take().ok_or_else(|| wrong("the file has no binary part".into()))?,
            Source::Uri(uri) => content(uri, beside).map_err(wrong)?,
        });
    }
    let mut read = Reading { buffers, triangles: Triangles::default() };
    for (node, to_scene) in nodes(&document).map_err(wrong)? {
        for primitive in node.mesh().iter().flat_map(|mesh| mesh.primitives()) {
            read.primitive(&primitive, to_scene).map_err(wrong)?;
        }
    }
    if !read.triangles.texture.is_empty() {
        read.pad_texture();
    }
    Ok(read.triangles)
}

/// That places name accessors which there are: the validation of the crate looks at these before it has checked that.
fn names_accessors(document: &Document) -> Result<(), String> {
    let root = document.as_json();
    let named = root.meshes.iter().flat_map(|mesh| &mesh.primitives).flat_map(|kind| kind.attributes.values());
    match named.map(|index| index.value()).find(|&index| index >= root.accessors.len()) {
        Some(index) => Err(format!("a mesh names accessor {index}; there are {}, from 0 on", root.accessors.len())),
        None => Ok(()),
    }
}

/// The bytes of a buffer: in the address itself, or in a file.
fn content(uri: &str, beside: Beside<'_>) -> Result<Vec<u8>, String> {
    let Some(data) = uri.strip_prefix("data:") else {
        return beside(&uri.replace("%20", " ")).map_err(|error| format!("{uri}: {error}"));
    };
    let text = data.split_once(";base64,").map(|(_, text)| text);
    text.and_then(|text| STANDARD.decode(text).ok()).ok_or_else(|| "a buffer is no base64 text".into())
}

/// The nodes of the scene, each with what takes its coordinates to those of the scene.
fn nodes(document: &Document) -> Result<Vec<(Node<'_>, DMat4)>, String> {
    let scene = document.default_scene().or_else(|| document.scenes().next());
    let mut open: Vec<(Node<'_>, DMat4)> = match scene {
        Some(scene) => scene.nodes().map(|node| (node, DMat4::IDENTITY)).collect(),
        None => return Err("the file has no scene".into()),
    };
    open.reverse();
    let mut seen = vec![false; document.nodes().len()];
    let mut all = Vec::new();
    while let Some((node, to_parent)) = open.pop() {
        if std::mem::replace(&mut seen[node.index()], true) {
            return Err(format!("node {} is in the scene twice, or below itself", node.index()));
        }
        let own = node.transform().matrix().map(|column| column.map(f64::from));
        let to_scene = to_parent * DMat4::from_cols_array_2d(&own);
        let children: Vec<_> = node.children().map(|child| (child, to_scene)).collect();
        open.extend(children.into_iter().rev());
        all.push((node, to_scene));
    }
    Ok(all)
}

struct Reading {
    buffers: Vec<Vec<u8>>,
    triangles: Triangles,
}

impl Reading {
    /// Triangles of one kind; points and lines are nothing.
    fn primitive(&mut self, primitive: &Primitive<'_>, to_scene: DMat4) -> Result<(), String> {
        if !matches!(primitive.mode(), Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan) {
            return Ok(());
        }
        let places = primitive.get(&Semantic::Positions).ok_or("triangles without places")?;
        let places = self.rows::<3>(&places, Dimensions::Vec3)?;
        let corners: Vec<u32> = match primitive.indices() {
            Some(accessor) => {
                self.rows::<1>(&accessor, Dimensions::Scalar)?.into_iter().map(|[row]| row as u32).collect()
            }
            None => (0..places.len() as u32).collect(),
        };
        if let Some(row) = corners.iter().find(|&&row| row as usize >= places.len()) {
            return Err(format!("a triangle names point {row}; there are {}, counted from 0", places.len()));
        }
        let texture = match primitive.get(&Semantic::TexCoords(0)) {
            Some(accessor) => self.rows::<2>(&accessor, Dimensions::Vec2)?,
            None => Vec::new(),
        };
        if !texture.is_empty() && texture.len() != places.len() {
            return Err(format!("{} texture coordinates for {} points", texture.len(), places.len()));
        }
        if 3 * self.triangles.triangles.len() + 3 * corners.len() + places.len() > MOST_CORNERS {
            return Err(format!("the scene has more than {MOST_CORNERS} corners"));
        }
        let first = self.triangles.points.len() as u32;
        for place in &places {
            let place = to_scene.transform_point3(DVec3::from_array(*place));
            if !place.is_finite() {
                return Err("a coordinate is no finite number".into());
            }
            self.triangles.points.push(place);
        }
        for corners in of_mode(primitive.mode(), &corners, to_scene.determinant() < 0.0) {
            if !texture.is_empty() {
                self.pad_texture();
                // v goes down in glTF, up in OBJ and VTK
                self.triangles.texture.push(corners.map(|row| {
                    let [u, v] = texture[row as usize];
                    [u as f32, (1.0 - v) as f32]
                }));
            }
            self.triangles.triangles.push(corners.map(|row| first + row));
        }
        Ok(())
    }

    /// Gives triangles of kinds without texture coordinates some: those of a surface are for each or for none.
    fn pad_texture(&mut self) {
        self.triangles.texture.resize(self.triangles.triangles.len(), [[0.0; 2]; 3]);
    }

    /// The numbers of an accessor, row by row.
    fn rows<const N: usize>(&self, accessor: &Accessor<'_>, wanted: Dimensions) -> Result<Vec<[f64; N]>, String> {
        let what = |what: &str| format!("accessor {} {what}", accessor.index());
        if accessor.dimensions() != wanted {
            return Err(what("has another number of parts a row than what it is for"));
        }
        let view = accessor.view().filter(|_| accessor.sparse().is_none());
        let view = view.ok_or_else(|| what("is sparse or has no buffer: such are not read"))?;
        let (kind, count) = (accessor.data_type(), accessor.count());
        let size = N * kind.size();
        let stride = view.stride().unwrap_or(size);
        let from = view.offset().checked_add(accessor.offset());
        let end = view.offset().checked_add(view.length());
        let held = self.buffers.get(view.buffer().index());
        let bytes = held.zip(from.zip(end)).and_then(|(held, (from, end))| held.get(from..end));
        let last = count.checked_sub(1).and_then(|last| last.checked_mul(stride)?.checked_add(size));
        let bytes = bytes.filter(|bytes| count == 0 || stride >= size && last.is_some_and(|last| last <= bytes.len()));
        let bytes = bytes.ok_or_else(|| what("goes beyond its buffer"))?;
        let row = |row: usize| {
            let own = &bytes[row * stride..row * stride + size];
            let part = |part: usize| number(&own[part * kind.size()..(part + 1) * kind.size()], kind);
            let scale = if accessor.normalized() { largest(kind) } else { 1.0 };
            std::array::from_fn(|axis| part(axis) / scale)
        };
        Ok((0..count).map(row).collect())
    }
}

/// The corners of triangles, turned where the scene mirrors them.
fn of_mode(mode: Mode, corners: &[u32], mirrored: bool) -> Vec<[u32; 3]> {
    let mut all: Vec<[u32; 3]> = match (mode, corners) {
        (Mode::TriangleStrip, _) => {
            let turned = |(place, three): (usize, &[u32])| [three[0], three[1 + place % 2], three[2 - place % 2]];
            corners.windows(3).enumerate().map(turned).collect()
        }
        (Mode::TriangleFan, [first, rest @ ..]) => rest.windows(2).map(|pair| [*first, pair[0], pair[1]]).collect(),
        _ => corners.as_chunks::<3>().0.to_vec(),
    };
    if mirrored {
        all.iter_mut().for_each(|triangle| triangle.swap(1, 2));
    }
    all
}

fn number(bytes: &[u8], kind: DataType) -> f64 {
    match (kind, bytes) {
        (DataType::I8, [a, ..]) => f64::from(*a as i8),
        (DataType::U8, [a, ..]) => f64::from(*a),
        (DataType::I16, [a, b, ..]) => f64::from(i16::from_le_bytes([*a, *b])),
        (DataType::U16, [a, b, ..]) => f64::from(u16::from_le_bytes([*a, *b])),
        (DataType::U32, [a, b, c, d]) => f64::from(u32::from_le_bytes([*a, *b, *c, *d])),
        (DataType::F32, [a, b, c, d]) => f64::from(f32::from_le_bytes([*a, *b, *c, *d])),
        _ => f64::NAN,
    }
}

/// What a normalised integer is a share of.
fn largest(kind: DataType) -> f64 {
    match kind {
        DataType::I8 => 127.0,
        DataType::U8 => 255.0,
        DataType::I16 => 32767.0,
        DataType::U16 => 65535.0,
        DataType::U32 => f64::from(u32::MAX),
        DataType::F32 => 1.0,
    }
}
