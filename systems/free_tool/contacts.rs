//! Nodes against a rigid body that gives way: all forces of a step.

use super::{Repeat, Response, ToolStep};
use crate::backend::cpu::Foreseen;
use crate::components::{FreeTool, FreeTouch, Pose};
use crate::systems::tool_contact::STILL;
use crate::systems::tool_contact::direction::direction;
use crate::systems::tool_contact::sweep::{self, Plane, first_touch};
use glam::{DMat3, DVec3};

/// How often all contacts of a tool take turns.
const SWEEPS: usize = 200;

/// Changes of a sweep, in edges, that are none.
const SETTLED: f64 = 1e-9;

/// What [`solve`] repeats for each tool.
pub(super) fn sweeps() -> Repeat {
    Repeat { times: SWEEPS, until: Some("nothing changes"), what: vec!["forces between a tool and each of its nodes"] }
}

/// A node that may touch a tool.
pub(super) struct Near {
    /// The place of its body in [`FreeTool::meets`], and its row.
    pub node: (u32, u32),
    /// Where it is (m).
    pub place: DVec3,
    /// Where it would go.
    pub foreseen: Foreseen,
    /// Where it is, from the tool's centre of mass (m).
    pub arm: DVec3,
    /// The coefficient of friction that holds it.
    pub friction: f64,
    /// Length of an edge of its surface (m).
    pub edge: f64,
    /// How far it may go against the tool (m) with only its end looked at.
    pub swept: f64,
    /// How far from the surface it was to end in the last step (m), if it touched.
    pub target: Option<f64>,
    /// How far it comes out in this step, if it is inside (m).
    pub out: f64,
}

/// How a tool moves in the middle of the step, and what touches it.
pub(super) struct Solved {
    pub velocity: DVec3,
    pub momentum: DVec3,
    /// Each with what was foreseen of its node.
    pub touches: Vec<(FreeTouch, Foreseen)>,
}

/// A contact: forces on the node (N).
struct Contact {
    near: Near,
    /// Where it is in the tool's frame (m), and where its way first meets the tool, if it could be through it where it
    /// ends.
    here: DVec3,
    plane: Option<Plane>,
    /// The outward normal where it is (along the scene's axes).
    start: DVec3,
    /// Where it may be: the distance from the surface (m), 0 but for nodes that are inside already.
    target: f64,
    outwards: DVec3,
    push: f64,
    tangential: DVec3,
    /// How far the node slips along the surface in this step (m).
    slip: f64,
}

impl Contact {
    fn force(&self) -> DVec3 {
        self.outwards + self.tangential
    }

    /// How far the node goes (m).
    fn step(&self) -> DVec3 {
        self.near.foreseen.step + self.near.foreseen.free * self.force() / self.near.foreseen.to_force
    }

    /// How much farther apart node and tool end by a force between them (m/N), symmetric.
    fn compliance(&self, response: &Response) -> DMat3 {
        let Near { foreseen, arm, .. } = &self.near;
        let cross = DMat3::from_cols(
            DVec3::new(0.0, arm.z, -arm.y),
            DVec3::new(-arm.z, 0.0, arm.x),
            DVec3::new(arm.y, -arm.x, 0.0),
        );
        let own = DMat3::from_diagonal(
            foreseen.free / foreseen.to_force + DVec3::splat(response.linear * response.time_step),
        );
        own + cross * response.angular * cross.transpose() * response.time_step
    }
}

