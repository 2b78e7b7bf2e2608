//! `tool_contact`: rigid tools keep nodes outside. `shaders/tool_contact.wgsl` is its twin.

mod device;
pub(super) mod direction;
mod in_step;
mod row;
mod solved;
mod stage;
pub(super) mod sweep;

use super::node_system::NodeSystem;
use super::node_views::{Before, ForceSlopes, NodesAtRest};
use super::places_within;
use super::rows::Rows;
use super::system::{Phase, System};
use crate::backend::cpu::{Cpu, Foreseen, NodeColumns};
use crate::components::*;
use crate::math::{Extremes, See, SimdScalar};
use direction::direction;
use glam::DVec3;
pub use in_step::ContactStep;
use in_step::ToolInStep;
use smallvec::SmallVec;
pub(crate) use solved::{count_work as count_tool_work, find as find_tool_springs};
pub(super) use stage::{ToolNodes, stage as tool_stage};
use std::ops::Range;

/// The explicit Lagrange correction of the predicted step: each node's next step d* is predicted as `integrate` will
/// find it, and where it would end inside a tool, the force is found that makes it end on the surface. That force is a
/// load like others, so that `integrate`, the balance of energy and the residual of a static analysis need not know of
/// tools. A node and a rigid tool are one equation: it is solved exactly, for any mass and step, and leaves the stable
/// step as it is. It goes along the normal where the node is before the step and the force acts, so that it does no
/// work on what slides along a curved surface. The touching node stops: what it loses is an impact's plastic part, half
/// a layer's kinetic energy.
///
/// Friction holds the node at the tool's surface with at most μ times this step's normal force; who does not slide
/// moves with the tool exactly. Nodes between several tools take turns, until their forces fit.
pub fn system() -> System {
    System::built_in_nodes::<ToolContacts>(
        "tool_contact",
        Phase::Contact,
        "keeps nodes out of rigid tools",
        "`Tool(...)` under `contacts`",
        |world| {
            let count: usize = world.query::<&ToolContacts>().iter(world).map(|contacts| contacts.tools.len()).sum();
            (count > 0).then(|| if count == 1 { "1 tool at a body".into() } else { format!("{count} tools at bodies") })
        },
    )
    .on_nodes(device::stages)
}

/// What a tool and a node do that touch.
const STICKS: f64 = 1.0;
const SLIDES: f64 = 2.0;

/// Where [`ToolTouch`] has how fast a tool went.
const SPEED: usize = 7;

/// A point slips by no more than this in a step that is still, in edges.
pub(in crate::systems) const STILL: f64 = 1e-6;

/// How often tools at one node take turns.
const TURNS: usize = 12;

/// A tool at a node.
#[derive(Clone, Copy, Default)]
struct Touch {
    tool: usize,
    /// Outward normals where the node begins and where it ends, and how far from where it may be it ends there (m).
    start: DVec3,
    normal: DVec3,
    gap: f64,
    /// Along which it is pushed; friction is across.
    direction: DVec3,
    /// Where it may be: the distance from the surface (m), 0 but for nodes that are inside already.
    target: f64,
    /// How far the tool goes there (m).
    tool_step: DVec3,
    /// What holds it: the largest tangential part of the normal one.
    friction: f64,
    /// Displacements that the tool adds (m): outwards, how far that is, and along the surface.
    outwards: DVec3,
    push: f64,
    tangential: DVec3,
    /// Whether friction does not hold it.
    slides: bool,
    /// Whether a spring pushes: by where the node is, and not by where it would end.
    springs: bool,
    /// Where its way first meets the tool, of a node that could be through it where it ends.
    plane: Option<sweep::Plane>,
}

impl Touch {
    /// How far the tool went there in the last step (m), by the numbers that are kept of it at a node that it touched
    /// then. Its force works along the mean of that step and this one, as it does on the node: else what pushes harder
    /// and harder while it slows down would lose less than nothing. A tool that has only come to touch is taken to go
    /// evenly; so is any along axes that are told, where what is written as the node's step before (m) is the next one.
    fn tool_before<T: SimdScalar>(
        &self,
        step: &ContactStep,
        kept: Option<&[T]>,
        (before, free): (DVec3, DVec3),
    ) -> DVec3 {
        let Some(kept) = kept else { return self.tool_step };
        DVec3::from_array([0, 1, 2].map(|i| {
            let is_told = free[i] == 0.0 && before[i] != 0.0;
            if is_told { self.tool_step[i] } else { kept[SPEED + i].to_f64() / step.coefficients.rate }
        }))
    }
}

