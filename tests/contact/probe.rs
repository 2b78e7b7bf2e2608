use crate::configurations::configurations;
use sinew::components::*;
#[test]
fn probe() {
    let run = &configurations()[0];
    for sweeps in [1, 4] {
    let cube = "mesh: Box(size: (0.02, 0.02, 0.02), cells: (4, 4, 4)), material: \"m\"";
    let other = "mesh: Box(size: (0.02, 0.02, 0.02), cells: (3, 3, 3)), material: \"m\"";
    let mut simulation = run.start(&format!(
        "(duration: 0.05, bodies: {{\"a\": ({cube}),
            \"b\": ({other}, rotate: (20, 35, 10), translate: (0.012, 0.008, 0.032), velocity: (-0.1, 0.02, -0.5))}},
        materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45))}}, contacts: [Between(bodies: (\"a\", \"b\"), friction: 0, sweeps: {sweeps})],
        output: (energies_every: 0.001))"
    ));
    simulation.advance(1).unwrap();
    let mut last = 0.0;
    while simulation.time() < 0.05 {
        simulation.advance(1).unwrap();
        let e = simulation.energies().unwrap();
        let w = e.load_work.unwrap();
        let mut deepest = vec![];
        for body in ["a", "b"] {
            let n = simulation.column::<SurfaceTouch>(body).unwrap();
            let v = n.values();
            for row in 0..v.len() / 8 {
                if v.get(8*row+4) > 0.5 { deepest.push((body, row, v.get(8*row+5), v.vector_at(8*row))); }
            }
        }
        let min = deepest.iter().map(|d| d.2).fold(0.0, f64::min);
        println!("{sweeps} {:.5} {:.3e} {:+.3e} touching {} deepest {:.3e}", simulation.time(), w, w - last, deepest.len(), min);
        last = w;
    }
    }
}