/// Finds the forces between a tool that would move so and nodes near it. Contacts take turns (projected Gauss and
/// Seidel): each finds its own force from where its node and the tool end by now, with the compliance of both, so that
/// a sweep never adds energy; forces never pull, and friction is at most μ times the push. Turns are taken in the order
/// of nodes, until nothing changes: the same bits on any number of threads. How far the tool turns is linear within a
/// sweep, and looked at anew in the next.
pub(super) fn solve(step: &ToolStep<'_>, near: Vec<Near>) -> Solved {
    let ToolStep { tool, response, .. } = step;
    let (dt, inertia) = (response.time_step, &tool.inertia);
    let begin = tool.pose(&step.before);
    let mut motion = step.free;
    let mut contacts: Vec<Contact> = near.into_iter().map(|near| Contact::new(near, &begin)).collect();
    for sweep in 0..SWEEPS {
        let pose = tool.pose(&motion.after(dt, inertia));
        let change = pose.less(&begin);
        if sweep == 0 {
            contacts.retain_mut(|contact| contact.begins(tool, [&begin, &pose]));
        }
        // how the tool has gone on since this pose (m, rad)
        let (mut way, mut turn) = (DVec3::ZERO, DVec3::ZERO);
        let mut most = 0.0_f64;
        for contact in &mut contacts {
            let arm = contact.near.arm;
            let further = way + turn.cross(arm);
            let y = pose.inverse(contact.near.place + contact.step() - further);
            let (distance, normal) = contact.surface(tool, y);
            let normal = pose.rotation * normal;
            let compliance = contact.compliance(response);
            let before = contact.force();
            // a plane has the same one all the way
            let start = if contact.plane.is_some() { normal } else { contact.start };
            let (out, along) = direction([start, normal], |push| compliance * push);
            let push = (contact.push - (distance - contact.target) / along).max(0.0);
            (contact.outwards, contact.push) = (out * push, push);
            // with what the push has just moved
            let gone = contact.step() - further - self_step(&contact.near, contact.force() - before, response);
            contact.rub(gone - change.place(y), out, &compliance);
            let force = contact.force() - before;
            way -= force * (response.linear * dt);
            turn -= response.angular * arm.cross(force) * dt;
            motion.velocity -= force * response.linear;
            motion.momentum -= arm.cross(force) * response.window;
            most = most.max((compliance * force).length() / contact.near.edge);
        }
        if most <= SETTLED {
            break;
        }
    }
    let touches = contacts.into_iter().filter(|contact| contact.push > 0.0).map(|contact| {
        let (force, sticks) = (contact.force(), contact.slip <= STILL * contact.near.edge);
        let (slip, target) = (contact.slip, contact.target);
        let Near { node, foreseen, arm, .. } = contact.near;
        (FreeTouch { node, force, arm, sticks, slip, target }, foreseen)
    });
    Solved { velocity: motion.velocity, momentum: motion.momentum, touches: touches.collect() }
}

/// How far the tool goes where a node is by a force on the node (m).
fn self_step(near: &Near, force: DVec3, response: &Response) -> DVec3 {
    let turn = response.angular * near.arm.cross(force);
    -(force * response.linear + turn.cross(near.arm)) * response.time_step
}

impl Contact {
    fn new(near: Near, begin: &Pose) -> Self {
        let (zero, here) = (DVec3::ZERO, begin.inverse(near.place));
        Self {
            near,
            here,
            plane: None,
            start: zero,
            target: 0.0,
            outwards: zero,
            push: 0.0,
            tangential: zero,
            slip: 0.0,
        }
    }

    /// How far its node is outside of what it must stay outside of (m) where it ends in the tool's frame, and which way
    /// out is. The plane that its way meets stays in the tool's frame, as the tool gives way.
    fn surface(&mut self, tool: &FreeTool, end: DVec3) -> (f64, DVec3) {
        if self.plane.is_none() {
            self.plane = first_touch(&tool.geometry, self.near.swept, [self.here, end]);
        }
        sweep::surface(self.plane, &tool.geometry, end)
    }

    /// Whether it may come to touch: its node ends less than an edge from the tool. Who is inside already comes out by
    /// and by, but for whom others keep inside: a guided tool that holds it, and pushes after this one.
    fn begins(&mut self, tool: &FreeTool, [begin, pose]: [&Pose; 2]) -> bool {
        let distance = self.surface(tool, pose.inverse(self.near.place + self.near.foreseen.step)).0;
        let (now, start) = tool.geometry.distance(self.here);
        self.start = begin.rotation * start;
        if distance < 0.0 {
            let kept = self.near.target.map_or(now, |target| now.max(target));
            self.target = (kept + self.near.out).min(0.0);
        }
        distance <= self.near.edge
    }

    /// Notes that a node slips by so much along the surface (m), and holds it as far as friction goes.
    fn rub(&mut self, slip: DVec3, normal: DVec3, compliance: &DMat3) {
        let along = |vector: DVec3| vector - normal * vector.dot(normal);
        self.slip = along(slip).length();
        if self.near.friction <= 0.0 {
            return;
        }
        let (first, second) = normal.any_orthonormal_pair();
        let (a, b) = (compliance * first, compliance * second);
        let (xx, xy, yy) = (first.dot(a), first.dot(b), second.dot(b));
        // no direction along the surface gives way by more
        let most = 0.5 * (xx + yy) + (0.25 * (xx - yy) * (xx - yy) + xy * xy).sqrt();
        if most <= 0.0 {
            return;
        }
        let wanted = along(self.tangential) - along(slip) / most;
        let bound = self.near.friction * self.push;
        let size = wanted.length();
        self.tangential = if size > bound { wanted * (bound / size) } else { wanted };
    }
}
