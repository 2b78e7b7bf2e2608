//! Effects of a scene that can be switched off, one at a time.

use glam::DVec3;
use sinew::scene::schema::Scene;

/// Something in a scene, and how to take it out.
struct Effect {
    name: String,
    off: Box<dyn Fn(&mut Scene)>,
}

/// The names of all effects that can be switched off.
pub fn effects(scene: &Scene) -> Vec<String> {
    list(scene).into_iter().map(|effect| effect.name).collect()
}

/// Takes an effect out of a scene.
pub fn switch_off(scene: &mut Scene, name: &str) {
    if let Some(effect) = list(scene).into_iter().find(|effect| effect.name == name) {
        (effect.off)(scene);
    }
}

fn list(scene: &Scene) -> Vec<Effect> {
    let mut list = Vec::new();
    let mut add = |name: String, off: Box<dyn Fn(&mut Scene)>| list.push(Effect { name, off });
    for (name, material) in &scene.materials {
        let of = |what: &str| if scene.materials.len() == 1 { what.to_string() } else { format!("{what} of {name}") };
        // what a material has beyond an elastic law: name, whether it is there, how it goes
        type Part = (&'static str, bool, fn(&mut sinew::scene::schema::Material));
        let parts: [Part; 5] = [
            ("fibres", material.fibres.is_some(), |m| m.fibres = None),
            ("exponential fibres", material.exponential_fibres.is_some(), |m| m.exponential_fibres = None),
            ("viscosity", material.prony.is_some(), |m| m.prony = None),
            ("damping", material.damping.is_some_and(|rate| rate > 0.0), |m| m.damping = None),
            ("stiffness damping", material.stiffness_damping.is_some_and(|time| time > 0.0), |m| {
                m.stiffness_damping = None
            }),
        ];
        for (what, there, off) in parts {
            let key = name.clone();
            if there {
                add(of(what), Box::new(move |scene| scene.materials.get_mut(&key).into_iter().for_each(off)));
            }
        }
    }
    for (number, load) in scene.loads.iter().enumerate() {
        let word = load.parts().name;
        let name = if scene.loads.len() == 1 { word.to_string() } else { format!("{word} (loads[{number}])") };
        add(name, Box::new(move |scene| drop(scene.loads.remove(number))));
    }
    for name in scene.systems.keys() {
        let key = name.clone();
        add(name.clone(), Box::new(move |scene| drop(scene.systems.remove(&key))));
    }
    for number in 0..scene.removal.len() {
        let name = if scene.removal.len() == 1 { "removal".into() } else { format!("removal[{number}]") };
        add(name, Box::new(move |scene| drop(scene.removal.remove(number))));
    }
    for (name, body) in &scene.bodies {
        if body.velocity != DVec3::ZERO || body.spin != DVec3::ZERO {
            let key = name.clone();
            let off = move |scene: &mut Scene| {
                if let Some(body) = scene.bodies.get_mut(&key) {
                    (body.velocity, body.spin) = (DVec3::ZERO, DVec3::ZERO);
                }
            };
            add(format!("initial motion of {name}"), Box::new(off));
        }
    }
    if scene.integration.compensated {
        add("compensated sum".into(), Box::new(|scene| scene.integration.compensated = false));
    }
    list
}
