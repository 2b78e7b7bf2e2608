//! What a ray first meets of what is drawn.

use super::body::BodyMesh;
use super::{Scenery, plane};
use crate::settings::Settings;
use glam::{DVec3, Vec3};
use sinew::Pick;
use sinew::driver::{BodyState, State};
use sinew_pictures::render::{Extent, Plane, Section};

/// Where a ray meets a body as it is drawn.
struct Met {
    /// From where it begins (m).
    distance: f64,
    /// The place of the element, in the author's order.
    element: usize,
    face: [u32; 4],
    nodes: [u32; 3],
    weights: [f64; 3],
    /// Where what closes a cut cell looks to, of a point on that.
    closed: Option<Vec3>,
}

impl Scenery {
    /// What a ray first meets of the bodies as they were drawn last, with their numbers of a state: of their surfaces,
    /// which carry skins, as far as they are not cut away, and of what closes the cells that are cut. There the cell's
    /// nearest node is picked.
    pub fn pick(&self, state: &State, settings: &Settings, origin: DVec3, direction: DVec3) -> Option<Pick> {
        let along = direction.try_normalize()?;
        let bodies = || self.bodies.iter().zip(&state.bodies);
        let mut extent = Extent::NOTHING;
        bodies().flat_map(|(mesh, _)| &mesh.vertices).for_each(|point| extent.add(*point));
        let plane = settings.cut.then(|| plane(settings, &extent));
        let met = |(number, (mesh, now)): (usize, (&BodyMesh, &BodyState))| {
            Some((number, mesh.meet((origin, along), now, plane.as_ref())?))
        };
        let all = bodies().enumerate().filter_map(met);
        let (number, met) = all.min_by(|a, b| a.1.distance.total_cmp(&b.1.distance))?;
        let (body, now) = (self.loaded.as_ref()?.bodies.get(number)?, state.bodies.get(number)?);
        let place = |node: u32| now.positions.get(node as usize).map(|place| Vec3::from_array(*place).as_dvec3());
        let [a, b, c] = met.nodes.map(place);
        let (a, b, c) = (a?, b?, c?);
        let normal = match met.closed {
            Some(normal) => normal.as_dvec3(),
            None => (b - a).cross(c - a).normalize_or_zero(),
        };
        Some(Pick {
            body: body.name.clone(),
            element: body.elements.of(met.element),
            face: met.face,
            nodes: met.nodes,
            weights: met.weights,
            point: a * met.weights[0] + b * met.weights[1] + c * met.weights[2],
            normal,
            distance: met.distance,
        })
    }
}

impl BodyMesh {
    /// Where a ray first meets it as it is drawn.
    fn meet(&self, ray: (DVec3, DVec3), now: &BodyState, plane: Option<&Plane>) -> Option<Met> {
        let mut all = self.meets_of_surface(ray, plane);
        all.extend(plane.map(|plane| self.meets_of_section(ray, now, plane)).into_iter().flatten());
        all.into_iter().min_by(|a, b| a.distance.total_cmp(&b.distance))
    }

    fn meets_of_surface(&self, (origin, along): (DVec3, DVec3), plane: Option<&Plane>) -> Vec<Met> {
        let mut all = Vec::new();
        for face in &self.outer.1 {
            let [a, b, c, d] = face.points;
            for nodes in [[a, b, c], [a, c, d]].into_iter().take(if c == d { 1 } else { 2 }) {
                let corners = nodes.map(|node| self.vertices[node as usize].as_dvec3());
                let Some((distance, weights)) = Pick::meet(origin, along, corners) else { continue };
                if plane.is_none_or(|plane| plane.beyond((origin + along * distance).as_vec3()) <= 0.0) {
                    let element = face.cell as usize;
                    all.push(Met { distance, element, face: face.points, nodes, weights, closed: None });
                }
            }
        }
        all
    }

