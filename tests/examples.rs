//! The examples run, and the custom system does the same on both backends.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

#[allow(dead_code)]
#[path = "../examples/custom_system.rs"]
mod custom_system;
#[path = "../examples/embed.rs"]
mod embed;
#[allow(dead_code)]
#[path = "../examples/haptic.rs"]
mod haptic;
#[allow(dead_code)]
#[path = "../examples/host_system.rs"]
mod host_system;
#[path = "../examples/latency.rs"]
mod latency;

use sinew::systems::Registry;
use sinew::{BackendChoice, Options, SceneFile, Simulation};

#[test]
fn embed_runs() {
    embed::main().unwrap();
}

/// The stiffness of the hand is some N/m, and it goes 0.5 mm deep.
#[test]
fn a_touched_lens_pushes_back() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/lens_pressed.ron");
    let sets: Vec<String> = latency::TOUCHED.iter().map(|set| set.to_string()).collect();
    let felt = latency::run(&SceneFile::load(path, &sets).unwrap(), 1, 0.12).unwrap();
    assert!(felt > 1e-5 && felt < 1e-2, "{felt} N");
}

/// How long it takes is the machine's business; what the hand did gives the same bits again.
#[test]
fn a_hand_feels_a_block_and_a_lens_and_is_replayed() {
    let lens = haptic::Touched::lens(concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/lens_pressed.ron"));
    for touched in [haptic::Touched::block(), lens] {
        let options = Options { backend: BackendChoice::Cpu, threads: 1, ..Options::default() };
        let (felt, recording, mut simulation) = haptic::press(&touched, &options, 0.6).unwrap();
        let most = felt.iter().map(|felt| felt.force.length()).fold(0.0, f64::max);
        assert!(most > 1e-3 && most <= 3.0, "{most} N");
        assert!(felt.iter().all(|felt| felt.force.is_finite() && felt.depth < 4e-3));
        let replayed = haptic::replays(&touched, &options, &recording, &mut simulation).unwrap();
        assert!(!recording.poses.is_empty() && replayed);
    }
}

/// A system of one's own shares the pass of those of the engine, on both backends, and does what a system on the host
/// does.
#[test]
fn custom_system_shares_a_pass_and_pulls_alike_on_both_backends_and_on_the_host() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/magnet.ron");
    // of the same step: how stiff the magnet is, the host's system does not say (`with_slopes` would)
    let sets = ["duration=0.3".into(), "integration=(step: 4e-4)".into()];
    let scene = SceneFile::load(path, &sets).unwrap();
    let (of_nodes, on_host) = (custom_system::registry(), host_system::registry());
    let run = |registry: &Registry, backend| custom_system::run(&scene, registry, backend, None).unwrap();
    let shared = |simulation: &mut Simulation| {
        let summary = simulation.summary("finished").unwrap();
        summary.systems.iter().any(|pass| {
            pass.name.contains("gather + magnet + boundary + integrate")
                || pass.name.contains("gather + magnet + integrate")
        })
    };
    let (mut cpu, mut host) = (run(&of_nodes, BackendChoice::Cpu), run(&on_host, BackendChoice::Cpu));
    assert!(shared(&mut cpu) && !shared(&mut host));
    let bulge = custom_system::bulge(&mut cpu).unwrap();
    assert!(bulge > 1e-3, "the gel rises by {bulge} m only");
    assert_eq!(cpu.displacements("gel").unwrap(), host.displacements("gel").unwrap());
    if sinew::backend::gpu::gpu_or_reason().is_some() {
        for (registry, shares) in [(&of_nodes, true), (&on_host, false)] {
            let mut gpu = run(registry, BackendChoice::Gpu);
            assert_eq!(shared(&mut gpu), shares);
            // what shares a pass brings nothing to the host
            let summary = gpu.summary("finished").unwrap();
            let brought =
                summary.systems.iter().filter(|pass| pass.name.contains("magnet")).map(|pass| pass.brought.len());
            assert_eq!(brought.sum::<usize>() == 0, shares);
            let gpu = custom_system::bulge(&mut gpu).unwrap();
            assert!((gpu - bulge).abs() < 1e-4 * bulge, "{gpu} m on the GPU, {bulge} m on the CPU");
        }
    }
}

/// F = diag(λ, t, t), J = λt²: σ = μ exp(b(Ī₁ − 3)) J^(−5/3) dev(FFᵀ) + κ(J − 1); t from σ₂₂ = 0, then the force is σ₁₁
/// t² A.
#[test]
fn own_law_pulls_a_strip_as_its_closed_form_says_on_both_backends() {
    pulls_as_the_closed_form_says("own_law.ron");
}

/// The same law from a formula of its energy.
#[test]
fn energy_law_pulls_a_strip_as_its_closed_form_says_on_both_backends() {
    pulls_as_the_closed_form_says("energy_law.ron");
}

