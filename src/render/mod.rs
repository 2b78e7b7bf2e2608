//! Pictures of a run, drawn on the CPU: the deformed surface, shaded, coloured by a field, with its mesh, a colour bar,
//! the time and the axes. No graphics driver is needed, and the same input gives the same bytes everywhere.
//!
//! ```text
//! series   fields.pvd -> frames                frame    one VTU file -> points, cells, arrays
//! surface  cells, alive -> outer faces         field    a field's name -> values, their name and unit
//! range    values -> what the colours span     camera   where the eye stands
//! picture  all of that -> image                raster, normals, light, colour, legend, text
//! encode   images -> PNG                       animation, palette -> GIF
//! ```

mod animation;
mod camera;
mod colour;
mod draw;
mod encode;
mod error;
mod field;
mod frame;
mod image;
mod legend;
mod light;
mod normals;
mod palette;
mod picture;
mod range;
mod raster;
mod series;
mod surface;
mod text;

pub use camera::{Camera, Fit};
pub use colour::{Map, Scale};
pub use draw::{Drawn, Options, draw, draw_with_progress};
pub use error::RenderError;
pub use image::Image;
pub use picture::{Colouring, Picture, paint};
