//! What a scene may ask for at most. A slip of the finger or a hostile file is told here, by name, before it takes all
//! memory, time or disk; `docs/scene.md` lists the same numbers.

/// Bytes of a scene's text.
pub const TEXT_BYTES: usize = 16 << 20;
/// Bytes of one `--set`.
pub const SET_BYTES: usize = 64 << 10;
/// How often `--set` may be given.
pub const SETS: usize = 1000;
/// Numbers, texts, words and brackets of a scene, counted one by one.
pub const VALUES: usize = 2_000_000;
/// Bodies; materials; regions of a body; tools.
pub const BODIES: usize = 1000;
/// Constraints; loads; contacts; attachments; removals; probes; suctions.
pub const ACTIONS: usize = 10_000;
/// Tools that a body may meet.
pub const TOOLS_OF_A_BODY: usize = 8;
/// Elements that a tool takes at a time.
pub const MOST_BURST: u32 = 1024;
/// Parts, parts of parts among them.
pub const PARTS: usize = 1000;
/// Parts within each other.
pub const PART_DEPTH: usize = 8;
/// Systems of a scene's own.
pub const SYSTEMS: usize = 100;
/// Points of a table, places of a tool's path; a longer signal is thinned out before.
pub const TABLE_POINTS: usize = 100_000;
/// Whole turns of a tool on its path, all legs together.
pub const MOST_TURNS: f64 = 1000.0;
/// Terms of each of a material's series (viscosity, families of fibres); moves of a tool.
pub const TERMS: usize = 100;
/// Bytes of a name in UTF-8, of a body, material, set or probe: files are named after some, and no file name may have
/// more than 255.
pub const NAME_BYTES: usize = 100;
/// Pixels of a picture in width and in height: there must be room for its legend.
pub const PICTURE: [std::ops::RangeInclusive<u32>; 2] = [320..=8192, 240..=8192];
/// Magnifications of a picture: beyond, single precision would show.
pub const ZOOM: std::ops::RangeInclusive<f64> = 0.01..=1000.0;
/// Entries of a picture's `opacity`.
pub const OPACITIES: usize = 100;
/// Times that a mesh is refined: each makes eight elements of one, ten a billion.
pub const MOST_REFINEMENT: u32 = 9;

/// Copies of a mesh.
pub const MOST_COPIES: u32 = 100_000;
/// Elements of all bodies together, after `refine`. Element forces are addressed by 32 bits: 24 numbers a hexahedron.
pub const ELEMENTS: u64 = 100_000_000;
/// VTU files of a run.
pub const FRAMES: u64 = 1_000_000;
/// Rows of each table of a run.
pub const ROWS: u64 = 100_000_000;
/// Pseudo-steps of a static analysis.
pub const PSEUDO_STEPS: u64 = 1_000_000_000;
/// Points of a path of equilibria.
pub const PATH_POINTS: u32 = 100_000;
/// Bytes of a law or system of one's own.
pub const LAW_BYTES: u64 = 1 << 20;
/// Bytes of a formula of an energy.
pub const FORMULA_BYTES: usize = 64 << 10;
/// Words, numbers and signs of a law or system of one's own, comments left out.
pub const LAW_WORDS: usize = 20_000;
/// Functions, structs, constants and other declarations of a law or system of one's own; arrays in it.
pub const LAW_DECLARATIONS: usize = 500;
/// Operators, brackets and branches of a law or system of one's own that are within each other.
pub const LAW_DEPTH: usize = 500;
/// Corrections of contact forces in a step.
pub const MOST_SWEEPS: u32 = 100;
/// Mistakes that are kept; there is enough to do.
pub(super) const MISTAKES: usize = 100_000;
/// Places where a text is no RON, after which reading it is given up.
pub(super) const FAULTS: usize = 1000;

/// What whoever loads a scene allows it. Scenes of strangers are best read with the default, or less.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Allowed {
    /// Whether the scene may name files outside its own folder: by an absolute path, by `..`, or by a link that leads
    /// out.
    pub outside: bool,
    /// The most elements of all bodies together, after `refine`; [`ELEMENTS`] at most.
    pub elements: u64,
}

impl Default for Allowed {
    fn default() -> Self {
        Self { outside: false, elements: ELEMENTS }
    }
}

impl Allowed {
    /// The default, and files anywhere.
    pub fn files_anywhere() -> Self {
        Self { outside: true, ..Self::default() }
    }
}