/// Those that touch a node: there is room for all, and nothing is written where there is none.
type Touching = SmallVec<[Touch; ToolContacts::MOST]>;

impl NodeSystem for ToolContacts {
    type Columns = (
        (&'static Mass, Option<&'static InertialMass>, Option<&'static DampingCoefficient>),
        (&'static InternalForce, &'static ConstrainedAxes, &'static Displacement, &'static DisplacementIncrement),
        Option<&'static DisplacementCompensation>,
        (&'static mut ExternalForce, &'static mut ToolTouch),
        Option<(&'static ContactForce, &'static mut SurfaceTouch)>,
    );
    type Prepared = ContactStep;

    fn rows(&self) -> Rows<'_> {
        Rows::List(&self.rows)
    }

    fn prepare(&self, before: &Before<'_>) -> ContactStep {
        self.in_step(before.clock, before.signals)
    }

    /// None: it corrects the step to come and no more, so that the stable step stays (docs/contact.md).
    fn slopes(&self, _: &NodesAtRest<'_>) -> ForceSlopes {
        ForceSlopes::NONE
    }

    fn act<T: SimdScalar>(&self, step: &ContactStep, cpu: &Cpu, nodes: &mut NodeColumns<'_, T>) {
        let Some(touches) = nodes.touches.take() else { return };
        let own = places_within(&self.rows, nodes.first, nodes.rows());
        let mut values = touches.values.chunks_exact_mut(touches.numbers.max(1));
        let mut from = own.start;
        while from < own.end {
            let to = own.end.min((from / Self::TOGETHER + 1) * Self::TOGETHER);
            // most nodes are far from all tools, and were: nothing is read or written there but that
            let are_near = step.springs.is_none() && self.are_near(step, from..to, cpu, nodes);
            for (place, values) in (from..to).zip(&mut values) {
                let (row, mask) = (self.rows[place] as usize - nodes.first, self.masks[place] & self.all());
                match &step.springs {
                    Some(springs) if springs.forces.are_noted() => {
                        self.press((step, springs), (row, mask), nodes, values);
                    }
                    // the solver finds them apart
                    Some(_) => {}
                    None if are_near => {
                        let place = nodes.rest[row] - self.reference + nodes.exact_displacement(row);
                        let near = step.near(mask, place);
                        if near != 0 || self.is_touched(values) {
                            self.touch(step, (row, near, place), nodes, values);
                        }
                    }
                    None if self.is_touched(values) => self.touch(step, (row, 0, DVec3::ZERO), nodes, values),
                    None => {}
                }
            }
            from = to;
        }
        nodes.touches = Some(touches);
    }
}

impl ToolContacts {
    /// Whether a tool may be near some of these nodes, by their places in the list: by what all lie within at rest, and
    /// what the displacements of all rows from the first to the last do.
    fn are_near<T: SimdScalar>(
        &self,
        step: &ContactStep,
        places: Range<usize>,
        cpu: &Cpu,
        nodes: &NodeColumns<'_, T>,
    ) -> bool {
        let (rows, first) = (&self.rows[places.clone()], nodes.first);
        let (Some(from), Some(to)) = (rows.first(), rows.last()) else { return false };
        let Some([low, high]) = self.boxes.get(places.start / Self::TOGETHER) else { return true };
        let mut seen = Extremes::none();
        let now = &nodes.displacements()[3 * (*from as usize - first)..3 * (*to as usize + 1 - first)];
        cpu.dispatch(See { seen: &mut seen, now, then: None });
        let [least, largest] = seen.bounds();
        step.meets([*low + least, *high + largest])
    }

    /// Whether tools touched a node in the last step, by its numbers.
    #[inline(always)]
    fn is_touched<T: SimdScalar>(&self, values: &[T]) -> bool {
        let numbers = self.numbers_a_tool();
        let (mut state, mut touched) = (3, false);
        while let Some(&of_tool) = values.get(state) {
            touched |= of_tool != T::default();
            state += numbers;
        }
        touched
    }

