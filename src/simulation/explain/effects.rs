//! What blocks and bodies have or lack, and what would give it to them.

use super::{Effect, Part, ScenePart};
use crate::backend::cpu::{BlockLaw, Cpu, PerCopyLaw, kernel_effects};
use crate::backend::user_law::LawCheck;
use crate::components::*;
use crate::elements::with_element;
use crate::materials::{CorotationalFrame, Elastic, ElasticLaw, ExponentialFibre, Fibres, UserLaw};
use crate::math::LANES;
use crate::scene::SceneFile;
use crate::scene::schema::{InitialState, Inversion, Scene};
use bevy_ecs::prelude::*;

/// The parts that a scene is made of, and what they bring.
pub(super) fn scene_parts(file: &SceneFile) -> Vec<ScenePart> {
    let brought = |part: &str| {
        let of_part = |name: &&String| name.strip_prefix(part).is_some_and(|rest| rest.starts_with('.'));
        file.scene.bodies.keys().chain(file.scene.tools.keys()).filter(of_part).cloned().collect()
    };
    let parts = file.parts().into_iter();
    parts.map(|(name, file)| ScenePart { name: name.into(), file: file.into(), brings: brought(name) }).collect()
}

/// All blocks, then all bodies.
pub fn parts(scene: &Scene, precision: Precision, on_gpu: bool, world: &mut World) -> Vec<Part> {
    let mut blocks: Vec<Part> = Vec::new();
    let mut query = world.query::<(EntityRef, &Block, &Label)>();
    for (entity, block, label) in query.iter(world) {
        let cpu_variant = (!on_gpu).then(|| cpu_variant(&entity, block, world));
        let (body, material) = (name(world, block.body), name(world, block.material));
        let size = format!("{} {:?} elements of {material} in {body}", block.count, block.kind);
        let effects = block_effects(&entity, block, &material, &body, world);
        blocks.push(Part { name: format!("block {}", label.0), size, effects, cpu_variant });
    }
    let mut bodies: Vec<Part> = Vec::new();
    let held: Vec<Entity> = world.query::<(&Grabs, &OfBody)>().iter(world).map(|(_, of)| of.0).collect();
    let mut query = world.query::<(EntityRef, &Authoring, &Label)>();
    for (entity, authoring, label) in query.iter(world) {
        let size = format!("{} nodes", authoring.node_rows.len());
        let effects = body_effects(&entity, precision, held.contains(&entity.id()), scene);
        bodies.push(Part { name: format!("body {}", label.0), size, effects, cpu_variant: None });
    }
    blocks.sort_by(|a, b| a.name.cmp(&b.name));
    bodies.sort_by(|a, b| a.name.cmp(&b.name));
    blocks.extend(bodies);
    blocks
}

fn name(world: &World, entity: Entity) -> String {
    world.get::<Label>(entity).map_or_else(String::new, |label| label.0.clone())
}

