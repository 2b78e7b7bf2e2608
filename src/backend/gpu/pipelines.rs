//! From a kernel's description to a pipeline and its buffers.

use std::collections::HashMap;
use std::num::NonZeroU64;
use std::sync::Arc;

use wgpu::{
    BindGroup, BindGroupDescriptor, BindGroupEntry, BindGroupLayout, BindGroupLayoutDescriptor, BindGroupLayoutEntry,
    BindingResource, BindingType, BufferBinding, BufferBindingType, ComputePipeline, ComputePipelineDescriptor,
    PipelineCompilationOptions, PipelineLayoutDescriptor, ShaderModule, ShaderModuleDescriptor, ShaderSource,
    ShaderStages,
};

use super::quirks::read_from_storage;
use super::run::PACKED_HEADER;
use super::{BufferKind, Gpu, GpuError};
use crate::backend::kernel::{
    Binding, BindingKind, Composed, Composer, EntryPoint, Kernel, KernelError, KernelId, NameMismatch,
    STEP_RECORDS_VARIABLE, STEP_VARIABLE,
};

/// Modules by text and pipelines by text and entry point: bodies of one kind share them.
#[derive(Default)]
pub(super) struct Pipelines {
    composer: Composer,
    modules: HashMap<String, Arc<Module>>,
    pipelines: HashMap<(String, &'static str), (ComputePipeline, BindGroupLayout)>,
}

struct Module {
    composed: Arc<Composed>,
    shader: ShaderModule,
    /// Uniforms that are read from storage buffers.
    moved: Vec<String>,
}

/// A kernel with everything a dispatch needs.
pub(super) struct Prepared {
    pub(super) label: String,
    pub(super) pipeline: ComputePipeline,
    pub(super) group: BindGroup,
    /// Bytes of the step's record, for kernels that use it.
    pub(super) record: Option<u32>,
    /// Bytes of a step's record, for kernels that run all steps of a submission in one dispatch.
    pub(super) packed_record: Option<u32>,
    /// Workgroups in x and y; 0 runs nothing.
    pub(super) groups: (u32, u32),
    workgroup: u32,
}

impl Gpu {
    /// Makes a kernel ready: composes, compiles (once a text) and binds its buffers by name.
    ///
    /// # Errors
    /// [`GpuError::Kernel`] for wrong WGSL and names that do not match, [`GpuError::Unfit`] for a buffer that is too
    /// small or of the wrong kind, [`GpuError::OverLimit`] for too many storage buffers or threads.
    pub fn prepare(&mut self, kernel: &Kernel) -> Result<KernelId, GpuError> {
        self.check("an earlier call")?;
        let key = kernel.key();
        let module = self.module(kernel, &key)?;
        let composed = module.composed.as_ref();
        let entry = composed.entry(kernel.entry).ok_or_else(|| KernelError::NoEntry {
            label: kernel.label.clone(),
            entry: kernel.entry.to_owned(),
            paths: kernel.paths(),
            found: composed.entries.iter().map(|e| e.name.clone()).collect(),
        })?;
        match_names(kernel, composed, entry)?;
        let is_moved = |binding: &Binding| module.moved.contains(&binding.name);
        let moved = entry.uses.iter().filter(|i| is_moved(&composed.bindings[**i])).count();
        let storage = composed.storage_buffers(entry);
        let uniforms = (entry.uses.len() - storage) as u64;
        let limit = u64::from(self.limits.max_uniform_buffers_per_shader_stage);
        self.within(&kernel.label, uniforms, limit, "uniform buffers", "maxUniformBuffersPerShaderStage")?;
        let limit = u64::from(self.limits.max_storage_buffers_per_shader_stage);
        let storage = (storage + moved) as u64;
        self.within(&kernel.label, storage, limit, "storage buffers", "maxStorageBuffersPerShaderStage")?;
        let memory = u64::from(self.limits.max_compute_workgroup_storage_size);
        let wanted = u64::from(entry.workgroup_memory);
        self.within(&kernel.label, wanted, memory, "bytes of workgroup memory", "maxComputeWorkgroupStorageSize")?;
        let workgroup = entry.workgroup_size.iter().product::<u32>().max(1);
        let groups = self.groups(&kernel.label, kernel.threads, workgroup)?;
        let (pipeline, layout) = self.pipeline(kernel, key, &module, entry)?;
        let group = self.bind_group(kernel, composed, entry, &layout)?;
        let bytes_of =
            |name| entry.uses.iter().map(|i| &composed.bindings[*i]).find(|b| b.name == name).map(|b| b.size);
        let record = bytes_of(STEP_VARIABLE);
        let packed_record = bytes_of(STEP_RECORDS_VARIABLE).map(|bytes| bytes.saturating_sub(PACKED_HEADER as u32));
        let label = kernel.label.clone();
        self.kernels.push(Prepared { label, pipeline, group, record, packed_record, groups, workgroup });
        Ok(KernelId(self.kernels.len() as u32 - 1))
    }

    /// A kernel put together, once for all that have its text.
    ///
    /// # Errors
    /// Those of [`Composer::compose`].
    pub fn compose(&mut self, kernel: &Kernel) -> Result<Arc<Composed>, KernelError> {
        self.pipelines.composer.compose(kernel)
    }

