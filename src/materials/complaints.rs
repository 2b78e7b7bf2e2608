//! What is told of the parameters of a law: mistakes and warnings, each at its place.

/// A mistake or a warning.
#[derive(Clone, Debug, PartialEq)]
pub struct Complaint {
    /// The way to what it is about, from the parameters on: `terms[0].alpha`.
    pub at: String,
    /// Whether the scene cannot be run with it.
    pub is_error: bool,
    /// The sentence.
    pub message: String,
    /// What helps.
    pub notes: Vec<String>,
}

impl Complaint {
    /// Adds what helps.
    pub fn note(&mut self, note: impl Into<String>) -> &mut Self {
        self.notes.push(note.into());
        self
    }
}

/// What is told of parameters.
#[derive(Clone, Debug, Default)]
pub struct Complaints {
    /// In the order in which it was told.
    pub list: Vec<Complaint>,
}

impl Complaints {
    /// A mistake at a field.
    pub fn error(&mut self, field: &str, message: impl Into<String>) -> &mut Complaint {
        self.at(field, true, message)
    }

    /// What looks like one at a field, and does not keep the scene from running.
    pub fn warn(&mut self, field: &str, message: impl Into<String>) -> &mut Complaint {
        self.at(field, false, message)
    }

    /// The same somewhere within the parameters.
    pub fn at(&mut self, at: impl Into<String>, is_error: bool, message: impl Into<String>) -> &mut Complaint {
        self.list.push(Complaint { at: at.into(), is_error, message: message.into(), notes: Vec::new() });
        let last = self.list.len() - 1;
        &mut self.list[last]
    }

    /// That a field must be something else.
    pub fn must(&mut self, field: &str, be: &str, found: f64) -> &mut Complaint {
        self.error(field, format!("`{field}` must be {be}, found {}", number(found)))
    }

    /// A field whose value must be above 0.
    pub fn above_zero(&mut self, field: &str, value: f64, unit: &str) {
        if value <= 0.0 {
            self.error(field, format!("`{field}` must be above 0, found {}", with_unit(value, unit)));
        }
    }

    /// A field `bulk` (Pa), with a warning where it is small against the shear modulus of small strains (Pa), which is
    /// named as in "2/3 `shear`".
    pub fn bulk_modulus(&mut self, bulk: f64, shear: f64, called: &str) {
        self.above_zero("bulk", bulk, "Pa");
        let poisson = (3.0 * bulk - 2.0 * shear) / (2.0 * (3.0 * bulk + shear));
        if shear > 0.0 && bulk > 0.0 && poisson < 0.0 {
            self.warn("bulk", format!("`bulk` is small: Poisson's ratio is {poisson:.3}")).note(format!(
                "Poisson's ratio is above 0 when `bulk` is above 2/3 {called}, here {}",
                number(shear * 2.0 / 3.0)
            ));
        }
    }
}

/// A number as an author would write it.
pub fn number(value: f64) -> String {
    let size = value.abs();
    if size == 0.0 || (1e-4..1e7).contains(&size) { format!("{value}") } else { format!("{value:e}") }
}

/// The same with its unit, where it has one.
pub fn with_unit(value: f64, unit: &str) -> String {
    let value = number(value);
    if unit.is_empty() { value } else { format!("{value} {unit}") }
}
