//! What probes saw and energies were in the course of time, for plots.

use sinew::driver::State;

/// Numbers by time.
#[derive(Debug, Default)]
pub struct Traces {
    scene: Option<u64>,
    /// Times (s).
    times: Vec<f64>,
    /// Kinetic energy, strain energy and work of loads (J), then all numbers of all probes.
    columns: Vec<Vec<f64>>,
}

/// So many points of a curve are kept: of more every second one goes.
const MOST: usize = 4000;
/// What the first columns are.
pub const ENERGIES: [&str; 3] = ["kinetic", "strain", "work of loads"];

impl Traces {
    /// Takes note of a state; what came later than it is forgotten.
    pub fn note(&mut self, state: &State) {
        let Some(loaded) = &state.loaded else { return };
        if self.scene != Some(loaded.number) {
            *self = Self { scene: Some(loaded.number), ..Self::default() };
        }
        // a run that went back goes on from there
        let kept = self.times.partition_point(|time| *time < state.measured);
        self.times.truncate(kept);
        let e = &state.energies;
        let energies = [e.kinetic, e.strain, e.load_work.unwrap_or(0.0)];
        let numbers: Vec<f64> = energies.into_iter().chain(state.probes.iter().flatten().copied()).collect();
        self.columns.resize(numbers.len(), Vec::new());
        self.times.push(state.measured);
        for (column, number) in self.columns.iter_mut().zip(numbers) {
            column.truncate(kept);
            column.resize(kept, f64::NAN);
            column.push(number);
        }
        if self.times.len() > MOST {
            let thin = |numbers: &mut Vec<f64>| *numbers = numbers.iter().copied().step_by(2).collect();
            thin(&mut self.times);
            self.columns.iter_mut().for_each(thin);
        }
    }

    /// All of it as CSV: a row for each time (s), a column for each energy (J) and each number of a probe, which are
    /// given by names and numbers with units; what is no number is empty. A page writes no files.
    #[cfg(not(target_arch = "wasm32"))]
    pub fn table<'a>(&self, probes: impl Iterator<Item = (&'a str, &'a [String])>) -> String {
        let energies = ENERGIES.iter().map(|name| format!("{name} (J)"));
        let of_probes =
            probes.flat_map(|(probe, numbers)| numbers.iter().map(move |number| format!("{probe} {number}")));
        let heads = std::iter::once("t (s)".to_string()).chain(energies).chain(of_probes);
        let quoted = |head: String| match head.contains([',', '"', '\n']) {
            true => format!("\"{}\"", head.replace('"', "\"\"")),
            false => head,
        };
        let mut text = heads.map(quoted).collect::<Vec<_>>().join(",") + "\n";
        for (row, time) in self.times.iter().enumerate() {
            text += &time.to_string();
            for column in &self.columns {
                text.push(',');
                let number = column.get(row).filter(|number| number.is_finite());
                text += &number.map(f64::to_string).unwrap_or_default();
            }
            text.push('\n');
        }
        text
    }

    /// The points of a column that are numbers.
    pub fn points(&self, column: usize) -> Vec<[f64; 2]> {
        let numbers = self.columns.get(column).map(Vec::as_slice).unwrap_or_default();
        let points = self.times.iter().zip(numbers).map(|(time, number)| [*time, *number]);
        points.filter(|[_, number]| number.is_finite()).collect()
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use sinew::driver::{Command, Session};

    #[test]
    fn a_run_that_goes_back_has_one_past() {
        let text = include_str!("../../../scenes/cube_under_gravity.ron").replace("(10, 10, 10)", "(2, 2, 2)");
        let scene = sinew::SceneFile::from_text("cube.ron", &text, std::path::Path::new(""), &[]).unwrap();
        let mut session = Session::new(sinew::Options::default());
        session.command(Command::Load(Box::new(scene)));
        let mut traces = Traces::default();
        for _ in 0..5 {
            session.command(Command::Step(2));
            traces.note(&session.state());
        }
        assert_eq!(traces.points(0).len(), 5);
        // three of energies, then the probe of the ground and that of the top, three each
        let top = traces.points(8);
        assert!(top[4][1] < top[0][1] && top[4][1] < 0.0, "{top:?}");
        let state = session.state();
        let probes = &state.loaded.as_ref().unwrap().probes;
        let table = traces.table(probes.iter().map(|(name, numbers)| (name.as_str(), numbers.as_slice())));
        let lines: Vec<Vec<&str>> = table.lines().map(|line| line.split(',').collect()).collect();
        assert_eq!((lines.len(), lines[0][0], lines[0][9]), (6, "t (s)", "top uz (m)"));
        for (line, [time, number]) in lines[1..].iter().zip(&top) {
            assert_eq!((line.len(), line[0], line[9]), (10, &*time.to_string(), &*number.to_string()));
        }
        session.command(Command::Reset);
        session.command(Command::Step(3));
        traces.note(&session.state());
        assert_eq!(traces.points(0).len(), 2);
    }
}