fn block_effects(entity: &EntityRef<'_>, block: &Block, material: &str, body: &str, world: &World) -> Vec<Effect> {
    let in_material = |word: &str| format!("`{word}` in the material {material}");
    let elastic = ElasticLaw::of(world.entity(block.material));
    let of_frames = world.entity(block.material).contains::<CorotationalFrame<f64>>();
    let fibres = world.get::<Fibres<f64>>(block.material);
    let families = world.get::<ExponentialFibres>(block.material);
    let prony = world.get::<Prony>(block.material);
    let damping = world.get::<Damping>(block.material);
    let stiffness_damping = world.get::<StiffnessDamping>(block.material);
    let at_rest = world.resource::<Clock>().relaxation.is_some();
    let mut effects = vec![
        Effect {
            name: elastic.map_or("elastic law", |law| law.name()),
            on: elastic.map(|law| {
                let [shear, bulk] = law.small_strain_moduli().map(short);
                format!("shear modulus {shear} Pa, bulk modulus {bulk} Pa{}", trial(block.material, world))
            }),
            turned_on_by: format!("an elastic law in the material {material}"),
        },
        Effect {
            name: "parameters per copy",
            on: copies(entity, of_frames),
            turned_on_by: format!("`per_copy` in the body {body}"),
        },
        Effect {
            name: "frames of edges",
            on: of_frames.then(|| "the law turns with two edges of each element; no energy is balanced".into()),
            turned_on_by: format!("`rotation: Frame` of `corotational` in the material {material}"),
        },
        Effect {
            name: "averaged nodal pressure",
            on: entity.contains::<NodalVolumeChange>().then(|| "pressures are means around nodes".into()),
            turned_on_by: format!("elements Tet4NodalPressure in the mesh of {body}"),
        },
        Effect {
            name: "fibres",
            on: fibres.map(|f| {
                let course = if f.tension_only > 0.0 { "they only pull" } else { "they pull and push" };
                format!("η = {} Pa, {course}", short(f.eta))
            }),
            turned_on_by: in_material("fibres"),
        },
        Effect {
            name: "exponential fibres",
            on: families.map(|all| {
                let family = |f: &ExponentialFibre<f64>| format!("k₁ = {} Pa, k₂ = {}", short(f.k1), short(f.k2));
                let each: Vec<String> = all.0.iter().map(family).collect();
                let count = if each.len() == 1 { "1 family".into() } else { format!("{} families", each.len()) };
                format!("{count}: {}", each.join("; "))
            }),
            turned_on_by: in_material("exponential_fibres"),
        },
        Effect {
            name: "viscosity",
            on: prony.map(|prony| viscosity(prony, at_rest)),
            turned_on_by: in_material("prony"),
        },
        Effect {
            name: "damping",
            on: damping.filter(|_| !at_rest).map(|damping| format!("{} 1/s, proportional to mass", damping.0)),
            turned_on_by: match at_rest {
                true => "a transient analysis".into(),
                false => in_material("damping"),
            },
        },
        Effect {
            name: "stiffness damping",
            on: stiffness_damping.filter(|_| !at_rest).map(|time| format!("β = {} s", time.0)),
            turned_on_by: match at_rest {
                true => "a transient analysis".into(),
                false => in_material("stiffness_damping"),
            },
        },
        Effect {
            name: "removal",
            on: entity.contains::<Alive>().then(|| "elements of the body may be removed".into()),
            turned_on_by: format!("an entry under `removal` on the body {body}"),
        },
    ];
    match entity.get::<OnInversion>() {
        None | Some(OnInversion(Inversion::Stop)) => {}
        Some(OnInversion(policy)) => effects.push(Effect {
            name: "inversion",
            on: Some(match policy {
                Inversion::Remove => "elements turned inside out are removed at once".into(),
                _ => "elements turned inside out are pushed back by the law".into(),
            }),
            turned_on_by: in_material("inversion"),
        }),
    }
    if fibres.is_some() || families.is_some() {
        let varying = Effect {
            name: "directions",
            on: entity.contains::<FibreDirection>().then(|| "one an element".into()),
            turned_on_by: "`direction: Around(...)` or `Field(...)` of the fibres; now one for the whole block".into(),
        };
        effects.insert(2, varying);
    }
    effects
}

/// What was found of a law of the user's own when it was tried.
fn trial(material: Entity, world: &World) -> String {
    let Some(found) = world.get::<LawCheck>(material) else { return String::new() };
    let finite = match found.finite_up_to {
        None => format!("finite in all {} deformations tried", found.tried),
        Some(size) => format!("finite for ∇u below {size}"),
    };
    let (name, cost) = match world.get::<UserLaw<f64>>(material) {
        Some(law) => {
            let (instructions, _, slots) = law.parts().isochoric.size();
            let cost = match slots {
                0 => format!("; {instructions} products and sums on the CPU"),
                _ => format!("; {instructions} instructions over {slots} registers on the CPU"),
            };
            (law.parts().path.as_str(), cost)
        }
        // an energy that is that of a law built in
        None => ("from its energy", String::new()),
    };
    format!(
        " ({name}: stress is dΨ/dE within {:.0e}, in f32 within {:.0e} at strains of 1e-4, energy within {:.0e}; \
         {finite}{cost})",
        found.derivative_error, found.single_precision_error, found.single_precision_energy_error,
    )
}

/// In what the copies of a block differ, from where to where.
fn copies(entity: &EntityRef<'_>, of_frames: bool) -> Option<String> {
    fn ends(what: &str, unit: &str, numbers: impl Iterator<Item = f64>) -> String {
        let ends = numbers.fold((f64::INFINITY, 0.0_f64), |(low, high), number| (low.min(number), high.max(number)));
        format!("{what} from {} to {} {unit}", short(ends.0), short(ends.1))
    }
    // with frames each element has a law of its own
    let law = entity.get::<PerCopyLaw>().filter(|_| !of_frames);
    let inertia = entity.get::<PerCopyInertia>();
    let moduli = law.map(|PerCopyLaw(law)| {
        ends("shear moduli", "Pa", law.of_copy.iter().map(|of_copy| of_copy.elastic.small_strain_moduli()[0]))
    });
    let densities = inertia.map(|own| ends("densities", "kg/m³", own.of_copy.iter().map(|[density, _]| *density)));
    let memory = entity.get::<PerCopyMemory>().map(|_| "viscosity of their own".to_string());
    let count = law.map(|PerCopyLaw(law)| law.of_copy.len()).or(inertia.map(|own| own.of_copy.len()))?;
    let parts: Vec<String> = [moduli, memory, densities].into_iter().flatten().collect();
    Some(format!("{count} copies, {}", parts.join(", ")))
}

