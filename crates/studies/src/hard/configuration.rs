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
}

impl CaseConfiguration {
    /// The word of the elements in scenes.
    pub fn elements_name(&self) -> &'static str {
        self.elements.name()
    }

    /// `CPU f64`, `CPU f32` or `GPU f32`.
    pub fn machine(&self) -> &'static str {
        match (self.options.backend, self.options.precision) {
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

    /// Every element on CPU f64, CPU f32 and, if it is wanted, GPU f32.
    pub fn all(gpu: bool) -> Vec<Self> {
        let machines = [
            (BackendChoice::Cpu, Precision::F64),
            (BackendChoice::Cpu, Precision::F32),
            (BackendChoice::Gpu, Precision::F32),
        ];
        let elements =
            [ElementKind::Tet4, ElementKind::Tet4NodalPressure, ElementKind::Hex8, ElementKind::Hex8MeanDilatation];
        let machines = machines.into_iter().filter(|machine| gpu || machine.0 != BackendChoice::Gpu);
        machines
            .flat_map(|(backend, precision)| {
                let options = Options { backend, precision, threads: 1, ..Options::default() };
                elements.map(|elements| Self { elements, options: options.clone() })
            })
            .collect()
    }
}
