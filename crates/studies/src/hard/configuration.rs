//! How a hard case is run.

use sinew::components::Precision;
use sinew::mesh::ElementKind;
use sinew::{BackendChoice, Options};

/// Elements, backend and number type.
#[derive(Clone, Debug)]
pub struct CaseConfiguration {
    /// Elements of every mesh of the case.
    pub elements: ElementKind,
    /// Where, and in which number type.
    pub options: Options,
    /// Whether by implicit steps, and statics by Newton's iterations.
    pub implicit: bool,
}

impl CaseConfiguration {
    /// The word of the elements in scenes.
    pub fn elements_name(&self) -> &'static str {
        self.elements.name()
    }

    /// `CPU f64`, `CPU f32`, `GPU f32` or `CPU f64, implicit`.
    pub fn machine(&self) -> &'static str {
        match (self.options.backend, self.options.precision) {
            _ if self.implicit => "CPU f64, implicit",
            (BackendChoice::Gpu, _) => "GPU f32",
            (_, Precision::F64) => "CPU f64",
            (_, Precision::F32) => "CPU f32",
        }
    }

    /// Whether it runs on a GPU.
    pub fn is_gpu(&self) -> bool {
        self.options.backend == BackendChoice::Gpu
    }

    /// Whether numbers are f64.
    pub fn is_f64(&self) -> bool {
        self.options.precision == Precision::F64
    }

    /// Whether small bodies take the least time there: the CPU in f32.
    pub fn is_quickest(&self) -> bool {
        !self.is_f64() && !self.is_gpu()
    }

    /// Whether elements are tetrahedra.
    pub fn is_tets(&self) -> bool {
        matches!(self.elements, ElementKind::Tet4 | ElementKind::Tet4NodalPressure)
    }

    /// Every element on CPU f64, CPU f32 and, if it is wanted, GPU f32; and by implicit steps.
    pub fn all(gpu: bool) -> Vec<Self> {
        let machines = [
            (BackendChoice::Cpu, Precision::F64, false),
            (BackendChoice::Cpu, Precision::F32, false),
            (BackendChoice::Gpu, Precision::F32, false),
            (BackendChoice::Cpu, Precision::F64, true),
        ];
        let elements =
            [ElementKind::Tet4, ElementKind::Tet4NodalPressure, ElementKind::Hex8, ElementKind::Hex8MeanDilatation];
        let machines = machines.into_iter().filter(|machine| gpu || machine.0 != BackendChoice::Gpu);
        machines
            .flat_map(|(backend, precision, implicit)| {
                let options = Options { backend, precision, threads: 1, ..Options::default() };
                elements.map(|elements| Self { elements, options: options.clone(), implicit })
            })
            .collect()
    }
}
