//! The cases, by what they are about.

mod bending;
mod cells;
mod compression;
mod contact;
mod fibres;
mod impact;
mod input;
mod inversion;
mod long_runs;
mod mixed;
mod point;
mod removal;
mod shocks;
mod step;
mod viscosity;

use super::implicit::{
    FINE, FRAMES, IMPACT, KEEPING, KINEMATIC, MEETING, NEWTON, ON_HOST, PRESSED, SHORT, SLIDING, STABLE_STEP, STIFFEST,
    SUCTION, TOO_FAST, TOUCHING, TURNING,
};
use super::{Case, CaseConfiguration, Slow};
use contact::{free, friction, holding, indentation, patch, rest, shapes, springs, start, taking, waves};

/// A case: its number and name make the path of its scene.
macro_rules! case {
    ($id:literal $name:literal $title:literal, $passes:literal, $on:expr, $run:path, $implicitly:expr) => {
        case!($id $name $title, $passes, $on, $run, $implicitly, Slow::NOTHING)
    };
    ($id:literal $name:literal $title:literal, $passes:literal, $on:expr, $run:path, $implicitly:expr, $slow:expr) => {
        Case {
            id: $id,
            name: $name,
            title: $title,
            passes_when: $passes,
            scene: include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/hard/", $id, "_", $name, ".ron")),
            on: $on,
            implicitly: $implicitly,
            slow: $slow,
            run: $run,
        }
    };
}

/// Every configuration.
fn every(_: &CaseConfiguration) -> bool {
    true
}

/// What concerns one-point hexahedra alone.
fn one_point(configuration: &CaseConfiguration) -> bool {
    configuration.elements == sinew::mesh::ElementKind::Hex8
}

/// Hexahedra: tetrahedra lock or bend too stiffly for what is asked of the force.
fn hexahedra(configuration: &CaseConfiguration) -> bool {
    !configuration.is_tets()
}

/// What is decided before elements and machines matter.
fn once(configuration: &CaseConfiguration) -> bool {
    one_point(configuration) && configuration.is_f64()
}

