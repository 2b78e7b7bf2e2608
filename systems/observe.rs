//! `observe`: probes, energies, fields and guards, in the steps in which something is due. See
//! [`Observer`](crate::observation::Observer).

use super::registry::{Phase, System};
use crate::error::Error;
use crate::observation::Observer;
use bevy_ecs::prelude::*;

/// Reads only. On the GPU it brings to the host what is due, and nothing in all other steps.
pub fn system() -> System {
    System {
        name: "observe".into(),
        phase: Phase::Observe,
        does: "probes, energies, fields and guards, when they are due".into(),
        called_for_by: "every scene",
        because: |_| Some("guards look for inverted elements and lost numbers".into()),
        host: Box::new(|| Box::new(IntoSystem::into_system(observe))),
        kernels: None,
        observes: true,
        every: 1,
        custom: false,
        parameters: None,
        state: None,
    }
}

fn observe(world: &mut World) -> Result<(), Error> {
    let step = world.resource::<crate::components::Clock>().step;
    world.resource_scope(|world, mut observer: Mut<Observer>| {
        // asked at every step on the CPU; on the GPU only when something is due
        if observer.next_due(step.saturating_sub(1)) == step { observer.observe(world) } else { Ok(()) }
    })
}
