//! Node columns of a body, and what blocks need once the time step is known.

use super::Assembly;
use crate::backend::cpu::{BlockLaw, LawCopies, LawParameters, OwnKernels, PerCopyLaw};
use crate::components::*;
use crate::elements::Stiffness;
use crate::elements::{node_count, point_count};
use crate::evaluation::add_nodal_masses;
use crate::materials::{Elastic, ElasticLaw, Fibres};
use crate::math::LANES;
use crate::math::lane_place;
use crate::mesh::{ElementKind, Mesh};
use crate::scene::schema::{Constraint, Guard, ImplicitScheme, Solver};
use bevy_ecs::prelude::*;
use glam::DVec3;
use std::sync::Arc;

/// Rest positions, masses and the columns of motion. Optional columns come with what calls for them.
pub(super) fn insert_node_columns(
    assembly: &Assembly<'_>,
    name: &str,
    mesh: &Mesh,
    node_rows: &[u32],
    authoring: &Authoring,
    world: &mut World,
    body: Entity,
) {
    let (count, precision) = (mesh.points.len(), assembly.precision);
    let mut rest = vec![DVec3::ZERO; count];
    for (&point, &row) in mesh.points.iter().zip(node_rows) {
        rest[row as usize] = point;
    }
    let vectors = || Reals::zeros(precision, 3 * count);
    let scene = &assembly.scene.scene;
    let mut entity = world.entity_mut(body);
    entity.insert((
        Body,
        RestPosition(rest),
        Displacement(vectors()),
        DisplacementIncrement(vectors()),
        InternalForce(vectors()),
        ConstrainedAxes(vec![0; count]),
    ));
    if scene.integration.compensated && precision == Precision::F32 {
        entity.insert(DisplacementCompensation(Reals::zeros(precision, 6 * count)));
    }
    if scene.loads.iter().any(super::loads::has_weight) || !scene.systems.is_empty() || scene.has_tools_that_push() {
        entity.insert(ExternalForce(vectors()));
    }
    // pseudo-steps to rest do no work worth counting
    let moved = scene.constraints.iter().any(|constraint| matches!(constraint, Constraint::Prescribed { .. }));
    if !scene.is_static() && scene.output.energies_every.is_some() {
        entity.insert(Work(Reals::zeros(precision, WORK_NUMBERS * count)));
    } else if !scene.is_static() && !scene.guards.off.contains(&Guard::Energy) {
        entity.insert(InternalWork::zero(count));
    }
    let counts_work = entity.contains::<Work>() || entity.contains::<InternalWork>();
    if counts_work && moved && !scene.is_implicit() {
        entity.insert(PreviousPrescribedIncrement(vec![0.0; 3 * count]));
    }
    if let Solver::Implicit { scheme, .. } = &scene.solver
        && !scene.is_static()
    {
        if matches!(scheme, ImplicitScheme::GeneralizedAlpha { .. }) {
            entity.insert(Acceleration(vectors()));
        }
        if scene.output.energies_every.is_some() {
            entity.insert(SchemeLoss(Reals::zeros(precision, count)));
        }
    }
    entity.insert(FirstNonFinite(vec![u32::MAX; 2]));
    let mut used = scene.bodies[name].materials();
    let damped = used.any(|material| scene.materials[material].damping.is_some_and(|rate| rate != 0.0));
    let (mass, damping) = nodal_masses(&authoring.blocks, count, world);
    let mut entity = world.entity_mut(body);
    entity.insert(Mass(Reals::from_f64(precision, mass.into_iter())));
    // what relaxes is damped as it needs
    if damped && !scene.is_static() {
        entity.insert(DampingCoefficient(Reals::from_f64(precision, damping.into_iter())));
    }
}

/// Which elements of a block meet in each of a body's nodes.
pub(super) fn block_corners(kind: ElementKind, count: usize, connectivity: &[u32], nodes: usize) -> BlockCorners {
    let corners = node_count(kind);
    let node_of = |row: usize, corner: usize| connectivity[lane_place(row, corners, corner)] as usize;
    let mut starts = vec![0_u32; nodes + 1];
    let all = || (0..count).flat_map(|row| (0..corners).map(move |corner| (row, corner)));
    all().for_each(|(row, corner)| starts[node_of(row, corner) + 1] += 1);
    (0..nodes).for_each(|node| starts[node + 1] += starts[node]);
    let mut next = starts.clone();
    let mut elements = vec![0; starts[nodes] as usize];
    for (row, corner) in all() {
        let place = &mut next[node_of(row, corner)];
        elements[*place as usize] = row as u32;
        *place += 1;
    }
    BlockCorners { starts, elements }
}

/// Lumped mass (kg) and damping coefficient (kg/s) of every node, from the elements that still have volume.
pub fn nodal_masses(entities: &[Entity], count: usize, world: &World) -> (Vec<f64>, Vec<f64>) {
    let (mut mass, mut damping) = (vec![0.0; count], vec![0.0; count]);
    for &entity in entities {
        let parts = (world.get::<Block>(entity), world.get::<Connectivity>(entity), world.get::<RestShape>(entity));
        if let (Some(block), Some(connectivity), Some(shape)) = parts {
            let inertia = ElementInertia::of(world, entity);
            add_nodal_masses(block, connectivity, shape, inertia, &mut mass, &mut damping);
        }
    }
    (mass, damping)
}