/// All cases.
pub const CASES: &[Case] = &[
    case!("h01" "squeezed_cube" "cube squeezed by 30 %, ν .49, .499, .4999",
        "step as the root of the bulk modulus within 5 %; force of a finer mesh within 5 % (elements that do not lock); no checkerboard",
        every, compression::squeezed_cube, SHORT),
    case!("h02" "corner_load" "corner load on one-point hexahedra",
        "hourglass energy below 10 %; coefficient 0 is warned of; the default does not stiffen S1",
        one_point, bending::corner_load, NEWTON),
    case!("h03" "sliver" "one sliver: h/1000, h/1e6, flat, negative volume",
        "runs with a smaller step; warns with the worst elements; refused with their numbers", every, step::sliver, STABLE_STEP),
    case!("h04" "sizes" "element sizes 1:1000",
        "the small element is named, with what it costs", every, step::sizes, STABLE_STEP),
    case!("h05" "release" "release from 100 % stretch, 20 periods (everyday: 5)",
        "energy within 1 % (f64), 2 % (f32); J > .1", every, inversion::release, KEEPING),
    case!("h06" "twist" "twist by 180, 360 and 720° and back",
        "V/V₀ in [.97, 1.03]; back within 1e-3", every, bending::twist, FRAMES),
    case!("h07" "crushed_cube" "95 % compression, confined and free",
        "the formula for a point within 1 %; back within 1e-3", every, compression::crushed_cube, SHORT),
    case!("h08" "through" "node driven through the opposite face and back",
        "stopped with the element's number, or back within 1e-3: no false rest", every, inversion::through, SHORT),
    case!("h09" "scrambled" "scrambled start",
        "refused with an element's number, or back within 1e-3", every, inversion::deformed_start, FRAMES),
    case!("h10" "flattened" "flattened start",
        "refused with an element's number, or back within 1e-3", every, inversion::deformed_start, FRAMES),
    case!("h11" "stiffness_contrast" "stiffness contrast of 1e4 in one bar",
        "the joint moves as two springs in series within 1 %", every, bending::stiffness_contrast, NEWTON),
    case!("h12" "stiff_fibres" "fibres a thousand times stiffer than the rest",
        "one element at 1.02 within 1e-3; the step accounts for fibres", every, fibres::stiff_fibres, NEWTON),
    case!("h13" "squeezed_fibres" "fibres compressed to half",
        "the formula for a point within 1e-4", every, fibres::squeezed_fibres, FRAMES),
    case!("h14" "fast_viscosity" "relaxation in a hundredth of the step",
        "long-term modulus within 1 % in five steps", every, viscosity::fast, FINE),
    case!("h15" "slow_viscosity" "relaxation in 1e6 s, of 99 %",
        "instantaneous modulus within 1e-4", every, viscosity::slow, FINE),
    case!("h16" "no_viscosity" "viscosity of weight 0; of 1; of more; of no time",
        "0: the same bits as without; the others are refused", every, viscosity::none, FRAMES),
    case!("h17" "islands" "elements removed until an island falls off",
        "mass to 1e-6; the island falls with g; nodes without elements are inactive", every, removal::islands, SHORT),
    case!("h18" "all_removed" "all elements removed",
        "mass to 1e-6; nodes are inactive; the run ends well", every, removal::everything, SHORT),
    case!("h19" "sudden_load" "sudden 100 g",
        "energy balanced to the end, or an honest stop", every, shocks::sudden_load, SHORT),
    case!("h20" "denormals" "motion damped down into denormal numbers",
        "a step there costs less than 1.5 times one at the start (timed in full only)", every, long_runs::denormals, FRAMES),
    case!("h21" "long_run" "1e7 steps of one element (everyday: 1e5)",
        "t = n·Δt exactly; frequency within 1e-3; energy within .1 % (f64), 1 % (f32)", every, long_runs::long_run, KEEPING),
    case!("h22" "spin" "spinning free cube, 10 turns (in full: 1000)",
        "angular momentum to 1e-10 (f64), 1e-5 (f32)", every, long_runs::spin, TURNING),
    case!("h23" "far_away" "mesh 1e4 m from the origin",
        "the same result within 1e-5", every, long_runs::far_away, SHORT),
    case!("h24" "jump" "prescribed jump of 10 %, of 100 %",
        "10 %: work counted; 100 %: an honest stop that says \"use a ramp\"", every, shocks::jump, SHORT),
    case!("h25" "thin_slab" "slab one element thick",
        "sag of three layers within 15 %; the share of hourglass energy tells", one_point, bending::thin_slab, NEWTON),
    case!("h26" "impact" "impact at 10 and 50 m/s, penalty ×1, ×10, ×100",
        "energy at most 1 % above that at the start; the step accounts for the penalty; depth reported", every, impact::impact, IMPACT),
    case!("h27" "not_a_number" "NaN in a mesh, a material, a custom system's write",
        "refused by name, or found within a few steps with the first node", every, input::not_a_number, ON_HOST),
    case!("h28" "bad_numbers" "numbers that cannot be",
        "each refused with its own message", once, input::bad_numbers, FRAMES),
    case!("h29" "beyond" "Δt = .99, 1.01, 1.1, 2 of the true limit (everyday: 5000 steps)",
        ".99 runs 1e5 steps; the others are refused, or stopped where insisted on", every, step::beyond, STABLE_STEP),
    case!("h30" "shrinking_step" "the stable step shrinks during the run",
        "the step adapts, or the run warns or stops", every, step::shrinks, STABLE_STEP),
    case!("h31" "mixed_patch" "hexahedra and tetrahedra in one body",
        "patch test to 1e-6 (f64), 1e-4 (f32)", every, mixed::mixed_patch, NEWTON),
    case!("h32" "mass_scaling" "mass scaling",
        "added mass reported, above 5 % warned of; energy balanced", every, step::mass_scaling, STABLE_STEP),
    case!("h33" "nothing_loaded" "nothing loaded for 1e5 steps (everyday: 1e4)",
        "no displacement above 1e-7 of the length", every, long_runs::nothing_loaded, FRAMES),
    case!("h34" "zero_weights" "effects of weight zero against absent ones",
        "the same bits (in full: the step time within 3 %)", every, fibres::zero_weights, FRAMES),
    case!("h35" "buckling" "slender column buckling",
        "deflection of a finer mesh within 3 %", every, bending::buckling, SHORT),
    case!("h36" "indented_block" "ball pressed into a block (Hertz)",
        "force within 6 % of the linear one with four faces on the radius of contact, 15 % with two", hexahedra, indentation::block, PRESSED),
    case!("h37" "indented_layer" "ball pressed into a layer as thick as its radius",
        "force within 8 % of the linear one", hexahedra, indentation::layer, PRESSED),
    case!("h38" "pressed_ball" "elastic ball between two plates",
        "force within 8 % of the linear one", hexahedra, indentation::ball, PRESSED),
    case!("h39" "two_bars" "bar that meets an equal one end on",
        "2L/c within -1 and +2 %, ρcAv/2 within 1.5 %, velocities exchanged within 2 %", every, waves::two_bars, MEETING),
    case!("h40" "bar_on_plane" "bar that meets a plane end on",
        "2L/c within -1 and +3 %, ρcAv within 1.5 %, rebound within 3 %", every, waves::bar_on_plane, MEETING),
    case!("h41" "slope" "block on a slope, below and beyond the angle of friction",
        "sticks to 1e-8 m; slides as a rigid block within 1 % and its lean", every, friction::slope, SLIDING),
    case!("h42" "slide_to_rest" "block that slides to rest", "v²/(2μg) within 3 %", every, friction::slide_to_rest, SLIDING),
    case!("h43" "direction_of_friction" "block drawn in any direction", "against the slip within .5°", every, friction::direction, SLIDING),
    case!("h44" "drop" "cube dropped on a table",
        "arrives within two steps, loses half to all of its half layer, impulse is momentum", every, waves::drop, KINEMATIC),
    case!("h45" "rest" "cube at rest on a table", "weight within 1e-4, 1e-7 m/s, no node inside", every, rest::rests, TOUCHING),
    case!("h46" "stack" "cube on a cube on a table", "m g and 2 m g within 1e-3, creeps by less than 1e-7 m", every, rest::stack, TOUCHING),
    case!("h47" "contact_patch" "pressure across cells that do not match", "stress within 6 %", every, patch::contact_patch, TOUCHING),
    case!("h48" "punch" "plate pressed on a block", "uniform stress to 1e-6 (f64)", every, rest::punch, PRESSED),
    case!("h49" "ironing" "ball drawn over ten faces", "nodes held by μ within 1 %, ripple at most 20 %", one_point, friction::ironing, SLIDING, Slow::IN_SOFTWARE),
    case!("h50" "oblique" "oblique collision of two free cubes",
        "momentum to 1e-10 (f64), its moment to 1e-6, no energy made", every, free::oblique, MEETING),
    case!("h51" "restitution" "nodes that hit a plate, by the kinematic law and by springs",
        "stopped in two steps; given back within .5 %, damped within .02 of the closed form", hexahedra, springs::restitution_of_nodes, KINEMATIC),
    case!("h52" "penalty" "springs as stiff as the step allows, and stiffer",
        "stands for 1e5 steps (everyday: 5000) with its weight within 1 %; the stiffer one is refused", every, springs::stiffest, STIFFEST),
    case!("h54" "tunnelling" "needle of up to five radii a step against one layer",
        "stopped, warned of or refused: never through in silence", every, start::tunnelling, TOO_FAST),
    case!("h55" "overlap" "overlaps of .05, .3, .6 of an edge; a body inside another",
        "small ones settle with no more energy than a wave brings, deep ones are refused", every, start::overlap, SLIDING),
    case!("h56" "bad_surface" "tool mesh with a face without area, a sliver, a face twice, a hole, an edge of three faces",
        "presses as a whole one, or is refused by name", every, start::bad_surface, SLIDING),
    case!("h57" "sharp_edges" "edge across an edge, corner on an edge",
        "weight within 1e-3, a tenth of an edge deep at most", every, shapes::edges, SLIDING),
    case!("h58" "wound_columns" "two columns wound round each other", "none is in the other; volume within 3 %", every, shapes::wound, SLIDING, Slow::BOTH),
    case!("h59" "pile" "pile of 12 cubes (in full 1000)", "weight within 1 %, energy falls, the same bits", every, shapes::pile, SLIDING, Slow::BOTH),
    case!("h61" "grasp" "cube that is grasped, lifted, carried and let go",
        "weight within 1e-4; closing makes no energy, opening no momentum", every, holding::grasp, SLIDING),
    case!("h62" "suture" "thread and glue that are drawn until they tear",
        "bear their strength within 2 %; energy booked within 2 %", every, holding::suture, SLIDING),
    case!("h63" "suction" "plate that hangs on a tube that sucks",
        "Δp π r² within 3 %; comes off beyond that", every, taking::suction, SUCTION),
    case!("h64" "removal_by_tool" "tool that takes a volume a second from three meshes",
        "the integral of its rate to one element; edges even", every, taking::removal, SLIDING),
    case!("h68" "three_forces" "force on a tool by three ways", "equal to 1e-9 in motion (f64), 1e-3 at rest", every, rest::three_forces, SLIDING),
    case!("h69" "contact_far_away" "contact 1e4 m from the origin", "forces within 1e-3", every, rest::far_away, SLIDING),
    case!("h70" "bouncing" "ball that bounces in a box for 20 000 steps (in full a million)",
        "energy and what was lost within 1e-3 (f64), 1e-2 (f32)", every, free::bouncing, MEETING),
];