    /// Changes the number of invocations of a kernel, for the runs to come.
    ///
    /// # Errors
    /// [`GpuError::Unknown`], [`GpuError::OverLimit`].
    pub fn set_threads(&mut self, id: KernelId, threads: u32) -> Result<(), GpuError> {
        let kernel = self.kernel(id)?;
        let groups = self.groups(&kernel.label, threads, kernel.workgroup)?;
        self.kernels[id.0 as usize].groups = groups;
        Ok(())
    }

    /// Uniforms of all kernels that are read from storage buffers.
    #[cfg(test)]
    pub(super) fn moved_uniforms(&self) -> Vec<String> {
        self.pipelines.modules.values().flat_map(|module| module.moved.clone()).collect()
    }

    pub(super) fn kernel(&self, id: KernelId) -> Result<&Prepared, GpuError> {
        self.kernels.get(id.0 as usize).ok_or_else(|| GpuError::Unknown(format!("kernel {}", id.0)))
    }

    fn module(&mut self, kernel: &Kernel, key: &str) -> Result<Arc<Module>, GpuError> {
        if let Some(known) = self.pipelines.modules.get(key) {
            return Ok(known.clone());
        }
        let composed = self.compose(kernel)?;
        let mut module = composed.module().clone();
        let moved = self.safe_uniforms.map(|safe| read_from_storage(&mut module, safe)).unwrap_or_default();
        let source = ShaderSource::Naga(std::borrow::Cow::Owned(module));
        let descriptor = ShaderModuleDescriptor { label: Some(&kernel.label), source };
        let shader = self.heard(|| self.device.create_shader_module(descriptor));
        self.check(&format!("the shader of kernel `{}` ({})", kernel.label, kernel.paths()))?;
        let module = Arc::new(Module { composed, shader, moved });
        self.pipelines.modules.insert(key.to_owned(), module.clone());
        Ok(module)
    }

    fn pipeline(
        &mut self,
        kernel: &Kernel,
        key: String,
        module: &Module,
        entry: &EntryPoint,
    ) -> Result<(ComputePipeline, BindGroupLayout), GpuError> {
        let key = (key, kernel.entry);
        if let Some(known) = self.pipelines.pipelines.get(&key) {
            return Ok(known.clone());
        }
        let label = Some(kernel.label.as_str());
        let bindings = entry.uses.iter().map(|i| &module.composed.bindings[*i]);
        let entries: Vec<_> = bindings.map(|b| layout_entry(b, module.moved.contains(&b.name))).collect();
        let (layout, pipeline) = self.heard(|| {
            let layout = self.device.create_bind_group_layout(&BindGroupLayoutDescriptor { label, entries: &entries });
            let pipeline_layout = self.device.create_pipeline_layout(&PipelineLayoutDescriptor {
                label,
                bind_group_layouts: &[Some(&layout)],
                immediate_size: 0,
            });
            let pipeline = self.device.create_compute_pipeline(&ComputePipelineDescriptor {
                label,
                layout: Some(&pipeline_layout),
                module: &module.shader,
                entry_point: Some(kernel.entry),
                // kernels write workgroup memory before they read it
                compilation_options: PipelineCompilationOptions {
                    zero_initialize_workgroup_memory: false,
                    ..Default::default()
                },
                cache: None,
            });
            (layout, pipeline)
        });
        self.check(&format!("the pipeline of kernel `{}` (`{}` in {})", kernel.label, kernel.entry, kernel.paths()))?;
        self.pipelines.pipelines.insert(key, (pipeline.clone(), layout.clone()));
        Ok((pipeline, layout))
    }

    fn bind_group(
        &self,
        kernel: &Kernel,
        composed: &Composed,
        entry: &EntryPoint,
        layout: &BindGroupLayout,
    ) -> Result<BindGroup, GpuError> {
        let mut entries = Vec::new();
        for binding in entry.uses.iter().map(|i| &composed.bindings[*i]) {
            let resource = if binding.name == STEP_VARIABLE {
                self.records.binding(binding.size)
            } else if binding.name == STEP_RECORDS_VARIABLE {
                self.records.packed()
            } else {
                no_alias(self, kernel, composed, entry, binding)?;
                self.buffer_binding(kernel, binding)?
            };
            let resource = BindingResource::Buffer(resource);
            entries.push(BindGroupEntry { binding: binding.index, resource });
        }
        let label = Some(kernel.label.as_str());
        let group = BindGroupDescriptor { label, layout, entries: &entries };
        let group = self.heard(|| self.device.create_bind_group(&group));
        self.check(&format!("the buffers of kernel `{}`", kernel.label))?;
        Ok(group)
    }

