//! What of a scene may change while it runs: parameters of the effects that materials have, and amplitudes of loads.

use super::copied_material::{Part, split};
use super::schema::{Load, Material, Scene};
use super::syntax::Path;
use glam::DVec3;

/// Where one scene is another in more than that, if it is: a scene that runs cannot become it.
pub fn other_than_parameters(made: &Scene, now: &Scene) -> Option<Path> {
    let place = |list: &str| Path::default().name(list);
    let mut same = made.clone();
    for (name, material) in &mut same.materials {
        let Some(now) = now.materials.get(name) else { return Some(place("materials")) };
        take_parameters(material, now);
        if material != now {
            return Some(place("materials").name(name));
        }
    }
    for (name, body) in &mut same.bodies {
        let Some(now) = now.bodies.get(name) else { return Some(place("bodies")) };
        // what differs from copy to copy stays what does
        for (key, values) in &mut body.per_copy {
            let of_law = split(key).is_ok_and(|(_, way)| Part::of(&way) == Part::Law);
            if let Some(now) = now.per_copy.get(key).filter(|_| of_law) {
                values.clone_from(now);
            }
        }
        if body != now {
            return Some(place("bodies").name(name));
        }
    }
    for (number, (load, now)) in same.loads.iter_mut().zip(&now.loads).enumerate() {
        take_amplitude(load, now);
        if load != now {
            return Some(place("loads").index(number));
        }
    }
    (same != *now).then(Path::default)
}

/// The parameters of effects that both have, and that had a weight from the start.
fn take_parameters(material: &mut Material, now: &Material) {
    material.take_law_parameters(now);
    if let (Some(fibres), Some(now)) = (&mut material.fibres, &now.fibres)
        && fibres.eta != 0.0
    {
        (fibres.eta, fibres.tension_only) = (now.eta, now.tension_only);
    }
    for (family, now) in material.exponential_fibres.iter_mut().flatten().zip(now.exponential_fibres.iter().flatten()) {
        if family.k1 != 0.0 {
            let direction = family.direction.clone();
            family.clone_from(now);
            family.direction = direction;
        }
    }
}

/// The amplitude of a load of the same kind that had one from the start.
fn take_amplitude(load: &mut Load, now: &Load) {
    if load.amplitude() == DVec3::ZERO {
        return;
    }
    if load.parts().name == now.parts().name {
        load.set_amplitude(now.amplitude());
    }
}
