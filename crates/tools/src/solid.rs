//! Shapes of tools that can be: what may be wrong with them, and their sizes.

use super::form::Form;
use super::shape::Shape;
use glam::DVec3;
use std::fmt;

/// The largest bevel (degrees).
const MOST_BEVEL: f64 = 80.0;

/// The largest size of a shape (m): squares of sizes and distances are numbers in f32 too.
const MOST_SIZE: f64 = 1e6;

/// The smallest (m), for the same reason.
const LEAST_SIZE: f64 = 1e-9;

/// What is wrong with the numbers of a shape.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Problem {
    /// The field of the [`Shape`] that is to be changed, or `rounding`.
    pub field: &'static str,
    /// The sentence: what is allowed, and what was found.
    pub message: String,
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for Problem {}

fn problem(field: &'static str, be: impl fmt::Display, found: impl fmt::Display) -> Result<(), Problem> {
    Err(Problem { field, message: format!("`{field}` must be {be}, found {found}") })
}

fn size(field: &'static str, value: f64) -> Result<(), Problem> {
    if (LEAST_SIZE..=MOST_SIZE).contains(&value) {
        return Ok(());
    }
    problem(field, format!("between {LEAST_SIZE:e} m and {MOST_SIZE:e} m"), format!("{value} m"))
}

/// The same, or 0.
fn size_or_zero(field: &'static str, value: f64) -> Result<(), Problem> {
    if value == 0.0 || (LEAST_SIZE..=MOST_SIZE).contains(&value) {
        return Ok(());
    }
    problem(field, format!("0, or between {LEAST_SIZE:e} m and {MOST_SIZE:e} m"), format!("{value} m"))
}

impl Shape {
    /// What is wrong with the shape, rounded by so much (m), if anything.
    pub fn problem(&self, rounding: f64) -> Option<Problem> {
        self.check(rounding).err()
    }

    fn check(&self, rounding: f64) -> Result<(), Problem> {
        match *self {
            Self::Plane {} => {}
            Self::Sphere { radius } => size("radius", radius)?,
            Self::Box { size: edges } => edges.to_array().into_iter().try_for_each(|edge| size("size", edge))?,
            Self::Capsule { length, radius } => {
                size("radius", radius)?;
                size("length", length)?;
                if length < 2.0 * radius {
                    let least = format!("at least twice `radius`, {} m", 2.0 * radius);
                    return problem("length", least, format!("{length} m"));
                }
            }
            Self::Cylinder { length, radius } => {
                size("radius", radius)?;
                size("length", length)?;
            }
            Self::Cone { length, tip, base } => {
                size("length", length)?;
                size_or_zero("tip", tip)?;
                size_or_zero("base", base)?;
                if tip == 0.0 && base == 0.0 {
                    return problem("base", "above 0 m where `tip` is 0 m", "0 m");
                }
            }
            Self::Tube { length, inner, outer, bevel } => {
                size("inner", inner)?;
                size("outer", outer)?;
                size("length", length)?;
                if outer <= inner {
                    return problem("outer", format!("more than `inner`, {inner} m"), format!("{outer} m"));
                }
                if !(0.0..=MOST_BEVEL).contains(&bevel) {
                    return problem("bevel", format!("between 0° and {MOST_BEVEL}°"), format!("{bevel}°"));
                }
                let cut = 2.0 * outer * bevel.to_radians().tan();
                if length <= cut {
                    let most = format!("more than {cut} m, which the bevel takes away on one side");
                    return problem("length", most, format!("{length} m"));
                }
            }
        }
        self.check_rounding(rounding)
    }

    fn check_rounding(&self, rounding: f64) -> Result<(), Problem> {
        let found = format!("{rounding} m");
        if !(0.0..=MOST_SIZE).contains(&rounding) {
            return problem("rounding", format!("between 0 m and {MOST_SIZE:e} m"), found);
        }
        let most = match *self {
            Self::Plane {} => f64::INFINITY,
            Self::Sphere { radius } | Self::Capsule { radius, .. } => radius,
            Self::Box { size } => size.min_element() / 2.0,
            Self::Cylinder { length, radius } => radius.min(length / 2.0),
            Self::Cone { length, tip, base } => inscribed(length, tip, base),
            Self::Tube { length, inner, outer, bevel } => {
                // the side that is left of a bevelled tube, too, has two ends
                let cut = 2.0 * outer * bevel.to_radians().tan();
                ((outer - inner) / 2.0).min((length - cut) / 2.0)
            }
        };
        if rounding < most * (1.0 - 1e-9) {
            return Ok(());
        }
        problem("rounding", format!("less than {most} m, the radius of the largest ball in the shape"), found)
    }
}

