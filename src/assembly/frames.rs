//! Laws in frames of edges: those of each element of a block.

use super::body::BlockBuilder;
use crate::backend::cpu::{LawCopies, LawParameters};
use crate::elements::{Element, with_element};
use crate::materials::{CorotationalFrame, ElasticLaw};
use crate::scene::Diagnostics;
use std::sync::Arc;

impl BlockBuilder<'_> {
    /// The law of each element, whose frame is its own. Complaints about element types without one go to `diagnostics`.
    pub(super) fn framed(
        &self,
        law: &CorotationalFrame<f64>,
        (body, material): (&str, &str),
        diagnostics: &mut Diagnostics,
    ) -> Option<LawCopies<f64>> {
        let of_element = |&element: &u32| {
            let [first, second] = with_element!(self.kind, E => E::frame(&self.points(element)[..E::NODES]))?;
            Some(of_elastic(law.with_edges(first, second)))
        };
        let Some(of_each) = self.elements.iter().map(of_element).collect::<Option<Vec<_>>>() else {
            let path = format!("materials.\"{material}\".corotational");
            let message = format!("`rotation: Frame` is of Tet4 and Hex8, the body `{body}` has {:?}", self.kind);
            diagnostics.error_at(path, message).note("`Polar` is the rotation for all elements");
            return None;
        };
        let copies: Arc<[u32]> = (0..self.elements.len() as u32).collect();
        Some(LawCopies::new(of_each, copies))
    }
}

/// The same elements with the moduli of a law.
pub(super) fn with_moduli(before: &LawCopies<f64>, law: &CorotationalFrame<f64>) -> LawCopies<f64> {
    let renewed = |of: &LawParameters<f64>| match of.elastic {
        ElasticLaw::CorotationalFrame(own) => of_elastic(CorotationalFrame { linear: law.linear, ..own }),
        _ => of.clone(),
    };
    LawCopies::new(before.of_copy.iter().map(renewed).collect(), Arc::clone(&before.copies))
}

fn of_elastic(law: CorotationalFrame<f64>) -> LawParameters<f64> {
    LawParameters {
        elastic: ElasticLaw::CorotationalFrame(law),
        fibres: None,
        exponential: Vec::new(),
        terms: Vec::new(),
    }
}