/// What the stable step depends on, of the material of a block: of each copy where it differs, else one.
pub fn stiffnesses(world: &World, entity: Entity) -> Vec<Stiffness> {
    let Some(material) = world.get::<Block>(entity).map(|block| block.material) else { return Vec::new() };
    let inertia = ElementInertia::of(world, entity);
    if let Some(PerCopyLaw(copies)) = world.get(entity) {
        // with frames of edges each element has a law of its own, whatever its copy
        let mut densities = vec![f64::INFINITY; copies.of_copy.len()];
        (0..).zip(&*copies.copies).for_each(|(row, &law)| densities[law as usize] = inertia.of_row(row)[0]);
        return copies.of_copy.iter().zip(densities).map(|(law, density)| stiffness_of(law, density)).collect();
    }
    let Some(elastic) = ElasticLaw::of(world.entity(material)) else { return Vec::new() };
    let exponential = world.get::<ExponentialFibres>(material).map_or(Vec::new(), |all| all.0.clone());
    let fibres = world.get::<Fibres<f64>>(material).copied();
    let law = LawParameters { elastic, fibres, exponential, terms: Vec::new() };
    let copies = world.get::<PerCopyInertia>(entity).map_or(1, |own| own.of_copy.len());
    (0..copies).map(|copy| stiffness_of(&law, inertia.of_copy(copy)[0])).collect()
}

/// The copy of each element of a block, by its row, where copies differ in what [`stiffnesses`] depend on.
pub fn copies_of_elements(world: &World, entity: Entity) -> Option<&[u32]> {
    let of_law = world.get::<PerCopyLaw>(entity).map(|PerCopyLaw(law)| &*law.copies);
    of_law.or_else(|| world.get::<PerCopyInertia>(entity).map(|own| &*own.copies))
}

fn stiffness_of(law: &LawParameters<f64>, density: f64) -> Stiffness {
    let [shear, bulk] = law.elastic.small_strain_moduli();
    let families: f64 = law.exponential.iter().map(|family| family.small_strain_eta()).sum();
    Stiffness {
        // a negative λ only softens
        lambda: (bulk - 2.0 / 3.0 * shear).max(0.0),
        shear,
        eta: law.fibres.map_or(0.0, |fibres| fibres.eta) + families,
        density,
    }
}

/// The laws of a block's copies, where they differ, with what each remembers, where that does, for the clock's step.
pub(super) fn law_copies(world: &World, entity: Entity, clock: &Clock) -> Option<Arc<LawCopies<f64>>> {
    let PerCopyLaw(copies) = world.get(entity)?;
    let memories = world.get::<PerCopyMemory>(entity);
    Some(memories.map_or_else(|| Arc::clone(copies), |memories| Arc::new(copies.with_memories(&memories.0, clock))))
}

/// Gives every block its law, in f64 for looking at it and in the run's precision for its kernel, and its history.
pub fn insert_laws(precision: Precision, world: &mut World) {
    let clock = *world.resource::<Clock>();
    let entities: Vec<(Entity, Block)> =
        world.query::<(Entity, &Block)>().iter(world).map(|(entity, block)| (entity, block.clone())).collect();
    for (entity, block) in entities {
        let Some(elastic) = ElasticLaw::of(world.entity(block.material)) else { continue };
        let mut directions = block.fibre_directions.iter().copied();
        // the first direction is theirs only where there are such fibres
        let fibres = world.get::<Fibres<f64>>(block.material).copied();
        let fibres = fibres.and_then(|fibres| directions.next().map(|from| (fibres, from)));
        let families = world.get::<ExponentialFibres>(block.material).map_or(Vec::new(), |all| all.0.clone());
        let prony = world.get::<Prony>(block.material);
        let [terms, volumetric] = ElementMemory::of(world, block.material).terms(&clock);
        let copies = law_copies(world, entity, &clock);
        let law = BlockLaw {
            elastic,
            fibres,
            exponential: families.into_iter().zip(directions).collect(),
            prony: terms,
            volumetric,
            reproject: prony.is_some_and(|prony| prony.reproject),
            copies,
            own_kernels: world.get::<OwnKernels>(block.material).cloned(),
        };
        let memory = law.memory_numbers(point_count(block.kind)) * block.count.div_ceil(LANES) * LANES;
        let mut entity = world.entity_mut(entity);
        if precision == Precision::F32 {
            entity.insert(law.rounded::<f32>());
        }
        entity.insert(law);
        entity.remove::<ViscousMemory>();
        if memory > 0 {
            entity.insert(ViscousMemory(Reals::zeros(precision, memory)));
        }
    }
}

/// First half step of all nodes, from the bodies' velocity and spin; none along constrained axes, and none in a static
/// analysis.
pub(super) fn start(assembly: &Assembly<'_>, world: &mut World) {
    if assembly.scene.scene.is_static() {
        return;
    }
    let time_step = world.resource::<Clock>().time_step;
    for (name, parts) in &assembly.bodies {
        let body = &assembly.scene.scene.bodies[name];
        if body.velocity == DVec3::ZERO && body.spin == DVec3::ZERO {
            continue;
        }
        let mut query =
            world.query::<(&RestPosition, &Displacement, &Mass, &ConstrainedAxes, &mut DisplacementIncrement)>();
        let Ok((rest, u, mass, axes, mut step)) = query.get_mut(world, parts.entity) else { continue };
        let total: f64 = (0..rest.0.len()).map(|row| mass.get(row)).sum();
        // where they start, which need not be where they are at rest
        let place = |row: usize| rest.0[row] + u.vector(row);
        let center: DVec3 = (0..rest.0.len()).map(|row| place(row) * mass.get(row)).sum::<DVec3>() / total;
        for row in 0..rest.0.len() {
            let velocity = body.velocity + body.spin.cross(place(row) - center);
            let free = DVec3::from_array([0, 1, 2].map(|axis| f64::from(1 - (axes[row] >> axis & 1))));
            if mass.get(row) > 0.0 {
                step.set_vector(row, velocity * free * time_step);
            }
        }
    }
}