    fn buffer_binding(&self, kernel: &Kernel, binding: &Binding) -> Result<BufferBinding<'_>, GpuError> {
        let given = kernel.bindings.iter().find(|(name, _)| *name == binding.name);
        let id = given.map(|(_, id)| *id).ok_or_else(|| GpuError::Unknown(format!("buffer of `{}`", binding.name)))?;
        let slot = self.slot(id)?;
        let problem = match (binding.kind, slot.kind) {
            (BindingKind::Uniform, BufferKind::Storage) => {
                "the variable is a uniform, the buffer a storage one".to_owned()
            }
            (BindingKind::Read | BindingKind::ReadWrite, BufferKind::Uniform) => {
                "the variable is storage, the buffer a uniform one".to_owned()
            }
            _ if slot.buffer.size() < u64::from(binding.size) => {
                format!("{} bytes, `{}` needs {}", slot.bytes, binding.type_name, binding.size)
            }
            _ => return Ok(slot.buffer.as_entire_buffer_binding()),
        };
        let (kernel, variable) = (kernel.label.clone(), binding.name.clone());
        Err(GpuError::Unfit { kernel, buffer: slot.label.clone(), variable, problem })
    }

    /// Workgroups in x and y for this many invocations.
    fn groups(&self, label: &str, threads: u32, workgroup: u32) -> Result<(u32, u32), GpuError> {
        let most = u64::from(self.limits.max_compute_workgroups_per_dimension.max(1));
        let groups = u64::from(threads.div_ceil(workgroup));
        let y = groups.div_ceil(most).max(1);
        let x = groups.div_ceil(y);
        self.within(label, y, most, "workgroups in y", "maxComputeWorkgroupsPerDimension")?;
        // row numbers beyond 32 bits would wrap round and work on the first rows a second time
        let rows = x * y * u64::from(workgroup);
        self.within(label, rows, u64::from(u32::MAX), "invocations", "the 32-bit row number")?;
        Ok((x as u32, y as u32))
    }
}

fn layout_entry(binding: &Binding, moved: bool) -> BindGroupLayoutEntry {
    let ty = match binding.kind {
        BindingKind::Uniform if moved => BufferBindingType::Storage { read_only: true },
        BindingKind::Uniform => BufferBindingType::Uniform,
        BindingKind::Read => BufferBindingType::Storage { read_only: true },
        BindingKind::ReadWrite => BufferBindingType::Storage { read_only: false },
    };
    let has_dynamic_offset = binding.name == STEP_VARIABLE;
    let min_binding_size = NonZeroU64::new(u64::from(binding.size));
    BindGroupLayoutEntry {
        binding: binding.index,
        visibility: ShaderStages::COMPUTE,
        ty: BindingType::Buffer { ty, has_dynamic_offset, min_binding_size },
        count: None,
    }
}

/// A buffer that a kernel writes must not be seen under a second name: WebGPU forbids it, and the order of reads and
/// writes would be left to chance.
fn no_alias(
    gpu: &Gpu,
    kernel: &Kernel,
    composed: &Composed,
    entry: &EntryPoint,
    binding: &Binding,
) -> Result<(), GpuError> {
    let buffer = |b: &Binding| kernel.bindings.iter().find(|(name, _)| *name == b.name).map(|(_, id)| *id);
    let Some(id) = buffer(binding).filter(|_| binding.kind == BindingKind::ReadWrite) else { return Ok(()) };
    let mut others = entry.uses.iter().map(|i| &composed.bindings[*i]).filter(|b| b.name != binding.name);
    let Some(other) = others.find(|b| buffer(b) == Some(id)) else { return Ok(()) };
    Err(GpuError::Unfit {
        kernel: kernel.label.clone(),
        buffer: gpu.slot(id)?.label.clone(),
        variable: binding.name.clone(),
        problem: format!("it is bound to `{}` too, and `{}` is written", other.name, binding.name),
    })
}

/// Variables that this layer binds itself.
const OWN_VARIABLES: [&str; 2] = [STEP_VARIABLE, STEP_RECORDS_VARIABLE];

/// Every variable in use has a buffer and every buffer a variable, once.
fn match_names(kernel: &Kernel, composed: &Composed, entry: &EntryPoint) -> Result<(), KernelError> {
    let used: Vec<_> = entry.uses.iter().map(|i| composed.bindings[*i].name.clone()).collect();
    let given: Vec<_> = kernel.bindings.iter().map(|(name, _)| name.clone().into_owned()).collect();
    let without_buffer: Vec<_> =
        used.iter().filter(|name| !OWN_VARIABLES.contains(&name.as_str()) && !given.contains(name)).cloned().collect();
    let mut without_variable = Vec::new();
    for (index, name) in given.iter().enumerate() {
        if given[..index].contains(name) {
            without_variable.push(format!("{name} (given twice)"));
        } else if OWN_VARIABLES.contains(&name.as_str()) {
            without_variable.push(format!("{name} (bound by the GPU layer)"));
        } else if composed.binding(name).is_none() {
            without_variable.push(name.clone());
        }
    }
    if without_buffer.is_empty() && without_variable.is_empty() {
        return Ok(());
    }
    Err(KernelError::from(Box::new(NameMismatch {
        label: kernel.label.clone(),
        entry: kernel.entry.to_owned(),
        paths: kernel.paths(),
        without_buffer,
        without_variable,
        used,
        declared: composed.bindings.iter().map(|b| b.name.clone()).collect(),
        given,
    })))
}
