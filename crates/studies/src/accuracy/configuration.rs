//! One way to solve a scene: what is varied, and how a variation is called.

use super::method::Method;
use serde::{Serialize, Serializer};
use sinew::mesh::ElementKind;
use sinew::scene::schema::ViscousIntegrator;
use std::cmp::Ordering;
use std::fmt;

/// Cells along an edge against the scene's: 2 has half the cell size.
#[derive(Clone, Copy, Debug)]
pub struct Factor {
    /// Multiplied by this,
    pub up: u32,
    /// divided by that.
    pub down: u32,
}

impl Factor {
    /// The scene's own mesh.
    pub const ONE: Factor = Factor { up: 1, down: 1 };

    /// `up / down`; neither may be 0.
    pub const fn new(up: u32, down: u32) -> Self {
        Factor { up, down }
    }

    /// The number.
    pub fn value(self) -> f64 {
        f64::from(self.up) / f64::from(self.down.max(1))
    }

    /// Twice as many cells along an edge.
    pub fn times_two(self) -> Self {
        if self.down.is_multiple_of(2) {
            Factor::new(self.up, self.down / 2)
        } else {
            Factor::new(2 * self.up, self.down)
        }
    }

    /// A number of cells times this; `None` when that is no whole number.
    pub fn times(self, cells: u32) -> Option<u32> {
        let product = cells.checked_mul(self.up)?;
        (product % self.down == 0 && product > 0).then_some(product / self.down)
    }
}

impl PartialEq for Factor {
    fn eq(&self, other: &Self) -> bool {
        self.up * other.down == other.up * self.down
    }
}

impl Eq for Factor {}

impl PartialOrd for Factor {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Factor {
    fn cmp(&self, other: &Self) -> Ordering {
        (self.up * other.down).cmp(&(other.up * self.down))
    }
}

impl fmt::Display for Factor {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.down {
            1 => write!(f, "×{}", self.up),
            down => write!(f, "×{}/{down}", self.up),
        }
    }
}

impl Serialize for Factor {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        to.serialize_f64(self.value())
    }
}

/// The number type and how displacements are summed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum Digits {
    /// f32, plain sums.
    Plain,
    /// f32, displacements summed with compensation.
    Compensated,
    /// f64.
    Double,
}

impl fmt::Display for Digits {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Digits::Plain => "f32 plain",
            Digits::Compensated => "f32 compensated",
            Digits::Double => "f64",
        })
    }
}

/// Where a configuration runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum Processor {
    /// On the CPU.
    Cpu,
    /// On a GPU.
    Gpu,
}

impl fmt::Display for Processor {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Processor::Cpu => "CPU",
            Processor::Gpu => "GPU",
        })
    }
}

/// One way to solve a scene.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Configuration {
    /// The kind of elements; `None`: as the scene has them, of several kinds.
    pub element: Option<ElementKind>,
    /// How fine the mesh is against the scene's.
    pub mesh: Factor,
    /// The scene's step is divided by this.
    pub step: u32,
    /// How it is stepped in time, or led to rest.
    pub method: Method,
    /// The number type.
    pub digits: Digits,
    /// The scene's hourglass stiffness is multiplied by this.
    pub hourglass: f64,
    /// How viscous history is carried on; `None`: there is none, or as the scene has it.
    pub viscous: Option<ViscousIntegrator>,
    /// Another elastic law of the same small-strain moduli, by its word; `None`: the scene's.
    pub law: Option<String>,
    /// Where it runs.
    pub place: Processor,
    /// An effect of the scene that is switched off, in words.
    pub without: Option<String>,
}

impl Configuration {
    /// The name of its elements in reports.
    pub fn element_name(&self) -> String {
        self.element.map_or("as written".into(), |kind| format!("{kind:?}"))
    }

    /// What is other than in `base`, the scene as it is written.
    pub fn label(&self, base: &Configuration) -> String {
        let mut words = Vec::new();
        if self.element != base.element {
            words.push(self.element_name());
        }
        if self.mesh != base.mesh {
            words.push(format!("mesh {}", self.mesh));
        }
        if self.step != base.step {
            words.push(format!("Δt/{}", self.step));
        }
        if self.method != base.method {
            words.push(self.method.to_string());
        }
        if self.digits != base.digits {
            words.push(self.digits.to_string());
        }
        if self.hourglass != base.hourglass {
            words.push(format!("hourglass ×{}", self.hourglass));
        }
        if let Some(viscous) = self.viscous.filter(|_| self.viscous != base.viscous) {
            words.push(match viscous {
                ViscousIntegrator::Exact => "exact viscosity".into(),
                ViscousIntegrator::BackwardEuler => "backward Euler".into(),
            });
        }
        if let Some(law) = self.law.as_ref().filter(|_| self.law != base.law) {
            words.push(law.replace('_', " "));
        }
        if self.place != base.place {
            words.push(self.place.to_string());
        }
        if let Some(without) = &self.without {
            words.push(format!("without {without}"));
        }
        if words.is_empty() { "as written".into() } else { words.join(", ") }
    }
}
