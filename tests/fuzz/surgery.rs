//! What made-up scenes have of tools, contact, attachments, suction and removal by tools: of a row of random numbers of
//! its own, so that all else of a seed stays as it was.

use crate::dice::{Dice, number, one_of, size, vector};
use crate::generate::{Geometry, curve, place};
use fastrand::Rng;
use glam::DVec3;

/// A surface of triangles, as a tool and as a skin.
const SURFACE: &str = "tests/fuzz/shapes/octahedron.obj";

/// The lists of a scene.
#[derive(Default)]
pub struct Surgery {
    tools: Vec<String>,
    contacts: Vec<String>,
    attachments: Vec<String>,
    suction: Vec<String>,
    pub removal: Vec<String>,
}

/// A tool, and what must be known to use it.
struct Tool {
    name: String,
    free: bool,
    /// Its thickness (m).
    radius: f64,
    body: usize,
}

impl Surgery {
    /// What is done to the bodies of a scene.
    pub fn of(seed: u64, bodies: &[Geometry], duration: f64, statics: bool) -> Self {
        let r = &mut Dice::of(seed ^ 0x5c41_0000);
        let mut made = Self::default();
        let tools: Vec<Tool> = (0..r.u8(0..=3)).map(|k| made.tool(k, bodies, duration, statics, r)).collect();
        for tool in &tools {
            made.uses_of(tool, bodies, duration, statics, r);
        }
        if bodies.len() > 1 && r.u8(..5) > 0 {
            let law = surfaces(statics, r);
            made.contacts.push(format!("Between(bodies: (\"b0\", \"b1\"){law})"));
        }
        if r.u8(..3) == 0 || tools.is_empty() && bodies.len() == 1 {
            let law = surfaces(statics, r);
            made.contacts.push(format!("Itself(body: \"{}\"{law})", bodies[0].name));
        }
        if bodies.len() > 1 && r.u8(..3) == 0 {
            let tied = attachment(bodies, duration, r);
            made.attachments.push(tied);
        }
        made
    }

    /// The lists as fields of a scene, but for the removal.
    pub fn text(&self) -> String {
        let list = |name: &str, all: &[String]| format!("{name}: [{}], ", all.join(", "));
        format!("tools: {{{}}}, ", self.tools.join(", "))
            + &list("contacts", &self.contacts)
            + &list("attachments", &self.attachments)
            + &list("suction", &self.suction)
    }

    /// Whether the least rounding may decide what becomes of a node: what it faces, and whether something lets it go.
    pub fn decides(&self) -> bool {
        let surfaces = self.contacts.iter().any(|contact| !contact.starts_with("Tool") || contact.contains("static_"));
        surfaces || !self.removal.is_empty() || self.attachments.iter().any(|tie| !tie.starts_with("Suture"))
    }

    fn tool(&mut self, number_of_it: u8, bodies: &[Geometry], duration: f64, statics: bool, r: &mut Dice) -> Tool {
        let at = r.usize(..bodies.len());
        let body = &bodies[at];
        let name = format!("t{number_of_it}");
        let radius = body.size * number(r, 0.1, 0.8);
        let (shape, round) = shape(radius, r);
        let axis = side(r);
        // what is long points out of the body, what lies below a plane away from it
        let turned = turn(if shape.contains("Plane") { -axis } else { axis });
        let face = body.middle() + 0.5 * (body.high - body.low) * axis;
        let mut place_at = |least: f64| {
            let aside = DVec3::from_array([0; 3].map(|_| number(r, -0.3, 0.3))) * (DVec3::ONE - axis.abs());
            let gap = number(r, least, 0.15);
            triple(face + body.size * (aside + gap * axis) + if round { radius * axis } else { DVec3::ZERO })
        };
        let [a, b, c] = [0.0, -0.2, -0.2].map(&mut place_at);
        let rounding = if r.bool() { format!(", rounding: {:?}", 0.1 * radius) } else { String::new() };
        // a plane has no end, and so no mass
        let free = !statics && r.u8(..5) == 0 && !shape.contains("Plane");
        let motion = match r.u8(..6) {
            _ if free => self::free(&a, &turned, body, radius, r),
            0 => format!("at: {a}, rotation: {turned}"),
            1 => {
                let displacement = triple(-axis * body.size * number(r, 0.0, 0.3));
                let (turn, course) = (vector(r, 20.0), curve(duration, r));
                format!(
                    "at: {a}, rotation: {turned}, moves: [(displacement: {displacement}, rotation: {turn}{course})]"
                )
            }
            2 => {
                let pivot = triple(face + axis * 3.0 * body.size);
                format!("pivot: {pivot}, path: [(t: 0, at: {a}), (t: {:?}, at: {b})]", 0.8 * duration)
            }
            3 if !statics => {
                let follow = one_of(r, &["Position", "Proxy(stiffness: 2)"]);
                let speed = body.size / duration;
                format!("at: {a}, rotation: {turned}, port: (name: \"{name}\", speed: {speed:?}, follow: {follow})")
            }
            _ => {
                let (middle, end) = (duration * number(r, 0.2, 0.6), duration * number(r, 0.7, 1.0));
                let at = |t: f64, at: &str| format!("(t: {t:?}, at: {at}, rotation: {turned})");
                format!("path: [{}, {}, {}]", at(0.0, &a), at(middle, &b), at(end, &c))
            }
        };
        let rounding = if shape.starts_with("mesh") { String::new() } else { rounding };
        self.tools.push(format!("\"{name}\": ({shape}{rounding}, {motion})"));
        Tool { name, free, radius, body: at }
    }

