#![allow(missing_docs)]
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let scene = match sinew::SceneFile::load(&a[1], &a[3..].to_vec()) {
        Ok(s) => s,
        Err(e) => {
            println!("{}", e.render(false));
            return;
        }
    };
    let precision = if a[2] == "f64" { sinew::components::Precision::F64 } else { sinew::components::Precision::F32 };
    let o = sinew::Options {
        precision,
        threads: 1,
        backend: if std::env::var("B").is_ok() { sinew::BackendChoice::Gpu } else { sinew::BackendChoice::Cpu },
        ..Default::default()
    };
    let mut s = match sinew::Simulation::new(&scene, &o) {
        Ok(s) => s,
        Err(e) => {
            println!("{e}");
            return;
        }
    };
    let n = s.planned_steps();
    if let Err(e) = s.advance(n) {
        println!("{e}");
    }
    println!("{:#?}", s.summary("finished"));
}
