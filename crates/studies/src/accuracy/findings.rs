//! What follows from the rows of a study: orders, the parts of the error, what effects do, advice and a verdict.

use super::advice::advice;
use super::configuration::Factor;
use super::field::same_mesh;
use super::pareto::observed_order;
use super::plan::Varied;
use super::quantities::{distance, readings};
use super::reference::{CLEARLY, Error, FIELD, Reference, ReferenceSource};
use super::richardson::extrapolate;
use super::solver::Solution;
use super::study::Row;
use serde::Serialize;

/// What follows from a study.
#[derive(Clone, Debug, Serialize)]
pub struct Findings {
    /// Observed orders: of what, and the exponent.
    pub orders: Vec<Order>,
    /// The parts of the error of the scene as it is written.
    pub split: Split,
    /// What each effect costs and changes.
    pub effects: Vec<EffectFinding>,
    /// Sentences, the most important first.
    pub advice: Vec<String>,
    /// Whether the scene as it is written meets the target.
    pub verdict: TargetVerdict,
}

/// How fast errors fall.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Order {
    /// The element, or `time step`.
    pub of: String,
    /// The exponent of the cell size, or of the step.
    pub order: f64,
    /// How many rows it was observed on.
    pub rows: usize,
}

/// Parts of the error of the scene as it is written, relative, each had by changing nothing else.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Split {
    /// All of it.
    pub total: Option<f64>,
    /// What cells of no size would change.
    pub space: Option<f64>,
    /// Whether `space` is only a bound: the reference cannot tell it from none.
    pub space_is_a_bound: bool,
    /// What a quarter of the step changes.
    pub time: Option<f64>,
    /// What f64 changes.
    pub round_off: Option<f64>,
    /// What is left of the distance from an outside reference with cells of no size.
    pub model: Option<f64>,
    /// What half or twice the hourglass stiffness changes; a part of `space`.
    pub hourglass: Option<f64>,
    /// Whether the error does not fall with the mesh.
    pub stays: bool,
}

/// What an effect of the scene costs and changes.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct EffectFinding {
    /// The effect.
    pub effect: String,
    /// The share of the scene's time that goes when it is switched off (negative: it takes longer without).
    pub costs: f64,
    /// How far the quantity judged by is off without it, relative.
    pub changes: f64,
}

/// Whether the scene as it is written meets the target.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum TargetVerdict {
    /// Its error and the reference's uncertainty together are below the target.
    Met,
    /// Its error is above the target even if the reference's uncertainty is taken off.
    NotMet,
    /// The reference is too coarse to tell, or the scene as it is written did not run.
    CannotTell,
}

/// Draws the conclusions. `solutions[i]` belongs to `rows[i]`.
pub fn findings(
    rows: &[Row],
    solutions: &[Option<Solution>],
    reference: &Reference,
    judged_by: &str,
    target: f64,
) -> Findings {
    let facts = Facts { rows, solutions, reference, judged_by };
    let (orders, split, effects) = (facts.orders(), facts.split(), facts.effects());
    let verdict = match facts.written().and_then(|row| rows[row].errors.get(judged_by)) {
        Some(error) if error.error + error.uncertainty <= target => TargetVerdict::Met,
        Some(error) if error.error - error.uncertainty > target => TargetVerdict::NotMet,
        _ => TargetVerdict::CannotTell,
    };
    let advice = advice(rows, &split, reference.source, judged_by, target);
    Findings { orders, split, effects, advice, verdict }
}

struct Facts<'a> {
    rows: &'a [Row],
    solutions: &'a [Option<Solution>],
    reference: &'a Reference,
    judged_by: &'a str,
}

