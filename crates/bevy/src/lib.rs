//! Soft tissue in [Bevy](https://bevy.org): scenes are assets, their bodies meshes that move.
//!
//! ```no_run
//! use bevy_app::prelude::*;
//! use bevy_asset::AssetServer;
//! use bevy_ecs::prelude::*;
//! use sinew_bevy::{SinewPlugin, SoftScene, z_up};
//!
//! fn setup(mut commands: Commands, assets: Res<AssetServer>) {
//!     commands.spawn((SoftScene(assets.load("jelly.ron")), z_up()));
//! }
//! // in a game: App::new().add_plugins((DefaultPlugins, SinewPlugin)).add_systems(Startup, setup).run();
//! ```
//!
//! `docs/bevy.md` tells how it is used. Two worlds: sinew's own stays within [`SoftSimulation`], whose columns and
//! schedule are the engine's.

mod gizmos;
mod grab;
mod mesh;
mod prepare;
mod scene;
mod simulation;
mod step;

pub use gizmos::{SinewGizmosPlugin, SoftGizmos};
pub use grab::SoftGrab;
pub use scene::{NotLoaded, SceneLoader, SceneText};
pub use simulation::{
    BrokeDown, ElementsRemoved, FellBehind, Refused, SinewClock, SoftBody, SoftInputs, SoftOptions, SoftProbes,
    SoftScene, SoftSimulation, z_up,
};
// what its types are made of
pub use sinew;

use bevy_app::{App, FixedPostUpdate, Plugin, PostUpdate, PreUpdate};
use bevy_asset::{AssetApp, AssetEventSystems};
use bevy_ecs::prelude::*;

/// The systems of a frame, in this order.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum SinewSystems {
    /// Scenes become simulations (`PreUpdate`).
    Prepare,
    /// Inputs and hands (`FixedPostUpdate`).
    Inputs,
    /// Steps (`FixedPostUpdate`).
    Step,
    /// Meshes are written (`PostUpdate`, before what looks for changed assets).
    WriteMeshes,
}

/// Runs scenes. It needs Bevy's assets, meshes, time and transforms, which `DefaultPlugins` have.
#[derive(Clone, Copy, Debug, Default)]
pub struct SinewPlugin;

impl Plugin for SinewPlugin {
    fn build(&self, app: &mut App) {
        app.init_asset::<SceneText>()
            .register_asset_loader(SceneLoader)
            .init_resource::<SinewClock>()
            .add_message::<BrokeDown>()
            .add_message::<Refused>()
            .add_message::<ElementsRemoved>()
            .add_message::<FellBehind>()
            .add_observer(grab::open)
            .add_observer(grab::let_go)
            .configure_sets(FixedPostUpdate, (SinewSystems::Inputs, SinewSystems::Step).chain())
            .configure_sets(PostUpdate, SinewSystems::WriteMeshes.before(AssetEventSystems))
            .add_systems(PreUpdate, prepare::prepare.in_set(SinewSystems::Prepare))
            .add_systems(FixedPostUpdate, (step::set_inputs, grab::hold).chain().in_set(SinewSystems::Inputs))
            .add_systems(FixedPostUpdate, (step::step, grab::feel).chain().in_set(SinewSystems::Step))
            .add_systems(PostUpdate, mesh::write_meshes.in_set(SinewSystems::WriteMeshes));
    }
}
