//! A simulation that is driven, without a thread: the host steps it once a frame.

use super::command::Command;
use super::grabs::Hands;
use super::look::Look;
use super::pace::Pace;
use super::state::{Picked, Refusal, State};
use crate::assembly::element_step;
use crate::components::{Authoring, Block, Label};
use crate::error::Error;
use crate::{Ended, Options, Pick, SceneFile, Simulation, Snapshot};
use std::time::Duration;

/// States to go back to are kept so often in the time of a scene, in so many bytes at most.
const KEPT: (f64, usize) = (200.0, 256 << 20);

/// A simulation that is driven by [`Command`]s, one step of a frame at a time.
pub struct Session {
    options: Options,
    run: Option<Run>,
    running: bool,
    pace: Pace,
    refusal: Option<Refusal>,
    commands: u64,
    look: Look,
}

/// A scene at work.
struct Run {
    simulation: Simulation,
    /// Whether hands can hold something.
    grabs: bool,
    hands: Hands,
    picked: Option<Picked>,
    /// Whether it goes on where the scene ends.
    beyond: bool,
}

impl Run {
    /// Whether it stands where the scene ends.
    fn is_over(&self) -> bool {
        self.simulation.is_finished() && !self.beyond
    }

    /// Goes on where the scene ends if a hand holds something, and says whether one does.
    fn goes_on_in_hands(&mut self) -> bool {
        self.beyond = self.hands.hold() && !self.simulation.scene().is_static();
        self.beyond
    }
}

impl Session {
    /// A session without a scene. What is loaded can be grabbed, whatever the options say; what is restored, if it
    /// could be where it was kept.
    pub fn new(options: Options) -> Self {
        let options = Options { grabs: true, ..options };
        let look = Look::default();
        Self { options, run: None, running: false, pace: Pace::new(), refusal: None, commands: 0, look }
    }

    /// The simulation, for what no command does; none before a scene is loaded.
    pub fn simulation(&mut self) -> Option<&mut Simulation> {
        self.run.as_mut().map(|run| &mut run.simulation)
    }

    /// Whether [`advance`](Self::advance) takes steps.
    pub fn is_running(&self) -> bool {
        self.running && self.run.as_ref().is_some_and(|run| run.simulation.failure().is_none())
    }

    /// Does what a command asks. What is refused changes nothing, and is told by the next [`state`](Self::state).
    pub fn command(&mut self, command: Command) {
        self.commands += 1;
        let name = name_of(&command);
        match self.obey(command) {
            Ok(()) => drop(self.refusal.take_if(|refusal| refusal.command == name)),
            // a breakdown is a state of its own
            Err(Error::Unstable(_)) => {}
            // that there is no scene tells less than why
            Err(_) if self.run.is_none() && name != "load" && self.was_refused("load") => {}
            Err(error) => self.refusal = Some(refusal(name, &error)),
        }
    }

    fn was_refused(&self, command: &str) -> bool {
        self.refusal.as_ref().is_some_and(|told| told.command == command)
    }

    /// Takes the steps that are due after some time on the wall, for as long as a budget of it lasts; at least one, if
    /// any is.
    pub fn advance(&mut self, wall: Duration, budget: Duration) {
        if !self.is_running() {
            return;
        }
        let Some(run) = &mut self.run else { return };
        if run.is_over() && !run.goes_on_in_hands() {
            self.running = false;
            return;
        }
        let before = run.simulation.time();
        let end = if run.beyond { f64::INFINITY } else { run.simulation.scene().duration };
        let until = self.pace.until(before, wall).min(end);
        match run.simulation.advance_for(budget, until) {
            Ok(advanced) => {
                let now = run.simulation.time();
                self.pace.note(now, advanced.simulated, wall.max(advanced.took), advanced.why == Ended::Budget);
                self.running = advanced.why != Ended::Rest;
            }
            Err(error) => {
                self.running = false;
                if !matches!(error, Error::Unstable(_)) {
                    self.refusal = Some(refusal("run", &error));
                }
            }
        }
    }