impl Facts<'_> {
    /// The row of the scene as it is written.
    fn written(&self) -> Option<usize> {
        self.rows.iter().position(|row| row.varied == Varied::Nothing && row.measured().is_some())
    }

    /// Rows that differ from the scene as it is written in the mesh alone, and have its elements; with it, finer and
    /// finer.
    fn meshes(&self, element: &str) -> Vec<usize> {
        let of = |row: &Row| matches!(row.varied, Varied::Nothing | Varied::Mesh) && row.measured().is_some();
        let mut found: Vec<usize> = (0..self.rows.len())
            .filter(|&i| of(&self.rows[i]) && self.rows[i].configuration.element_name() == element)
            .collect();
        found.sort_by_key(|&i| self.rows[i].configuration.mesh);
        found
    }

    fn size(&self, row: usize) -> f64 {
        1.0 / self.rows[row].configuration.mesh.value()
    }

    fn orders(&self) -> Vec<Order> {
        let mut orders = Vec::new();
        let mut elements: Vec<String> = self.rows.iter().map(|row| row.configuration.element_name()).collect();
        elements.sort();
        elements.dedup();
        for of in elements {
            let clear = |&row: &usize| self.rows[row].errors.get(self.judged_by).filter(|error| error.is_clear());
            let points: Vec<(f64, f64)> =
                self.meshes(&of).iter().filter_map(|row| Some((self.size(*row), clear(row)?.error))).collect();
            if let Some(order) = observed_order(&points) {
                orders.push(Order { of, order, rows: points.len() });
            }
        }
        orders.extend(self.order_in_time());
        orders
    }

    /// From the distances of Δt and Δt/2 to Δt/4: with order p they are in the ratio (4ᵖ − 1) / (2ᵖ − 1) = 2ᵖ + 1.
    fn order_in_time(&self) -> Option<Order> {
        let of = |step| self.rows.iter().position(|r| r.varied == Varied::Step && r.configuration.step == step);
        let (written, half, quarter) = (self.written()?, of(2)?, of(4)?);
        let (far, near) = (self.apart(written, quarter)?, self.apart(half, quarter)?);
        let noise = self.round_off(written).unwrap_or(0.0);
        if near <= CLEARLY * noise || far <= near {
            return None;
        }
        Some(Order { of: "time step".into(), order: (far / near - 1.0).log2(), rows: 3 })
            .filter(|o| o.order.is_finite())
    }

    /// Distance of two rows in the quantity judged by, relative.
    fn apart(&self, a: usize, b: usize) -> Option<f64> {
        let (a, b) = (self.solutions[a].as_ref()?, self.solutions[b].as_ref()?);
        if let Some(place) = FIELD.iter().position(|name| *name == self.judged_by) {
            return same_mesh(a.field.as_ref()?, b.field.as_ref()?).map(|error| error.all()[place]);
        }
        let (a, b) = (readings(a), readings(b));
        let (a, b) = (a.get(self.judged_by)?, b.get(self.judged_by)?);
        let apart = distance(&a.values, &b.values) / b.scale;
        apart.is_finite().then_some(apart)
    }

    /// Distance of the scene as it is written from the first row that `is` says, and that ran.
    fn against_written(&self, is: impl Fn(&Row) -> bool) -> Option<f64> {
        let written = self.written()?;
        let all = (0..self.rows.len()).filter(|&row| is(&self.rows[row]));
        all.filter_map(|row| self.apart(written, row)).next()
    }

    fn round_off(&self, written: usize) -> Option<f64> {
        use super::configuration::Digits::Double;
        if self.rows[written].configuration.digits == Double {
            return Some(0.0);
        }
        self.against_written(|row| row.varied == Varied::Digits && row.configuration.digits == Double)
    }

    fn split(&self) -> Split {
        let Some(written) = self.written() else { return Split::default() };
        let total = self.rows[written].errors.get(self.judged_by).map(|error| error.error);
        let time = self.against_written(|row| row.varied == Varied::Step && row.configuration.step == 4);
        let round_off = self.round_off(written);
        let hourglass = (0..self.rows.len())
            .filter(|&row| self.rows[row].varied == Varied::Hourglass)
            .filter_map(|row| self.apart(written, row))
            .reduce(f64::max);
        let alone = self.rows.iter().find(|row| row.varied == Varied::SpaceAlone && row.measured().is_some());
        let alone = alone.or(Some(&self.rows[written])).and_then(|row| row.errors.get(self.judged_by));
        let space_is_a_bound = alone.is_some_and(|error| !error.is_clear());
        let (mut space, mut model) = (alone.map(Error::vouched), None);
        if !matches!(self.reference.source, ReferenceSource::SelfMade | ReferenceSource::None) {
            model = self.model(written).filter(|left| {
                // what step and rounding make stays on every mesh too
                *left > CLEARLY * (time.unwrap_or(0.0) + round_off.unwrap_or(0.0))
            });
            // of two errors of unknown sign the difference is the least that space can be
            space = space.zip(model).map(|(all, model)| (all - model).abs()).or(space);
        }
        let stays = self.stays(written, time, round_off);
        Split { total, space, space_is_a_bound, time, round_off, model, hourglass, stays }
    }

    /// What the error comes to with cells of no size; `None` where that cannot be told from 0 or from what is not
    /// known.
    fn model(&self, written: usize) -> Option<f64> {
        let rows = self.meshes(&self.rows[written].configuration.element_name());
        let [.., a, b, c] = rows[..] else { return None };
        let error = |row: usize| self.rows[row].errors.get(self.judged_by).map(|error| error.error);
        let reference = self.rows[c].errors.get(self.judged_by).map_or(0.0, |error| error.uncertainty);
        let sizes = [a, b, c].map(|row| self.size(row));
        let errors = [error(a)?, error(b)?, error(c)?];
        let limit = extrapolate(sizes, [&errors[..1], &errors[1..2], &errors[2..]], |value| value[0].abs());
        let left = limit.values.first().copied()?;
        (left > CLEARLY * (limit.uncertainty + reference)).then_some(left)
    }

    /// Whether the error stays where it is on finer meshes, though neither step nor rounding make it.
    fn stays(&self, written: usize, time: Option<f64>, round_off: Option<f64>) -> bool {
        let rows = self.meshes(&self.rows[written].configuration.element_name());
        let clear = |row: &usize| self.rows[*row].errors.get(self.judged_by).filter(|e| e.is_clear()).map(|e| e.error);
        let Some((&first, &last)) = rows.first().zip(rows.last()) else { return false };
        let (Some(coarse), Some(fine)) = (clear(&first), clear(&last)) else { return false };
        let finer = self.rows[last].configuration.mesh > self.rows[first].configuration.mesh
            && self.rows[last].configuration.mesh > Factor::new(1, 2);
        let order = (coarse / fine).ln() / (self.size(first) / self.size(last)).ln();
        let others = time.unwrap_or(0.0).max(round_off.unwrap_or(0.0));
        finer && order < 0.3 && others < fine / CLEARLY
    }

    fn effects(&self) -> Vec<EffectFinding> {
        let Some(written) = self.written() else { return Vec::new() };
        let time = |row: usize| self.rows[row].measured().map(|measured| measured.seconds_per_second);
        let finding = |row: usize| {
            let effect = self.rows[row].configuration.without.clone()?;
            // the other way round: what the scene as it is written has beyond the row, measured by the scene
            let changes = self.apart(row, written)?;
            Some(EffectFinding { effect, costs: 1.0 - time(row)? / time(written)?, changes })
        };
        (0..self.rows.len()).filter(|&row| self.rows[row].varied == Varied::Effect).filter_map(finding).collect()
    }
}