fn pulls_as_the_closed_form_says(example: &str) {
    let path = format!("{}/examples/{example}", env!("CARGO_MANIFEST_DIR"));
    let scene = SceneFile::load(path, &[]).unwrap();
    let (mu, b, bulk, stretch) = (2000.0, 2.0, 1e5, 1.4_f64);
    let stress = |across: f64| {
        let (j, trace) = (stretch * across * across, stretch.powi(2) + 2.0 * across.powi(2));
        let factor = mu * f64::exp(b * (j.powf(-2.0 / 3.0) * trace - 3.0)) * j.powf(-5.0 / 3.0);
        [stretch, across].map(|x| factor * (x * x - trace / 3.0) + bulk * (j - 1.0))
    };
    let (mut low, mut high) = (0.7, 1.0);
    for _ in 0..60 {
        let middle = (low + high) / 2.0;
        if stress(middle)[1] < 0.0 { low = middle } else { high = middle }
    }
    let expected = stress(low)[0] * low * low * 0.01 * 0.005;
    let gpu = sinew::backend::gpu::gpu_or_reason().map(|_| BackendChoice::Gpu);
    for backend in std::iter::once(BackendChoice::Cpu).chain(gpu) {
        let mut run = Simulation::new(&scene, &Options { backend, ..Options::default() }).unwrap();
        run.advance_to(0.6).unwrap();
        let force = run.probe("grip").unwrap()[0];
        assert!((force / expected - 1.0).abs() < 1e-3, "{backend:?}: {force} N instead of {expected} N");
    }
}

/// Wind that is nothing but WGSL bends the blade, alike on both backends. WGSL's sine may be off by 2⁻¹¹, the drag by
/// 2·0.4 times that.
#[test]
fn own_system_bends_a_blade_alike_on_both_backends_without_a_line_of_rust() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/own_system.ron");
    let scene = SceneFile::load(path, &[]).unwrap();
    let found = Simulation::check(&scene, &Registry::default());
    assert!(found.is_empty(), "{}", found.render(false));
    let calm = SceneFile::load(path, &["systems.wind.parameters.speed=3".into()]).unwrap();
    let bent = |scene: &SceneFile, backend| {
        let mut run = Simulation::new(scene, &Options { backend, ..Options::default() }).unwrap();
        run.advance_to(0.3).unwrap();
        let summary = run.summary("finished").unwrap();
        let shared = summary.systems.iter().any(|pass| pass.name.contains("gather + boundary + wind + integrate"));
        assert!(shared, "{:?}", summary.systems.iter().map(|pass| &pass.name).collect::<Vec<_>>());
        run.probe("tip").unwrap()[0]
    };
    let tip = bent(&scene, BackendChoice::Cpu);
    assert!(tip > 5e-3 && tip < 0.05, "the tip is {tip} m off");
    // drag goes with the square of the speed
    let calm = bent(&calm, BackendChoice::Cpu);
    assert!(calm > 0.02 * tip && calm < 0.12 * tip, "{calm} m at a quarter of the speed, {tip} m");
    if sinew::backend::gpu::gpu_or_reason().is_some() {
        let gpu = bent(&scene, BackendChoice::Gpu);
        assert!((gpu - tip).abs() < 1e-3 * tip, "{gpu} m on the GPU, {tip} m on the CPU");
    }
}

/// The scenes that the guides show: those of the README, which stand alone.
#[test]
fn scenes_in_the_readme_are_sound() {
    let guide = include_str!("../README.md");
    let scenes: Vec<&str> = guide.split("```ron\n").skip(1).filter_map(|rest| rest.split("```").next()).collect();
    assert!(!scenes.is_empty());
    for text in scenes {
        let scene = SceneFile::from_text("README", text, std::path::Path::new("."), &[]);
        let scene = scene.unwrap_or_else(|wrong| panic!("{}", wrong.render(false)));
        let found = Simulation::check(&scene, &Registry::default());
        assert!(found.is_empty(), "{}", found.render(false));
    }
}

/// A guide that names a file, a test or a picture that is not there leads nowhere.
#[test]
fn links_and_paths_in_the_guides_lead_somewhere() {
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    for guide in [
        "README.md",
        "docs/physics.md",
        "docs/systems.md",
        "docs/laws.md",
        "docs/scene.md",
        "docs/real_time.md",
        "docs/unloading.md",
    ] {
        let text = std::fs::read_to_string(root.join(guide)).unwrap();
        let folder = root.join(guide).parent().unwrap().to_path_buf();
        for link in text.split("](").skip(1).filter_map(|rest| rest.split(')').next()) {
            let file = link.split('#').next().unwrap();
            assert!(link.starts_with("http") || file.is_empty() || folder.join(file).exists(), "{guide}: {link}");
        }
        // words in code that look like tests: letters and at least two underscores
        let tests = sources(&root.join("tests"));
        for word in text.split('`').skip(1).step_by(2) {
            let test = word.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_');
            if guide == "docs/physics.md" && test && word.matches('_').count() >= 3 {
                assert!(tests.contains(&format!("fn {word}")), "{guide}: there is no test {word}");
            }
        }
    }
}

/// All that is written below a folder.
fn sources(folder: &std::path::Path) -> String {
    let entries = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let parts = entries.map(|path| match path.is_dir() {
        true => sources(&path),
        false => std::fs::read_to_string(path).unwrap_or_default(),
    });
    parts.collect()
}