    /// Of what closes the cells that a plane cuts.
    fn meets_of_section(&self, (origin, along): (DVec3, DVec3), now: &BodyState, plane: &Plane) -> Vec<Met> {
        let mut all = Vec::new();
        for (element, (kind, nodes)) in self.cells.iter().enumerate() {
            if now.alive.get(element).is_none_or(|alive| *alive == 0) {
                continue;
            }
            let places: Vec<Vec3> = nodes.iter().map(|node| self.vertices[*node as usize]).collect();
            let mut section = Section::default();
            section.add(plane, kind, &places, &vec![0.0; places.len()]);
            for [a, b, c, _] in section.faces {
                let corners = [a, b, c].map(|row| section.vertices[row as usize].as_dvec3());
                let Some((distance, _)) = Pick::meet(origin, along, corners) else { continue };
                let point = (origin + along * distance).as_vec3();
                let away = |place: &Vec3| place.distance_squared(point);
                let nearest = nodes.iter().zip(&places).min_by(|a, b| away(a.1).total_cmp(&away(b.1)));
                let Some((&node, _)) = nearest else { continue };
                let (face, nodes, weights) = ([node; 4], [node; 3], [1.0, 0.0, 0.0]);
                all.push(Met { distance, element, face, nodes, weights, closed: Some(plane.normal) });
            }
        }
        all
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use sinew::driver::{Command, Session};
    use sinew::{BackendChoice, Options, SceneFile};

    /// A cube of 10 cm that is pulled to some 11 cm.
    const CUBE: &str = r#"(
        duration: 1,
        bodies: {"cube": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (4, 4, 4), elements: Hex8), material: "gel")},
        materials: {"gel": (density: 1000, damping: 60, neo_hookean: Young(young: 20000, poisson: 0.4))},
        constraints: [Fixed(on: Set("z0"))],
        loads: [NodalForce(on: Set("z1"), force: (0, 0, 20), share: Total)],
    )"#;

    fn drawn(settings: &Settings) -> (State, Scenery) {
        let scene = SceneFile::from_text("cube", CUBE, std::path::Path::new(""), &[]);
        let options = Options { backend: BackendChoice::Cpu, threads: 1, ..Options::default() };
        let mut session = Session::new(options);
        session.command(Command::Load(Box::new(scene.map_err(|wrong| wrong.render(false)).unwrap())));
        session.command(Command::Step(100));
        let state = session.state();
        let mut scenery = Scenery::default();
        scenery.follow(&state);
        drop(scenery.draw(&state, settings));
        (state, scenery)
    }

    #[test]
    fn a_ray_meets_what_is_drawn_and_tells_where_that_is() {
        let settings = Settings { deformation: 5.0, ..Settings::default() };
        let (state, scenery) = drawn(&settings);
        let above = DVec3::new(0.06, 0.06, 1.0);
        let pick = scenery.pick(&state, &settings, above, DVec3::NEG_Z).unwrap();
        let top = pick.point.z;
        assert!(top > 0.1005 && pick.normal.z > 0.9, "{pick:?}");
        let height = 1.0 - pick.distance;
        assert!((height - 0.1 - 5.0 * (top - 0.1)).abs() < 1e-3 * height, "{height} m of {top} m");
        // between where it is and where it is drawn
        let beside = DVec3::new(1.0, 0.05, 0.5 * (top + height));
        let pick = scenery.pick(&state, &settings, beside, DVec3::NEG_X).unwrap();
        assert!((0.08..top).contains(&pick.point.z), "{pick:?}");
        assert_eq!(scenery.pick(&state, &settings, beside + DVec3::Z, DVec3::NEG_X), None);
        assert_eq!(scenery.pick(&state, &settings, beside, DVec3::ZERO), None);
    }

    #[test]
    fn what_is_cut_away_is_not_met_and_what_closes_the_cut_is() {
        let settings = Settings { cut: true, cut_normal: Vec3::X, cut_at: 0.4, ..Settings::default() };
        let (state, scenery) = drawn(&settings);
        let pick = |origin: DVec3, direction: DVec3| scenery.pick(&state, &settings, origin, direction);
        assert_eq!(pick(DVec3::new(0.08, 0.05, 1.0), DVec3::NEG_Z), None);
        assert!(pick(DVec3::new(0.02, 0.05, 1.0), DVec3::NEG_Z).is_some_and(|pick| pick.normal.z > 0.9));
        // the section at 4 cm: nodes stand each 2.5 cm
        let closed = pick(DVec3::new(1.0, 0.055, 0.03), DVec3::NEG_X).unwrap();
        assert!((closed.distance - 0.96).abs() < 2e-3 && closed.weights == [1.0, 0.0, 0.0], "{closed:?}");
        assert!(closed.point.distance(DVec3::new(0.05, 0.05, 0.025)) < 5e-3 && closed.normal == DVec3::X, "{closed:?}");
    }
}