fn viscosity(prony: &Prony, at_rest: bool) -> String {
    let counts = [(&prony.terms, "Prony term"), (&prony.volumetric, "Prony term of the pressure")];
    let counts = counts.iter().filter(|(terms, _)| !terms.is_empty()).map(|(terms, word)| match terms.len() {
        1 => format!("1 {word}"),
        count => format!("{count} {}", word.replace("term", "terms")),
    });
    let reproject = if prony.reproject { ", re-projected" } else { "" };
    let counts = counts.collect::<Vec<_>>().join(" and ");
    match at_rest {
        true => format!("{counts}, of which the long term remains{reproject}"),
        false => format!("{counts}, {:?} integrator{reproject}", prony.integrator),
    }
}

fn body_effects(entity: &EntityRef<'_>, precision: Precision, can_be_held: bool, scene: &Scene) -> Vec<Effect> {
    let loads = match (scene.loads.len() + scene.systems.len(), can_be_held) {
        (0, true) => "those of what a program grabs".into(),
        (count, true) => format!("{}, and those of what a program grabs", many(count, "load")),
        (count, false) => many(count, "load"),
    };
    let compensated = match precision {
        Precision::F32 => "`compensated: true` under `integration`",
        Precision::F64 => "`compensated: true` under `integration`, in f32 only",
    };
    let accumulated = scene
        .output
        .energies_every
        .map_or_else(|| "energies are asked for".into(), |every| format!("a row in every {every} s"));
    vec![
        Effect {
            name: "external forces",
            on: entity.contains::<ExternalForce>().then_some(loads),
            turned_on_by: "an entry under `loads` or `systems`, `grabs` in the program's options".into(),
        },
        Effect {
            name: "damping",
            on: entity.contains::<DampingCoefficient>().then(|| "a material of the body is damped".into()),
            turned_on_by: "`damping` in a material of the body".into(),
        },
        Effect {
            name: "relaxation",
            on: entity.contains::<InertialMass>().then(|| "to rest, with masses and damping chosen for it".into()),
            turned_on_by: "`analysis: Static()`".into(),
        },
        Effect {
            name: "equilibrium at the start",
            on: (scene.start != InitialState::Undeformed && !scene.is_static())
                .then(|| "a static analysis brings it to rest before the first step".into()),
            turned_on_by: "`start: Equilibrium()`".into(),
        },
        Effect {
            name: "compensated sum",
            on: entity.contains::<DisplacementCompensation>().then(|| "keeps what rounding leaves out".into()),
            turned_on_by: compensated.into(),
        },
        Effect {
            name: "accumulated work",
            on: entity.contains::<Work>().then_some(accumulated),
            turned_on_by: "`energies_every` under `output`".into(),
        },
    ]
}

/// Which of the compiled kernels a block runs on the CPU.
fn cpu_variant(entity: &EntityRef<'_>, block: &Block, world: &World) -> String {
    let law = ElasticLaw::of(world.entity(block.material)).map_or("no law", |law| law.name());
    let rounded = entity.get::<BlockLaw<f32>>();
    let cpu = world.resource::<Cpu>();
    let has_own_kernels =
        cpu.has_vectors() && entity.get::<BlockLaw<f64>>().is_some_and(|law| law.own_kernels.is_some());
    let variant = match rounded.and_then(|law| with_element!(block.kind, E => kernel_effects::<E>(cpu, law))) {
        _ if has_own_kernels => "compiled for it".into(),
        Some(effects) => {
            let [fibres, viscosity] = effects.map(|is| if is { "with" } else { "without" });
            format!("{fibres} fibres, {viscosity} viscosity")
        }
        None => "which asks for each effect".into(),
    };
    let lanes = if rounded.is_some() { "f32" } else { "f64" };
    format!("{:?} in {lanes}, groups of {LANES}, of {law}, {variant}", block.kind)
}

/// Six digits are enough to recognise a parameter that was computed from others.
fn short(value: f64) -> f64 {
    format!("{value:.5e}").parse().unwrap_or(value)
}

fn many(count: usize, word: &str) -> String {
    format!("{count} {word}{}", if count == 1 { "" } else { "s" })
}
