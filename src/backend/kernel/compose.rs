//! From fragments, and units of them, to one checked module.

use naga::proc::Layouter;
use naga::valid::{Capabilities, ValidationFlags, Validator};
use naga::{AddressSpace, Module, ResourceBinding, ShaderStage};

use super::diagnose::Sources;
use super::link::link;
use super::reflect::{binding, members, type_name};
use super::{Binding, BindingKind, Fragment, Kernel, KernelError, Member, STEP_RECORDS_VARIABLE, STEP_VARIABLE, Unit};
use std::collections::HashMap;
use std::sync::Arc;

/// A compute entry point.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct EntryPoint {
    /// Name of the function.
    pub name: String,
    /// Invocations of a workgroup in x, y and z.
    pub workgroup_size: [u32; 3],
    /// Bytes of workgroup memory it uses.
    pub workgroup_memory: u32,
    /// Buffer variables it uses, itself or through the functions it calls: indices into [`Composed::bindings`].
    pub uses: Vec<usize>,
}

/// Fragments put together, found valid, and what they declare.
#[derive(Clone, Debug)]
pub struct Composed {
    /// Every buffer variable declared, used or not.
    pub bindings: Vec<Binding>,
    /// Every compute entry point.
    pub entries: Vec<EntryPoint>,
    module: Module,
    structs: Vec<Struct>,
}

#[derive(Clone, Debug)]
struct Struct {
    name: String,
    /// bytes, with the padding at the end
    size: u32,
    members: Vec<Member>,
}

/// Concatenates fragments, checks them as WebGPU would, and gives every buffer variable a binding number of its own.
///
/// # Errors
/// [`KernelError::Wgsl`] with the fragment's file, line and column; [`KernelError::Variable`] for textures and samplers
/// and for a `step` that is no uniform.
pub fn compose(fragments: &[Fragment]) -> Result<Composed, KernelError> {
    let sources = Sources::new(fragments);
    checked(parsed(fragments, &sources)?, &sources)
}

/// Kernels put together so far: each text is parsed once, and each kernel composed once, whatever asks for it.
#[derive(Debug, Default)]
pub struct Composer {
    parsed: HashMap<String, Arc<Module>>,
    composed: HashMap<String, Arc<Composed>>,
}

impl Composer {
    /// Composes a kernel, units and all.
    ///
    /// # Errors
    /// Those of [`compose`], [`KernelError::NoFunction`] for a unit without a function that others call, and
    /// [`KernelError::Variable`] for a buffer that is of different types to its units.
    pub fn compose(&mut self, kernel: &Kernel) -> Result<Arc<Composed>, KernelError> {
        let key = kernel.key();
        if let Some(known) = self.composed.get(&key) {
            return Ok(known.clone());
        }
        let composed = Arc::new(self.put_together(kernel)?);
        self.composed.insert(key, composed.clone());
        Ok(composed)
    }

    fn put_together(&mut self, kernel: &Kernel) -> Result<Composed, KernelError> {
        if kernel.units.is_empty() {
            return compose(&kernel.fragments);
        }
        let root = kernel.root();
        let mut units: Vec<(&Unit, Arc<Module>)> = Vec::new();
        for unit in kernel.units.iter().chain([&root]) {
            let key = unit.key();
            let module = match self.parsed.get(&key) {
                Some(known) => known.clone(),
                None => {
                    let module = Arc::new(parsed(unit.fragments(), &Sources::new(unit.fragments()))?);
                    self.parsed.insert(key, module.clone());
                    module
                }
            };
            units.push((unit, module));
        }
        let sources = Sources::new(kernel.units.iter().chain([&root]).flat_map(Unit::fragments));
        checked(link(&units, &sources)?, &sources)
    }
}

fn parsed<'a>(fragments: impl IntoIterator<Item = &'a Fragment>, sources: &Sources) -> Result<Module, KernelError> {
    let mut module = naga::front::wgsl::parse_str(sources.text()).map_err(|e| sources.parse_error(&e))?;
    for name in fragments.into_iter().flat_map(|fragment| &fragment.private) {
        let may_be = |space| matches!(space, AddressSpace::Uniform | AddressSpace::Private);
        let mut variables = module.global_variables.iter_mut().map(|(_, variable)| variable);
        let uniform = variables.find(|found| may_be(found.space) && found.name.as_deref() == Some(name));
        let uniform = uniform.ok_or_else(|| variable_error(name, "is no uniform".to_owned()))?;
        (uniform.space, uniform.binding) = (AddressSpace::Private, None);
    }
    Ok(module)
}

