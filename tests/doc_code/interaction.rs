//! The Rust of docs/interaction.md.
// it shows a function that C calls
#![allow(unsafe_code)]

use sinew::components::Displacement;
use sinew::driver::{Command, Driver};
use sinew::glam::DVec3;
use sinew::port::{DevicePose, ToolPort, VirtualCoupling};
use sinew::scene::schema::OutputField;
use sinew::{BackendChoice, Error, Grip, Host, Options, SceneFile, Simulation};
use std::sync::Mutex;
use std::time::{Duration, Instant};

#[rustfmt::skip]
fn inputs(mut simulation: Simulation) -> Result<(), Error> {
    // curve: Input(name: "tool", initial: 0, rate: 50) in the scene
    simulation.set_input("tool", 0.3)?;
    simulation.advance(10)?;
    for input in simulation.inputs() {
        println!("{} is {}, goes to {}: {:?}", input.name, input.value, input.target, input.uses);
    }
    Ok(())
}

#[rustfmt::skip]
fn tools(mut simulation: Simulation) -> Result<(), Error> {
    // tools: {"probe": (shape: Capsule(length: 0.05, radius: 4e-3), at: (0, 0, 1e-3),
    //     moves: [(displacement: (0, 0, -5e-3), curve: Input(name: "depth", rate: 20))])} in the scene
    simulation.set_input("depth", 0.4)?;
    simulation.advance(10)?;
    let felt = simulation.tool("probe")?;
    println!("{} N, {} N m at {}: {} nodes, {} m deep", felt.force, felt.torque, felt.place, felt.nodes, felt.penetration);
    Ok(())
}

#[rustfmt::skip]
fn a_hand(mut simulation: Simulation) -> Result<(), Error> {
    fn read_device() -> (DVec3, DVec3, f64) {
        (DVec3::ZERO, DVec3::ZERO, 0.0)
    }
    fn write_device(_: DVec3) {}
    // tools: {"probe": (shape: Sphere(radius: 6e-3), at: (0, 0, 0.02),
    //     port: (name: "device 0", speed: 0.3, follow: Proxy(stiffness: 400)))}, real_time: true in the scene
    let mut port = simulation.open_port("device 0")?;
    let mut coupling = VirtualCoupling::new(400.0, 0.0, 3.0); // N/m, N s/m, N
    std::thread::spawn(move || loop {
        let (place, velocity, time) = read_device();          // m, m/s, s
        port.send(&DevicePose { time, place, velocity, ..DevicePose::default() });
        write_device(coupling.force(&port.touch(), place, velocity, time)); // N
    });
    loop {
        simulation.advance_to(simulation.time() + 0.01)?;
    }
}

// filled once, after `open_port` and before the servo starts: from there on the servo alone locks it, and never waits
static HAND: Mutex<Option<(ToolPort, VirtualCoupling, Instant)>> = Mutex::new(None);

#[unsafe(no_mangle)]
extern "C" fn tick(place: &[f64; 3], velocity: &[f64; 3], force: &mut [f64; 3]) {
    *force = [0.0; 3];
    let Ok(mut hand) = HAND.try_lock() else { return };
    let Some((port, coupling, started)) = hand.as_mut() else { return };
    let (place, velocity) = (DVec3::from(*place), DVec3::from(*velocity));
    let time = started.elapsed().as_secs_f64();
    port.send(&DevicePose { time, place, velocity, ..DevicePose::default() });
    *force = coupling.force(&port.touch(), place, velocity, time).to_array();
}

#[rustfmt::skip]
fn materials_and_loads(mut simulation: Simulation) -> Result<(), Error> {
    simulation.change(&[
        "materials.liver.neo_hookean=Young(young: 5e3, poisson: 0.45)".into(),
        "loads[0].acceleration=(0, 0, -3.7)".into(),
    ])?;
    Ok(())
}

#[rustfmt::skip]
fn picking_and_grabbing(scene: SceneFile, eye: DVec3, direction: DVec3) -> Result<(), Error> {
    let options = Options { grabs: true, ..Options::default() };
    let mut simulation = Simulation::new(&scene, &options)?;
    if let Some(pick) = simulation.pick(eye, direction)? {
        let hand = simulation.grab(&pick, &Grip::default())?;
        simulation.move_grab(hand, pick.point + DVec3::Z * 0.01)?;
        simulation.advance(100)?;
        println!("{} N", simulation.grab_force(hand)?);
        simulation.release(hand)?;
    }
    Ok(())
}

#[rustfmt::skip]
fn a_driver(eye: DVec3, direction: DVec3) -> Result<(), Error> {
    fn wake_the_window() {}
    fn draw(_: &[[f32; 3]], _: &[f32]) {}
    let driver = Driver::start(Options::default(), || wake_the_window());
    driver.send(Command::Load(Box::new(SceneFile::load("lens.ron", &[])?)));
    driver.send(Command::Field(Some(OutputField::VonMises)));
    driver.send(Command::Run);
    // once a frame
    let state = driver.state();
    draw(&state.bodies[0].positions, &state.bodies[0].values);
    driver.send(Command::Grab { hand: 0, origin: eye, direction });
    Ok(())
}

#[rustfmt::skip]
fn a_programs_own_device(adapter: wgpu::Adapter, scene: SceneFile, until: f64) -> Result<(), Box<dyn std::error::Error>> {
    fn bind(_: wgpu::Buffer, _: std::ops::Range<u64>, _: Vec<u32>) {}
    fn draw() {}
    let (device, queue) = pollster::block_on(adapter.request_device(&Host::device_descriptor(&adapter)))?;
    let host = Host { adapter, device: device.clone(), queue };
    let options = Options { backend: BackendChoice::Gpu, host: Some(host), ..Options::default() };
    let mut simulation = Simulation::new(&scene, &options)?;
    let Some(lent) = simulation.gpu_column::<Displacement>("lens")? else { return Ok(()) };
    bind(lent.buffer, lent.bytes, lent.node_rows); // f32, three a row; the author's node i is row node_rows[i]
    simulation.advance_for(Duration::from_millis(8), until)?;
    draw(); // submitted after the steps, it reads their last one; nobody waits
    Ok(())
}
