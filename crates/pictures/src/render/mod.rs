//! Pictures of a run, drawn on the CPU: the deformed surface, shaded, coloured by a field, with its mesh, a colour bar,
//! the time and the axes; cut open, seen through, before its shape at rest, as a scene's `picture` says it. No graphics
//! driver is needed, and the same input gives the same bytes everywhere.
//!
//! ```text
//! series   fields.pvd -> frames                frame    one VTU file -> points, cells, arrays
//! surface  cells, alive -> outer faces         field    a field's name -> values, their name and unit
//! section  cells, a plane -> polygons          nodal    values of cells -> averages at nodes
//! groups   bodies, materials -> opacity        state    a frame -> layers of faces
//! range    values -> what the colours span     camera   where the eye stands
//! picture  all of that -> image                triangles, raster, normals, light, occlusion, colour, legend
//! ghost    skins, faces -> layers at rest
//! tools    a scene -> layers of its tools       clip     polygons -> what of them is near
//! encode   images -> PNG                       animation, palette -> GIF
//! kept     a scene -> files of it in its output folder
//! ```

mod animation;
mod camera;
mod clip;
mod colour;
mod draw;
mod encode;
mod error;
mod field;
mod frame;
mod ghost;
mod groups;
mod image;
mod kept;
mod legend;
mod light;
mod nodal;
mod normals;
mod occlusion;
mod palette;
mod picture;
mod plane;
mod range;
mod raster;
mod section;
mod series;
mod skins;
mod state;
mod surface;
mod tools;
mod triangles;

pub use animation::write_gif;
pub use camera::{Camera, Fit, View};
pub use clip::Extent;
pub use colour::{Map, Scale};
pub use draw::{Drawn, RenderOptions, draw, draw_with_progress};
pub use encode::write_png;
pub use error::RenderError;
pub use field::{Known, known};
pub use frame::{FieldAssociation, FrameFile};
pub use image::Image;
pub use kept::{image_file, keep};
pub use legend::Key;
pub use nodal::Averages;
pub use normals::{creases, of_layer};
pub use picture::{Colouring, Layer, Lines, Picture, paint, stage};
pub use plane::Plane;
pub use range::SeenValues;
pub use raster::Finish;
pub use section::Section;
pub use series::Series;
pub use skins::Skins;
pub use surface::{Faces, Outer, Skin};
pub use tools::{Placed, Tools};