    /// What tools, those near as bits, do to one node at a place (m, from the reference).
    fn touch<T: SimdScalar>(
        &self,
        step: &ContactStep,
        (row, near, place): (usize, u32, DVec3),
        nodes: &mut NodeColumns<'_, T>,
        values: &mut [T],
    ) {
        let (mut stuck, mut slid) = (0_u32, 0_u32);
        for (tool, of_tool) in values.chunks_exact_mut(self.numbers_a_tool()).enumerate() {
            stuck |= u32::from(of_tool[3] == T::from_f64(STICKS)) << tool;
            slid |= u32::from(of_tool[3] == T::from_f64(SLIDES)) << tool;
            of_tool[..4].fill(T::default());
        }
        if nodes.inertia()[row] <= T::default() || near == 0 {
            return;
        }
        let Foreseen { before, step: predicted, free, to_force } = nodes.foresee(&step.coefficients, row);
        let at = (place, before, predicted);
        let was = |tool: usize| [stuck, slid].map(|bits| bits >> tool & 1 == 1);
        let (mut one, mut several);
        let all = if near.is_power_of_two() {
            let tool = near.trailing_zeros() as usize;
            one = self.predict(step, tool, at, was(tool));
            one.as_mut_slice()
        } else {
            several = Touching::new();
            let near = (0..self.tools.len()).filter(|tool| near >> tool & 1 == 1);
            several.extend(near.filter_map(|tool| self.predict(step, tool, at, was(tool))));
            &mut several[..]
        };
        let pushed = self.push_apart(step, all, (place, predicted), free);
        let (d, work_factor) = (predicted + pushed, step.coefficients.work_factor);
        if step.counts_work && pushed != DVec3::ZERO {
            nodes.note_farther(row, pushed, work_factor);
        }
        let mut sum = DVec3::ZERO;
        for touch in all.iter().filter(|touch| touch.push > 0.0) {
            let change = touch.outwards + touch.tangential;
            let force = to_force * change;
            sum += force;
            let numbers = self.numbers_a_tool();
            let of_tool = &mut values[numbers * touch.tool..numbers * (touch.tool + 1)];
            let slip = along_surface(d - touch.tool_step, touch.direction).length();
            let touched = was(touch.tool).contains(&true);
            for i in 0..3 {
                of_tool[i] = T::from_f64(force[i]);
            }
            for (i, felt) in of_tool[TOUCH_NUMBERS..].iter_mut().enumerate() {
                *felt += T::from_f64(force[i]);
            }
            of_tool[3] = T::from_f64(if touch.slides { SLIDES } else { STICKS });
            if step.counts_work {
                let tool_before = touch.tool_before(step, touched.then_some(&*of_tool), (before, free));
                let work = work_factor * force.dot(0.5 * (tool_before + touch.tool_step));
                // along axes that are moved as told, too: who moves them does as much less
                let on_node = work_factor * force.dot(0.5 * (before + d));
                of_tool[4] += T::from_f64(slip);
                of_tool[5] += T::from_f64(work);
                of_tool[6] += T::from_f64(work - on_node);
                for (i, speed) in of_tool[SPEED..TOUCH_NUMBERS].iter_mut().enumerate() {
                    *speed = T::from_f64(touch.tool_step[i] * step.coefficients.rate);
                }
            }
        }
        if !all.is_empty() {
            nodes.add_load(row, sum);
        }
    }

