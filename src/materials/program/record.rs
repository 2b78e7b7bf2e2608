//! A law that somebody wrote in Rust over any kind of number, recorded: run once over numbers that note what is done to
//! them, it is known as a graph, and so as programs and as WGSL.

use super::Untranslatable;
use super::energy::{bearable, function};
use super::graph::{Binary, Graph, Id, Unary};
use super::tape::Program;
use crate::materials::{Elastic, Kinematics};
use crate::math::{Mat3, Real, Sym3, Task};
use naga::Span;
use std::cell::RefCell;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// A law in Rust as programs for the CPU and as WGSL for a GPU, its parameters put in.
#[derive(Clone, Debug)]
pub struct RecordedLaw {
    /// S_iso (Pa) of the numbers of `Kinematics`.
    pub isochoric: Program,
    /// U'(θ) (Pa) of θ.
    pub pressure: Program,
    /// Ψ_iso (J/m³) of the numbers of `Kinematics`.
    pub isochoric_energy: Program,
    /// U(θ) (J/m³) of θ.
    pub volumetric_energy: Program,
    /// The same as the text of a law in WGSL; it has no uniform.
    pub wgsl: String,
}

/// The numbers of `Kinematics` in the order of its WGSL twin, as expressions there.
const KINEMATICS: [&str; 16] = [
    "k.green_strain.diagonal.x",
    "k.green_strain.diagonal.y",
    "k.green_strain.diagonal.z",
    "k.green_strain.others.x",
    "k.green_strain.others.y",
    "k.green_strain.others.z",
    "k.adjugate_c.diagonal.x",
    "k.adjugate_c.diagonal.y",
    "k.adjugate_c.diagonal.z",
    "k.adjugate_c.others.x",
    "k.adjugate_c.others.y",
    "k.adjugate_c.others.z",
    "k.volume_change",
    "k.j",
    "k.true_j",
    "k.j_m23",
];

/// Records a law.
///
/// # Errors
/// Strain measures of its own, operations that look at the bits of a number, and more values than an element can be
/// asked to compute.
pub fn record<L: Elastic<f64>>(law: &L) -> Result<RecordedLaw, Untranslatable> {
    let isochoric = Recording::of(|| {
        let k = inputs();
        law_of(law).isochoric(&k).0.to_vec()
    })?;
    let isochoric_energy = Recording::of(|| vec![law_of(law).isochoric_energy(&inputs())])?;
    let pressure = Recording::of(|| vec![law_of(law).pressure(Recorded::input(0))])?;
    let volumetric_energy = Recording::of(|| vec![law_of(law).volumetric_energy(Recorded::input(0))])?;
    check_measures(law)?;
    let kinematics = KINEMATICS.map(str::to_owned);
    let volume = ["volume_change".to_owned()];
    let mut text = String::from("// Recorded from a law in Rust.\n");
    let (lines, names) = isochoric.wgsl(&kinematics)?;
    let stress = format!("Sym3(vec3<f32>({}), vec3<f32>({}))", names[..3].join(", "), names[3..].join(", "));
    text += &function("elastic_isochoric(k: Kinematics)", "Sym3", &lines, &stress);
    let (lines, names) = pressure.wgsl(&volume)?;
    text += &function("elastic_pressure(volume_change: f32)", "f32", &lines, &names[0]);
    let (lines, names) = isochoric_energy.wgsl(&kinematics)?;
    text += &function("elastic_isochoric_energy(k: Kinematics)", "f32", &lines, &names[0]);
    let (lines, names) = volumetric_energy.wgsl(&volume)?;
    text += &function("elastic_volumetric_energy(volume_change: f32)", "f32", &lines, &names[0]);
    Ok(RecordedLaw {
        isochoric: isochoric.program(KINEMATICS.len())?,
        pressure: pressure.program(1)?,
        isochoric_energy: isochoric_energy.program(KINEMATICS.len())?,
        volumetric_energy: volumetric_energy.program(1)?,
        wgsl: text,
    })
}

fn law_of<L: Elastic<f64>>(law: &L) -> L::Of<Recorded> {
    law.map(Recorded::number)
}

/// `Kinematics` of numbers that are not known yet.
fn inputs() -> Kinematics<Recorded> {
    let six = |first: u16| Sym3([0, 1, 2, 3, 4, 5].map(|k| Recorded::input(first + k)));
    let [volume_change, j, true_j, j_m23] = [12, 13, 14, 15].map(Recorded::input);
    Kinematics { green_strain: six(0), adjugate_c: six(6), volume_change, j, true_j, j_m23 }
}

/// Elements and shaders know one kind of strain measures for laws of one's own: those that [`Elastic`] gives a law
/// which says nothing of them. What is computed from the same numbers in the same way is the same value of a graph.
fn check_measures<L: Elastic<f64>>(law: &L) -> Result<(), Untranslatable> {
    let gradient = || Mat3([0, 3, 6].map(|row| [0, 1, 2].map(|column| Recorded::input(row + column))));
    let numbers = |k: &Kinematics<Recorded>| {
        let all = k.green_strain.0.into_iter().chain(k.adjugate_c.0);
        all.chain([k.volume_change, k.j, k.true_j, k.j_m23]).map(|number| number.0).collect::<Vec<_>>()
    };
    let mut same = [false; 4];
    Recording::of(|| {
        let law = law_of(law);
        let (own, expected) = (law.kinematics(&gradient()), Kinematics::new(&gradient()));
        let (k, number, six) = (inputs(), Recorded::input(16), Sym3([17, 18, 19, 20, 21, 22].map(Recorded::input)));
        let ids = |stress: Sym3<Recorded>| stress.0.map(|number| number.0);
        same = [
            numbers(&own) == numbers(&expected),
            law.volume_measure(&k).0 == k.volume_change.0,
            ids(law.volumetric(&k, number)) == ids(k.adjugate_c.scaled(number / k.j)),
            ids(law.without_pressure(&k, six)) == ids(k.without_pressure(&six)),
        ];
        Vec::new()
    })?;
    let names = ["kinematics", "volume_measure", "volumetric", "without_pressure"];
    match names.into_iter().zip(same).find(|(_, same)| !same) {
        None => Ok(()),
        Some((name, _)) => {
            let message = format!("it has a `{name}` of its own");
            Err(Untranslatable::new(Span::UNDEFINED, message)
                .note("laws of one's own are of J − 1 and of the strains of `Kinematics::new`: leave it out"))
        }
    }
}