/// The radius of the largest ball in a cone of those radii (m) at its ends.
fn inscribed(length: f64, tip: f64, base: f64) -> f64 {
    // a ball that touches the larger end and the mantle
    let (less, more) = (tip.min(base), tip.max(base));
    let mantle = length.hypot(more - less);
    (length / 2.0).min(more * length / (mantle + more - less))
}

/// A [`Shape`] with round edges and corners, ready to be asked for distances: all that lies within `rounding` of the
/// shape that is smaller by as much all round. Flat faces stay where they are; a cone's point recedes, the edges of a
/// bevel stay sharp.
#[derive(Clone, Debug, PartialEq)]
pub struct Solid {
    shape: Shape,
    rounding: f64,
    form: Form,
}

impl Solid {
    /// A shape with its edges rounded by a radius (m).
    ///
    /// # Errors
    /// The first thing that is wrong with the numbers.
    pub fn new(shape: Shape, rounding: f64) -> Result<Self, Problem> {
        shape.check(rounding)?;
        let form = Form::new(&shape, rounding);
        Ok(Self { shape, rounding, form })
    }

    /// The shape as it was given.
    pub fn shape(&self) -> &Shape {
        &self.shape
    }

    /// The radius of its edges (m).
    pub fn rounding(&self) -> f64 {
        self.rounding
    }

    /// The numbers that its distance is found from.
    pub fn form(&self) -> &Form {
        &self.form
    }

    /// φ, the signed distance (m) from a place in the tool's frame to the surface, negative inside, and its gradient, a
    /// unit vector. Where several points of the surface are as near, the first in a fixed order is taken.
    ///
    /// Outside a bevelled tip, |φ| may be less than the distance to the bevel's edges.
    #[inline]
    pub fn distance(&self, y: DVec3) -> (f64, DVec3) {
        self.form.distance(y)
    }

    /// Its numbers as kernels see them: see [`Form::packed`].
    pub fn packed(&self) -> [f32; 8] {
        self.form.packed()
    }

    /// Centre and radius (m) of a ball around it; none of a plane.
    pub fn bounding_sphere(&self) -> Option<(DVec3, f64)> {
        let on_axis = |z: f64, radius: f64| Some((DVec3::new(0.0, 0.0, z), radius));
        match self.shape {
            Shape::Plane {} => None,
            Shape::Sphere { radius } => on_axis(0.0, radius),
            Shape::Box { size } => on_axis(0.0, size.length() / 2.0),
            Shape::Capsule { length, .. } => on_axis(length / 2.0, length / 2.0),
            Shape::Cylinder { length, radius } | Shape::Tube { length, outer: radius, .. } => {
                on_axis(length / 2.0, radius.hypot(length / 2.0))
            }
            Shape::Cone { length, tip, base } => {
                // as far from both rims, if that is between them
                let z = ((length + (base - tip) * (base + tip) / length) / 2.0).clamp(0.0, length);
                on_axis(z, tip.hypot(z).max(base.hypot(length - z)))
            }
        }
    }

    /// Half of what it measures across where it is thinnest (m), along its axis, too: of a tube half its wall, of a
    /// pointed cone its rounding. Between nodes that are farther apart it slips through. None of a plane.
    pub fn smallest_radius(&self) -> Option<f64> {
        match self.shape {
            Shape::Plane {} => None,
            Shape::Sphere { radius } | Shape::Capsule { radius, .. } => Some(radius),
            Shape::Cylinder { length, radius } => Some(radius.min(length / 2.0)),
            Shape::Box { size } => Some(size.min_element() / 2.0),
            Shape::Cone { length, tip, base } => Some(tip.min(base).max(self.rounding).min(length / 2.0)),
            Shape::Tube { length, inner, outer, .. } => Some((outer - inner).min(length) / 2.0),
        }
    }
}