    /// The simulation as it is now.
    pub fn state(&mut self) -> State {
        let running = self.is_running();
        let mut state = State {
            running,
            speed: self.pace.speed,
            real_time_factor: self.pace.factor().filter(|_| running),
            commands: self.commands,
            ..State::default()
        };
        if let Some(run) = &mut self.run {
            state.picked = run.picked.clone();
            if let Err(error) = self.look.at(&mut run.simulation, &run.hands, running, &mut state) {
                self.running = false;
                self.refusal = Some(refusal("run", &error));
            }
        }
        state.refusal = self.refusal.clone();
        state
    }

    fn obey(&mut self, command: Command) -> Result<(), Error> {
        match command {
            Command::Load(scene) => return self.load(&scene),
            Command::Speed(speed) if speed > 0.0 => {
                self.pace.speed = speed;
                return Ok(());
            }
            Command::Speed(speed) => {
                return Err(Error::Options(format!("time cannot go {speed} times as fast: it must be above 0")));
            }
            Command::Field(field) => {
                self.look.field = field;
                return Ok(());
            }
            Command::Arrows(Some(field)) if !field.is_of_nodes() || field.components() != 3 => {
                return Err(Error::Options(format!("{} has no vectors of nodes", field.array())));
            }
            Command::Lend(lends) => {
                self.look.lends = lends;
                return Ok(());
            }
            Command::Arrows(field) => {
                self.look.arrows = field;
                return Ok(());
            }
            _ => {}
        }
        let Some(run) = &mut self.run else {
            return Err(Error::Options("there is no scene yet: load one first".into()));
        };
        if matches!(command, Command::Run | Command::Step(_)) && run.simulation.failure().is_some() {
            return Err(Error::Options("it broke down and cannot go on: go back, or load another scene".into()));
        }
        match command {
            Command::Run => {
                run.beyond |= run.is_over() && !run.simulation.scene().is_static();
                self.running = true;
                self.pace.stand(run.simulation.time());
            }
            Command::Pause => self.running = false,
            Command::Step(count) => {
                self.running = false;
                run.simulation.advance(count)?;
            }
            Command::Reset | Command::Rewind(_) => {
                match command {
                    Command::Rewind(to) => run.simulation.rewind(to).map(drop)?,
                    _ => run.simulation.reset()?,
                }
                self.stand()?;
            }
            Command::Restore(snapshot) => self.restore(&snapshot)?,
            Command::Set(sets) => {
                run.simulation.change(&sets)?;
                self.look.measure_anew();
            }
            Command::Input { name, value } => run.simulation.set_input(&name, value)?,
            Command::Grab { hand, origin, direction } => {
                run.hands.grab(hand, (origin, direction), &mut run.simulation)?;
                self.go_on_in_hands();
            }
            Command::GrabAt { hand, pick } => {
                run.hands.take(hand, *pick, &mut run.simulation)?;
                self.go_on_in_hands();
            }
            Command::MoveGrab { hand, target } => run.hands.move_to(hand, target, &mut run.simulation)?,
            Command::Release { hand } => run.hands.release(hand, &mut run.simulation)?,
            Command::Pick { origin, direction } => {
                let pick = run.simulation.pick(origin, direction)?;
                run.picked = picked(&mut run.simulation, pick)?;
            }
            Command::PickAt(pick) => run.picked = picked(&mut run.simulation, pick.map(|pick| *pick))?,
            Command::Load(_) | Command::Speed(_) | Command::Field(_) | Command::Arrows(_) | Command::Lend(_) => {}
        }
        Ok(())
    }

    /// Goes on beyond the scene's end where a hand has taken hold of something there.
    fn go_on_in_hands(&mut self) {
        let Some(run) = &mut self.run else { return };
        if run.is_over() && run.goes_on_in_hands() {
            self.running = true;
            self.pace.stand(run.simulation.time());
        }
    }