/// What was done to numbers, and what came of it.
struct Recording {
    graph: Graph,
    outputs: Vec<Id>,
}

/// The recording that is being made.
#[derive(Default)]
struct Running {
    graph: Graph,
    /// What was asked of a number that a recording cannot know.
    unknown: Option<&'static str>,
}

thread_local! {
    static RUNNING: RefCell<Running> = RefCell::default();
}

impl Recording {
    /// Of a computation, which must not make one itself.
    fn of(task: impl FnOnce() -> Vec<Recorded>) -> Result<Self, Untranslatable> {
        RUNNING.take();
        let outputs: Vec<Id> = task().into_iter().map(|number| number.0).collect();
        let Running { graph, unknown } = RUNNING.take();
        if let Some(name) = unknown {
            return Err(Untranslatable::new(Span::UNDEFINED, format!("it asks a number for its `{name}`"))
                .note("it reads bits, which differ on a GPU: use exp, ln, sqrt, inverse_cbrt, sin and cos"));
        }
        bearable(&graph, &outputs, Span::UNDEFINED)?;
        Ok(Self { graph, outputs })
    }

    fn program(&self, inputs: usize) -> Result<Program, Untranslatable> {
        Program::new(&self.graph, inputs, &self.outputs)
    }

    fn wgsl(&self, inputs: &[String]) -> Result<(String, Vec<String>), Untranslatable> {
        self.graph.wgsl(&self.outputs, inputs)
    }
}

/// A number that is not known: what is done to it is noted.
#[derive(Clone, Copy, Debug)]
pub struct Recorded(Id);

fn note(what: impl FnOnce(&mut Graph) -> Id) -> Recorded {
    Recorded(RUNNING.with_borrow_mut(|running| what(&mut running.graph)))
}

impl Recorded {
    fn number(value: f64) -> Self {
        note(|graph| graph.constant(value))
    }

    fn input(number: u16) -> Self {
        note(|graph| graph.input(number))
    }

    fn unary(self, function: Unary) -> Self {
        note(|graph| graph.unary(function, self.0))
    }

    fn binary(self, function: Binary, other: Self) -> Self {
        note(|graph| graph.binary(function, self.0, other.0))
    }

    fn unknown(self, name: &'static str) -> Self {
        RUNNING.with_borrow_mut(|running| running.unknown = Some(name));
        self
    }
}

macro_rules! operators {
    ($($operator:ident, $method:ident: $function:ident;)*) => {$(
        impl $operator for Recorded {
            type Output = Self;
            fn $method(self, other: Self) -> Self {
                self.binary(Binary::$function, other)
            }
        }
    )*};
}
operators! {
    Add, add: Add;
    Sub, sub: Subtract;
    Mul, mul: Multiply;
    Div, div: Divide;
}

impl Neg for Recorded {
    type Output = Self;
    fn neg(self) -> Self {
        self.unary(Unary::Negate)
    }
}

impl AddAssign for Recorded {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl SubAssign for Recorded {
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl Real for Recorded {
    const EPSILON: f64 = f64::EPSILON;

    fn constant(self, value: f64) -> Self {
        Self::number(value)
    }
    fn mul_add(self, factor: Self, summand: Self) -> Self {
        self * factor + summand
    }
    fn max(self, other: Self) -> Self {
        self.binary(Binary::Max, other)
    }
    fn min(self, other: Self) -> Self {
        self.binary(Binary::Min, other)
    }
    fn inverse_cbrt(self) -> Self {
        self.unary(Unary::InverseCbrt)
    }
    fn sqrt(self) -> Self {
        self.unary(Unary::Sqrt)
    }
    fn if_positive(self, then: Self, otherwise: Self) -> Self {
        note(|graph| graph.select(self.0, then.0, otherwise.0))
    }
    fn power_of_two(self) -> Self {
        self.unknown("power_of_two")
    }
    fn mantissa_and_exponent(self) -> (Self, Self) {
        (self.unknown("mantissa_and_exponent"), self)
    }
    fn outlined<T: Task<Self>>(self, task: T) -> T::Output {
        task.run()
    }
    fn abs(self) -> Self {
        self.unary(Unary::Abs)
    }
    fn round(self) -> Self {
        self.unknown("round")
    }
    fn exp(self) -> Self {
        self.unary(Unary::Exp)
    }
    fn exp_m1(self) -> Self {
        self.unary(Unary::ExpLessOne)
    }
    fn ln(self) -> Self {
        self.unary(Unary::Log)
    }
    fn ln_1p(self) -> Self {
        self.unary(Unary::LogOfOnePlus)
    }
    fn sin(self) -> Self {
        self.unary(Unary::Sine)
    }
    fn cos(self) -> Self {
        self.unary(Unary::Cosine)
    }
}