    /// What a tool does to bodies.
    fn uses_of(&mut self, tool: &Tool, bodies: &[Geometry], duration: f64, statics: bool, r: &mut Dice) {
        let (name, body) = (&tool.name, &bodies[tool.body]);
        for body in bodies {
            if r.u8(..5) > 0 {
                let on = if r.u8(..4) == 0 { format!(", on: {}", place(body.size, r)) } else { String::new() };
                let law = touch(statics || tool.free, r);
                self.contacts.push(format!("Tool(tool: \"{name}\", body: \"{}\"{on}{law})", body.name));
            }
        }
        if tool.free {
            return;
        }
        if r.u8(..4) == 0 {
            let strength = if r.u8(..3) == 0 { format!(", strength: {:?}", size(r, 1e-4, 1.0)) } else { String::new() };
            let closed = curve(duration, r);
            let closed = if closed.is_empty() { ", curve: Step()".into() } else { closed };
            self.attachments.push(format!(
                "Grasp(tool: \"{name}\", body: \"{}\", jaws: Sphere(radius: {:?}){}{strength})",
                body.name,
                tool.radius * number(r, 0.5, 2.0),
                closed.replace("curve", "closed")
            ));
        }
        if statics {
            return;
        }
        let mouth =
            format!("bore: {:?}, reach: {:?}", tool.radius * number(r, 0.3, 1.0), body.size * number(r, 0.1, 0.5));
        if r.u8(..4) == 0 {
            let course = curve(duration, r);
            let delay = duration * number(r, 0.0, 0.5);
            self.suction.push(format!(
                "(tool: \"{name}\", body: \"{}\", pressure: {:?}, {mouth}, delay: {delay:?}{course})",
                body.name,
                size(r, 1.0, 1e3)
            ));
        }
        if r.u8(..5) == 0 {
            let what = match r.u8(..3) {
                0 => format!("threshold: {}", one_of(r, &["StretchAbove(1.05)", "EnergyDensityAbove(2)"])),
                _ => format!("rate: {:?}", body.size.powi(3) / duration * size(r, 0.01, 2.0)),
            };
            let crumb = one_of(r, &["", "", ", crumb: 0", ", burst: 2"]);
            self.removal
                .push(format!("(body: \"{}\", when: InTool(tool: \"{name}\", {mouth}, {what}{crumb}))", body.name));
        }
    }
}

fn triple(x: DVec3) -> String {
    format!("({:?}, {:?}, {:?})", x.x, x.y, x.z)
}

/// One of the six directions along axes.
fn side(r: &mut Rng) -> DVec3 {
    let sign = if r.bool() { 1.0 } else { -1.0 };
    sign * DVec3::AXES[r.usize(..3)]
}

/// The turn that brings the axis z to one of these (degrees).
fn turn(axis: DVec3) -> String {
    let turn = if axis.z < 0.0 { DVec3::X * 180.0 } else { DVec3::new(-axis.y, axis.x, 0.0) * 90.0 };
    triple(turn)
}

