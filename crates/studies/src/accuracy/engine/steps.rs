//! Ways to step in time that a scene can have beside its own.

use super::Engine;
use super::march::FIELDS;
use crate::accuracy::configuration::{Configuration, Processor};
use crate::accuracy::method::Method;
use crate::accuracy::solver::Refusal;

impl Engine<'_> {
    /// All but the scene's own. Where implicit steps are refused one of each formula says so.
    pub(super) fn methods(&mut self, base: &Configuration) -> Result<Vec<Method>, Refusal> {
        if self.file.scene.is_static() {
            return Ok(self.rest.iter().filter_map(|rest| rest.beside).map(Method::Rest).collect());
        }
        let explicit = Configuration { method: Method::Explicit, place: Processor::Cpu, ..base.clone() };
        let stable = match self.step(&explicit, &self.options(&explicit)) {
            // the scene as it is written says what is wrong with it
            Err(Refusal::Refused(_) | Refusal::Broke(_)) => return Ok(Vec::new()),
            stable => stable?,
        };
        let all = Method::of_motion(self.file.scene.duration, stable, FIELDS);
        let mut methods: Vec<Method> = Vec::new();
        let mut refused = false;
        for method in all.into_iter().filter(|method| method.to_string() != base.method.to_string()) {
            let again = methods.iter().any(|known| method.formula().is_some() && known.formula() == method.formula());
            if refused && again {
                continue;
            }
            if method.is_implicit() && !refused {
                let implicit = Configuration { method, ..explicit.clone() };
                refused = matches!(self.calibrate(&implicit), Err(Refusal::Refused(_)));
            }
            methods.push(method);
        }
        Ok(methods)
    }
}
