//! The Rust of docs/systems.md, and what README.md shows of it.

#[rustfmt::skip]
mod parameters {
    use sinew::prelude::*;

    #[derive(Resource, serde::Deserialize)]
    #[serde(crate = "sinew::serde")]
    struct Magnet { acceleration: f64 }
}

#[rustfmt::skip]
mod of_nodes {
    use sinew::prelude::*;
    use sinew::systems::{Before, Cpu, ForceSlopes, NodeColumns, NodeSystem, NodesAtRest, SimdScalar};

    #[derive(Component, Clone, serde::Deserialize, serde::Serialize)]
    struct Magnet { center: DVec3, radius: f64, turns: f64, acceleration: f64, reach: f64 }

    impl NodeSystem for Magnet {
        // what it reads and writes
        type Columns = (&'static RestPosition, &'static Displacement, &'static Mass, &'static mut ExternalForce);
        // what a step needs beside the component: found out before any node moves,
        // and the only place that sees nodes of other rows
        type Prepared = (DVec3, f64);

        fn prepare(&self, before: &Before<'_>) -> (DVec3, f64) {
            (self.place(before.clock.time()), self.acceleration)
        }

        // the largest of −∂f/∂u and −∂f/∂v over the mass of a node, for the stable step
        fn slopes(&self, _: &NodesAtRest<'_>) -> ForceSlopes {
            ForceSlopes { stiffness: 2.34 * self.acceleration / self.reach, damping: 0.0 }
        }

        fn act<T: SimdScalar>(&self, &(place, strength): &(DVec3, f64), _: &Cpu, nodes: &mut NodeColumns<'_, T>) {
            for row in 0..nodes.rows() {
                let toward = place - nodes.place(row);
                let near = (-toward.length_squared() / self.reach.powi(2)).exp();
                nodes.add_load(row, nodes.mass()[row].to_f64() * strength * near * toward.normalize_or_zero());
            }
        }
    }

    impl Magnet {
        fn place(&self, time: f64) -> DVec3 {
            self.center
        }
    }

    /// In place of std's: the shader that is shown is that of an example.
    macro_rules! include_str {
        ($name:literal) => {
            ::std::include_str!(concat!("../../examples/", $name))
        };
    }

    fn registered(scene: SceneFile) -> Result<(), Error> {
        let magnet = System::of_nodes::<Magnet>("magnet", Phase::Loads, "pulls what is near a circling magnet")
            .on_each_body::<Magnet>()
            .with_shader::<Magnet>("examples/magnet.wgsl", include_str!("magnet.wgsl"));
        let mut simulation = Simulation::with_systems(&scene, &Options::default(), &Registry::default().with(magnet))?;
        Ok(())
    }
}

#[rustfmt::skip]
mod beside_columns {
    use sinew::prelude::*;
    use sinew::systems::{Rows, Stage};

    #[derive(Component)]
    struct Anchors { rows: Vec<u32>, goals: Vec<f32> }

    impl NodeSystem for Anchors {
        type Columns = (&'static Displacement, &'static mut ExternalForce);
        type Prepared = ();

        fn rows(&self) -> Rows<'_> {
            Rows::List(&self.rows)
        }

        fn stages(&self, _: Entity, _: &World) -> Vec<Stage> {
            vec![Stage::of(self.rows()).reals("goals", &self.goals)]
        }

        fn prepare(&self, _: &Before<'_>) {}

        fn slopes(&self, _: &NodesAtRest<'_>) -> ForceSlopes {
            ForceSlopes::NONE
        }

        fn act<T: SimdScalar>(&self, (): &(), _: &Cpu, nodes: &mut NodeColumns<'_, T>) {}
    }
}

#[rustfmt::skip]
mod on_the_host {
    use sinew::prelude::*;

    #[derive(Resource, serde::Deserialize)]
    struct Magnet {
        acceleration: f64,
    }

    impl Magnet {
        fn place(&self, time: f64) -> DVec3 {
            DVec3::ZERO
        }

        fn pull(&self, toward: DVec3) -> DVec3 {
            self.acceleration * toward
        }
    }

    fn registered() -> System {
        fn magnet(
            magnet: Res<Magnet>,                // its parameters
            clock: Res<Clock>,                  // time, step
            mut bodies: Query<(&RestPosition, &Displacement, &Mass, &mut ExternalForce)>,
        ) {
            for (rest, displacement, mass, mut force) in &mut bodies {
                for row in 0..rest.0.len() {
                    let toward = magnet.place(clock.time()) - (rest.0[row] + displacement.vector(row));
                    // other loads may have been here before
                    let sum = force.vector(row) + mass.get(row) * magnet.pull(toward);
                    force.set_vector(row, sum);
                }
            }
        }

        let system = System::custom("magnet", Phase::Loads, "pulls what is near", magnet).with_parameters::<Magnet>();
        system
    }
}

#[rustfmt::skip]
mod slopes {
    use sinew::prelude::*;
    use sinew::systems::ForceSlopes;

    #[derive(Resource, serde::Deserialize)]
    struct Hanger {
        stiffness: f64,
    }

    fn pull(hanger: Res<Hanger>, mut bodies: Query<&mut ExternalForce>) {}

    fn energy(hanger: Res<Hanger>) -> f64 {
        0.0
    }

    fn registered() -> System {
        fn slopes(hanger: Res<Hanger>) -> ForceSlopes {
            ForceSlopes { stiffness: hanger.stiffness, damping: 0.0 }
        }

        let system = System::custom("hanger", Phase::Loads, "holds what is high", pull)
            .with_parameters::<Hanger>()
            .with_slopes(slopes)
            .with_energy(energy);
        system
    }
}

#[rustfmt::skip]
mod taking_part {
    use sinew::components::DampingCoefficient;
    use sinew::prelude::*;

    fn pull() {}

    fn registered() -> System {
        let system = System::custom("hanger", Phase::Loads, "holds what is high", pull)
            .when("damping of a material", |world| {
                let damped = world.query::<&DampingCoefficient>().iter(world).count();
                (damped > 0).then(|| "a body is damped".into())
            });
        system
    }
}

#[rustfmt::skip]
mod chosen_nodes {
    use sinew::prelude::*;

    fn held(simulation: &mut Simulation) -> Result<(), Error> {
        #[derive(Resource)]
        struct Grip { nodes: NodeSet, force: DVec3 }

        fn pull(grip: Res<Grip>, mut bodies: Query<&mut ExternalForce>) -> Result<(), Error> {
            grip.nodes.add_force(&mut bodies, grip.force)
        }

        let nodes = simulation.nodes_numbered("liver", &[17])?;
        simulation.world_mut().insert_resource(Grip { nodes, force: DVec3::Z });
        Ok(())
    }
}

#[rustfmt::skip]
mod readme {
    use sinew::prelude::*;

    #[derive(Resource, serde::Deserialize)]
    struct Wind;

    fn registered(scene: SceneFile, options: Options) -> Result<(), Error> {
        fn wind(wind: Res<Wind>, mut bodies: Query<(&Mass, &mut ExternalForce)>) { /* ... */ }

        let system = System::custom("wind", Phase::Loads, "blows", wind).with_parameters::<Wind>();
        let mut simulation = Simulation::with_systems(&scene, &options, &Registry::default().with(system))?;
        Ok(())
    }
}