    /// What a tool does to a node that is at a place (m, from the reference), came there by a step (m) and goes on by
    /// another; `None` where it ends an edge or more from the tool. What stuck at it in the last step is held by the
    /// static coefficient, and what was not at it and does not slip along it.
    fn predict(
        &self,
        step: &ContactStep,
        tool: usize,
        (place, before, predicted): (DVec3, DVec3, DVec3),
        [stuck, slid]: [bool; 2],
    ) -> Option<Touch> {
        let contact = &self.tools[tool];
        let ToolInStep { pose, earlier, change, .. } = &step.tools[tool];
        let end = place + predicted;
        let of_tool = pose.inverse(end);
        let here = earlier.inverse(place);
        let plane = sweep::first_touch(&contact.geometry, contact.swept, [here, of_tool]);
        let (distance, normal) = sweep::surface(plane, &contact.geometry, of_tool);
        if distance > self.edge {
            return None;
        }
        let (now, start) = contact.geometry.distance(here);
        let start = earlier.rotation * start;
        let friction = |normal: DVec3, tool_step: DVec3| {
            let still = || along_surface(before - tool_step, normal).length() <= STILL * self.edge;
            let is_held = stuck || !slid && contact.friction[0] != contact.friction[1] && still();
            contact.friction[usize::from(!is_held)]
        };
        if let Some(spring) = contact.spring {
            let tool_step = change.place(here);
            let gap = step.coefficients.work_factor * spring.gap(now, start.dot(before - tool_step));
            let friction = friction(start, tool_step);
            let still = Touch { tool, start, normal: start, gap, tool_step, friction, ..Touch::default() };
            return (gap < 0.0).then_some(Touch { slides: true, springs: true, ..still });
        }
        let mut target = 0.0;
        if distance < 0.0 {
            // who is inside already comes out by and by
            target = (now + step.out).min(0.0);
        }
        let (normal, tool_step) = (pose.rotation * normal, change.place(of_tool));
        Some(Touch {
            tool,
            start: if plane.is_some() { normal } else { start },
            normal,
            gap: distance - target,
            target,
            tool_step,
            friction: friction(normal, tool_step),
            slides: true,
            plane,
            ..Touch::default()
        })
    }

    /// Finds how far tools push a node from a place (m, from the reference) that would go by a step (m), and along
    /// which axes it can; gives the sum (m). Tools take turns, and each looks anew where the node ends by now: surfaces
    /// are curved, and distances that are no more than a bound of the true ones grow more slowly.
    fn push_apart(
        &self,
        step: &ContactStep,
        all: &mut [Touch],
        (place, predicted): (DVec3, DVec3),
        free: DVec3,
    ) -> DVec3 {
        let mut sum = DVec3::ZERO;
        // one even tool at a node that may go anywhere: the first turn finds it all
        let is_exact =
            matches!(all, [one] if step.tools[one.tool].is_even && one.plane.is_none() && free == DVec3::ONE);
        for turn in 0..if is_exact { 1 } else { TURNS } {
            let mut most = 0.0_f64;
            for touch in all.iter_mut() {
                if turn > 0 && !touch.springs {
                    let tool = &step.tools[touch.tool];
                    let of_tool = tool.pose.inverse(place + predicted + sum);
                    let geometry = &self.tools[touch.tool].geometry;
                    let (distance, normal) = sweep::surface(touch.plane, geometry, of_tool);
                    touch.normal = tool.pose.rotation * normal;
                    touch.gap = distance - touch.target;
                    touch.tool_step = tool.change.place(of_tool);
                }
                let (way, along) = direction([touch.start, touch.normal], |push| free * push);
                touch.direction = way;
                // held along the normal: nobody can push it there
                if along > 1e-9 && !(turn > 0 && touch.springs) {
                    let push = (touch.push - touch.gap / along).max(0.0);
                    let outwards = way * (push - touch.push);
                    sum += free * outwards;
                    touch.outwards += outwards;
                    most = most.max((push - touch.push).abs());
                    touch.push = push;
                }
                if touch.friction > 0.0 {
                    let slip = along_surface(predicted + sum - touch.tool_step, way);
                    let wanted = along_surface(touch.tangential, way) - slip;
                    let bound = touch.friction * touch.push;
                    let size = wanted.length();
                    touch.slides = size > bound;
                    let tangential = if touch.slides { wanted * (bound / size) } else { wanted };
                    sum += free * (tangential - touch.tangential);
                    most = most.max((tangential - touch.tangential).length());
                    touch.tangential = tangential;
                }
            }
            if most <= SETTLED * self.edge {
                break;
            }
        }
        sum
    }
}

/// Changes of a turn, in edges, that are none.
const SETTLED: f64 = 1e-7;

/// The part of a vector along a surface.
fn along_surface(vector: DVec3, normal: DVec3) -> DVec3 {
    vector - normal * vector.dot(normal)
}