/// A shape of a tool, and whether its origin is in its middle.
fn shape(radius: f64, r: &mut Rng) -> (String, bool) {
    let length = radius * number(r, 2.0, 6.0);
    match r.u8(..8) {
        0 => ("shape: Plane()".into(), false),
        1 => (format!("shape: Box(size: ({:?}, {:?}, {:?}))", 2.0 * radius, 2.0 * radius, 2.0 * radius), true),
        2 => (format!("shape: Capsule(length: {length:?}, radius: {radius:?})"), false),
        3 => (format!("shape: Cylinder(length: {length:?}, radius: {radius:?})"), false),
        4 => {
            let tip = radius * number(r, 0.1, 1.0);
            (format!("shape: Cone(length: {length:?}, tip: {tip:?}, base: {radius:?})"), false)
        }
        5 => {
            let bevel = one_of(r, &["", ", bevel: 30"]);
            let inner = radius * number(r, 0.3, 0.8);
            (format!("shape: Tube(length: {:?}, inner: {inner:?}, outer: {radius:?}{bevel})", 6.0 * radius), false)
        }
        6 => (format!("mesh: (path: {SURFACE:?}, scale: {radius:?}, spacing: {:?})", radius / 8.0), true),
        _ => (format!("shape: Sphere(radius: {radius:?})"), true),
    }
}

/// A tool that moves freely: towards what it is beside.
fn free(at: &str, turned: &str, body: &Geometry, radius: f64, r: &mut Dice) -> String {
    let speed = 0.3 * r.beyond(1e2);
    let mass = size(r, 10.0, 3000.0);
    let weight = match r.bool() {
        true => format!("density: {mass:?}"),
        false => {
            let one = mass * radius * radius * body.size;
            format!("mass: {one:?}, inertia: ({0:?}, {0:?}, {0:?})", 0.4 * one * radius * radius)
        }
    };
    let (velocity, spin) = (vector(r, speed), vector(r, 90.0));
    let damping = one_of(r, &["", ", damping: 5"]);
    format!("at: {at}, rotation: {turned}, free: ({weight}, velocity: {velocity}, spin: {spin}{damping})")
}

fn friction(r: &mut Rng) -> String {
    match r.u8(..4) {
        0 => String::new(),
        1 => ", friction: 0.2, static_friction: 0.4".into(),
        _ => format!(", friction: {:?}", number(r, 0.0, 1.0)),
    }
}

/// What keeps points out, where there is a choice.
fn law(only_kinematic: bool, r: &mut Rng) -> String {
    if only_kinematic || r.u8(..6) > 0 {
        return String::new();
    }
    format!(", law: Penalty(share: {:?}, damping: {:?})", size(r, 0.01, 0.5), number(r, 0.0, 0.3))
}

fn touch(only_kinematic: bool, r: &mut Rng) -> String {
    let thin = one_of(r, &["", ", thin: true"]);
    friction(r) + thin + &law(only_kinematic, r)
}

/// How two surfaces meet.
pub fn surfaces(statics: bool, r: &mut Rng) -> String {
    let mut text = friction(r) + &law(statics, r);
    if r.u8(..4) == 0 {
        text += &format!(", thickness: {:?}", size(r, 1e-6, 1e-3));
    }
    if r.u8(..3) == 0 {
        text += &format!(", sweeps: {}", r.u8(1..=8));
    }
    text + one_of(r, &["", "", ", points: Faces"]) + one_of(r, &["", "", ", edges: true"])
}

/// What holds two bodies together.
fn attachment(bodies: &[Geometry], duration: f64, r: &mut Dice) -> String {
    let (a, b) = (&bodies[0], &bodies[1]);
    let facing = |body: &Geometry, sign: f64| body.middle() + 0.5 * sign * (body.high - body.low) * DVec3::X;
    let mut aside = || DVec3::new(0.0, number(r, -0.1, 0.1), number(r, -0.1, 0.1)) * a.size;
    let (from, to) = (triple(facing(a, 0.95) + aside()), triple(facing(b, -0.95) + aside()));
    let strength = if r.bool() { format!(", strength: {:?}", size(r, 1e-5, 1.0)) } else { String::new() };
    match r.u8(..3) {
        0 => {
            let course = curve(duration, r);
            format!(
                "Suture(from: (body: \"b0\", at: {from}), to: (body: \"b1\", at: {to}), stiffness: {:?}, tighten: {:?}{course}{strength})",
                size(r, 0.01, 1e3),
                a.size * number(r, 0.0, 0.3)
            )
        }
        1 => format!("Tie(from: (body: \"b0\", at: {from}), to: (body: \"b1\", at: {to}){strength})"),
        _ => {
            let strength = if r.bool() { ", normal: 20, shear: 30" } else { "" };
            format!("Glue(bodies: (\"b0\", \"b1\"), reach: {:?}{strength})", a.size * number(r, 0.01, 0.3))
        }
    }
}

/// A skin for a body.
pub fn skin(body_size: f64, r: &mut Rng) -> String {
    format!("skin: (file: {SURFACE:?}, scale: {:?})", body_size * number(r, 0.3, 0.7))
}
