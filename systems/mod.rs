//! The step: every system a file of its own here, its kernel a file of the same stem in `shaders/`.
//!
//! ```text
//! boundary         Prescribed                   -> DisplacementStep of constrained axes   per node
//! nodal_volume     Displacement, RestShape      -> NodalVolumeChange                      per element, per node
//! element_forces   Displacement, RestShape, law -> ElementForce                           per element, patch by patch
//! gather           ElementForce, Corners        -> InternalForce (ExternalForce: zero)    per node, over its patches, in a fixed order
//! gravity          Mass                         -> ExternalForce                          per node
//! nodal_force                                   -> ExternalForce                          per loaded node
//! pressure         Displacement                 -> ExternalForce                          per loaded node
//! traction                                      -> ExternalForce                          per loaded node
//! integrate        forces, Mass                 -> DisplacementStep, Displacement         per node
//! element_removal  criteria, times              -> Alive, RestShape, Mass                 per element, per node
//! observe          all, read only               -> probes, energies, guards, files
//! ```

mod boundary;
mod element_forces;
mod element_removal;
mod gather;
mod gravity;
mod integrate;
mod nodal_force;
mod nodal_volume;
mod observe;
mod pressure;
mod registry;
mod traction;

pub(crate) use gather::sum_corners;
pub(crate) use nodal_volume::means_of;
pub use observe::{add_watch_columns, watch_kernels};
pub use registry::{DescribeKernels, HostSystem, Phase, Registry, System};

/// The built-in systems, in the order of a step.
pub fn standard() -> Vec<System> {
    vec![
        boundary::system(),
        nodal_volume::system(),
        element_forces::system(),
        gather::system(),
        gravity::system(),
        nodal_force::system(),
        pressure::system(),
        traction::system(),
        integrate::system(),
        element_removal::system(),
        observe::system(),
    ]
}