/// Checks a module, and tells what it declares.
fn checked(mut module: Module, sources: &Sources) -> Result<Composed, KernelError> {
    number_bindings(&mut module);
    let mut validator = Validator::new(ValidationFlags::all(), Capabilities::empty());
    let info = validator.validate(&module).map_err(|e| sources.validation_error(&e))?;
    let mut layouts = Layouter::default();
    layouts.update(module.to_ctx()).map_err(|e| variable_error("the types", e.to_string()))?;

    let mut bindings = Vec::new();
    let mut handles = Vec::new();
    for (handle, variable) in module.global_variables.iter() {
        let Some(place) = variable.binding else { continue };
        let name = variable.name.as_deref().unwrap_or_default();
        let found = binding(&module, &layouts, variable, place.binding)
            .ok_or_else(|| variable_error(name, "is not a buffer".to_owned()))?;
        if name == STEP_VARIABLE && found.kind != BindingKind::Uniform {
            return Err(variable_error(name, "holds the step's record and must be a var<uniform>".to_owned()));
        }
        if name == STEP_RECORDS_VARIABLE && found.kind != BindingKind::Read {
            return Err(variable_error(name, "holds the steps' records and must be a var<storage, read>".to_owned()));
        }
        bindings.push(found);
        handles.push(handle);
    }
    let mut entries = Vec::new();
    for (index, point) in module.entry_points.iter().enumerate().filter(|(_, p)| p.stage == ShaderStage::Compute) {
        let used = info.get_entry_point(index);
        let uses = (0..handles.len()).filter(|i| !used[handles[*i]].is_empty()).collect();
        let shared = module
            .global_variables
            .iter()
            .filter(|(handle, variable)| variable.space == AddressSpace::WorkGroup && !used[*handle].is_empty());
        entries.push(EntryPoint {
            name: point.name.clone(),
            workgroup_size: point.workgroup_size,
            workgroup_memory: shared.map(|(_, variable)| layouts[variable.ty].size).sum(),
            uses,
        });
    }
    let structs = module.types.iter().filter_map(|(handle, ty)| {
        let members = members(&module, &layouts, &ty.inner)?;
        Some(Struct { name: ty.name.clone()?, size: layouts[handle].size, members })
    });
    let structs = structs.collect();
    Ok(Composed { bindings, entries, module, structs })
}

/// Fragments of different authors may use the same `@binding` number: buffers are bound by name, numbers are given
/// here.
fn number_bindings(module: &mut Module) {
    let bound = module.global_variables.iter_mut().filter(|(_, variable)| variable.binding.is_some());
    for (number, (_, variable)) in bound.enumerate() {
        variable.binding = Some(ResourceBinding { group: 0, binding: number as u32 });
    }
}

fn variable_error(variable: &str, problem: String) -> KernelError {
    KernelError::Variable { variable: variable.to_owned(), problem }
}

impl Composed {
    /// The members of a WGSL struct, in order.
    ///
    /// # Errors
    /// [`KernelError::NoStruct`] lists the structs there are.
    pub fn struct_layout(&self, name: &str) -> Result<Vec<Member>, KernelError> {
        Ok(self.find_struct(name)?.members.clone())
    }

    /// Bytes of a WGSL struct, with the padding at its end: what `size_of` of its Rust twin must be.
    ///
    /// # Errors
    /// [`KernelError::NoStruct`] lists the structs there are.
    pub fn struct_size(&self, name: &str) -> Result<u32, KernelError> {
        Ok(self.find_struct(name)?.size)
    }

    fn find_struct(&self, name: &str) -> Result<&Struct, KernelError> {
        self.structs.iter().find(|s| s.name == name).ok_or_else(|| KernelError::NoStruct {
            name: name.to_owned(),
            found: self.structs.iter().map(|s| s.name.clone()).collect(),
        })
    }

    /// Types of the arguments of a WGSL function, and of its result.
    pub fn signature(&self, name: &str) -> Option<(Vec<String>, Option<String>)> {
        let (_, function) = self.module.functions.iter().find(|(_, f)| f.name.as_deref() == Some(name))?;
        let arguments = function.arguments.iter().map(|argument| type_name(&self.module, argument.ty)).collect();
        Some((arguments, function.result.as_ref().map(|result| type_name(&self.module, result.ty))))
    }

    /// A binding by the name of its variable.
    pub fn binding(&self, name: &str) -> Option<&Binding> {
        self.bindings.iter().find(|b| b.name == name)
    }

    /// An entry point by name.
    pub fn entry(&self, name: &str) -> Option<&EntryPoint> {
        self.entries.iter().find(|e| e.name == name)
    }

    /// Storage buffers that an entry point uses; WebGPU promises [`super::MostBuffers`].
    pub fn storage_buffers(&self, entry: &EntryPoint) -> usize {
        entry.uses.iter().filter(|i| self.bindings[**i].kind != BindingKind::Uniform).count()
    }

    /// The checked module, for the GPU layer.
    pub(crate) fn module(&self) -> &Module {
        &self.module
    }
}