    /// Over to a state that was kept elsewhere, where hands can hold something if they could there.
    fn restore(&mut self, snapshot: &Snapshot) -> Result<(), Error> {
        let (Some(run), Some(scene)) = (&mut self.run, self.look.scene()) else { return Ok(()) };
        let grabs = Simulation::can_grab_in(snapshot)?;
        if run.grabs == grabs {
            run.simulation.restore(snapshot)?;
        } else {
            let mut simulation = Simulation::new(&scene, &Options { grabs, ..self.options.clone() })?;
            simulation.restore(snapshot)?;
            self.begin(&scene, simulation, grabs)?;
        }
        self.stand()
    }

    /// Stands in a state without hands that hold something.
    fn stand(&mut self) -> Result<(), Error> {
        let Some(run) = &mut self.run else { return Ok(()) };
        run.hands.all_open(&mut run.simulation)?;
        (run.beyond, run.picked) = (false, None);
        self.look.measure_anew();
        self.pace.stand(run.simulation.time());
        Ok(())
    }

    fn load(&mut self, scene: &SceneFile) -> Result<(), Error> {
        let simulation = Simulation::new(scene, &self.options)?;
        self.begin(scene, simulation, self.options.grabs)
    }

    /// Begins with a simulation of a scene; `grabs`: whether hands can hold something in it.
    fn begin(&mut self, scene: &SceneFile, mut simulation: Simulation, grabs: bool) -> Result<(), Error> {
        if !scene.scene.is_static() {
            // with less, time cannot be gone back but to the start
            let _ = simulation.keep_history(scene.scene.duration / KEPT.0, KEPT.1);
        }
        self.look.begin(scene, &mut simulation)?;
        self.pace.stand(simulation.time());
        self.run = Some(Run { simulation, grabs, hands: Hands::default(), picked: None, beyond: false });
        Ok(())
    }
}

/// Why a command is not obeyed.
fn refusal(command: &'static str, error: &Error) -> Refusal {
    let mistakes = if let Error::Scene(wrong) = error { wrong.placed() } else { Vec::new() };
    Refusal { mistakes, ..Refusal::new(command, error.to_string()) }
}

/// The word by which a refusal names a command.
fn name_of(command: &Command) -> &'static str {
    match command {
        Command::Run | Command::Pause => "run",
        Command::Step(_) => "step",
        Command::Speed(_) => "speed",
        Command::Reset | Command::Rewind(_) => "reset",
        Command::Restore(_) => "restore",
        Command::Set(_) => "set",
        Command::Input { .. } => "input",
        Command::Grab { .. } | Command::GrabAt { .. } | Command::MoveGrab { .. } | Command::Release { .. } => "grab",
        Command::Pick { .. } | Command::PickAt(_) => "pick",
        Command::Field(_) => "field",
        Command::Arrows(_) => "arrows",
        Command::Lend(_) => "lend",
        Command::Load(_) => "load",
    }
}

/// What was picked, and whose that is; nothing of a body that has no such node.
fn picked(simulation: &mut Simulation, pick: Option<Pick>) -> Result<Option<Picked>, Error> {
    let Some(pick) = pick else { return Ok(None) };
    let heaviest = (0..3).max_by(|&a, &b| pick.weights[a].total_cmp(&pick.weights[b])).unwrap_or(0);
    let node = pick.nodes[heaviest];
    let body = simulation.body(&pick.body)?;
    let world = simulation.world();
    let authoring = world.get::<Authoring>(body).filter(|authoring| (node as usize) < authoring.node_rows.len());
    let Some(authoring) = authoring else { return Ok(None) };
    let element = (0..authoring.cells.len()).find(|place| authoring.element_ids.of(*place) == pick.element);
    let at = element.and_then(|place| {
        let (block, row) = *authoring.element_rows.get(place)?;
        Some((*authoring.blocks.get(block as usize)?, row as usize))
    });
    let material = at.and_then(|(block, _)| world.get::<Label>(world.get::<Block>(block)?.material));
    let material = material.map(|label| label.0.clone()).unwrap_or_default();
    let step = at.and_then(|(block, row)| element_step(world, block, row));
    let node_number = authoring.node_ids.of(node as usize);
    Ok(Some(Picked { node, node_number, element: element.unwrap_or(0), material, step, pick }))
}
