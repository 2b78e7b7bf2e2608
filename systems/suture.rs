//! `suture`: forces of threads on nodes. `shaders/suture.wgsl` is its twin.

use super::node_system::NodeSystem;
use super::node_views::{Before, ForceSlopes, NodesAtRest};
use super::places_within;
use super::rows::Rows;
use super::system::{Phase, System};
use crate::backend::cpu::{Cpu, NodeColumns};
use crate::components::*;
use crate::math::SimdScalar;
use crate::shader;

/// Adds what `suture_tension` has found.
pub fn system() -> System {
    System::built_in_nodes::<Sutured>(
        "suture",
        Phase::Loads,
        "adds forces of sutures to the external forces",
        "`Suture(...)` under `attachments`",
        |world| super::registry::count::<Sutured>(world, "body with sutures", "bodies with sutures"),
    )
    .with_twin::<Sutured>("suture", shader!("suture"), |_, stage| stage)
}

/// Threads go slack and taut: at 0.9 of the step that is stable with them drawn each time may make energy (a thread of
/// 1e5 N/m between two cubes trebled it in 9000 steps), at 0.6 of it none was made. This is the square of their ratio.
const SLACK: f64 = 2.25;

impl NodeSystem for Sutured {
    type Columns = (&'static SutureForce, &'static mut ExternalForce);
    type Prepared = ();

    fn rows(&self) -> Rows<'_> {
        Rows::List(&self.rows)
    }

    fn prepare(&self, _: &Before<'_>) {}

    fn act<T: SimdScalar>(&self, (): &(), _: &Cpu, nodes: &mut NodeColumns<'_, T>) {
        for place in places_within(&self.rows, nodes.first, nodes.rows()) {
            nodes.add_load(self.rows[place] as usize - nodes.first, self.forces[place]);
        }
    }

    /// Of the masses at the start, to which sutures keep (see [`Sutured::masses`]), and `SLACK` times as large.
    fn slopes(&self, _: &NodesAtRest<'_>) -> ForceSlopes {
        let each = self.stiffness.iter().zip(&self.masses).filter(|(_, mass)| **mass > 0.0);
        let stiffness = each.map(|(stiffness, mass)| stiffness / mass).fold(0.0, f64::max);
        ForceSlopes { stiffness: SLACK * stiffness, damping: 0.0 }
    }
}
