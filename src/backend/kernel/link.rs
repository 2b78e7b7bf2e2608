//! Units put together into one module of naga's. A module has no scopes: its functions, types and variables are known
//! by handles, and names are there for people. So the parts of a unit keep what they are made of, whatever others are
//! called; what units are to share is found by its name here, and here alone.

use super::diagnose::Sources;
use super::reflect::type_name;
use super::{Fragment, KernelError, Unit, UnitId};
use naga::{
    Arena, Block, Constant, Expression, Function, GlobalVariable, Handle, Module, Span, Statement, Type, TypeInner,
};
use std::collections::{BTreeSet, HashMap};
use std::sync::Arc;

/// A parsed unit, and what has become of its parts.
struct Linked<'a> {
    unit: &'a Unit,
    module: Arc<Module>,
    /// Where its text begins in that of all units, and how many bytes of it are common.
    start: u32,
    common: u32,
    copies: Copies,
}

/// Handles in the module of what has been copied there.
#[derive(Default)]
struct Copies {
    types: HashMap<Handle<Type>, Handle<Type>>,
    constants: HashMap<Handle<Constant>, Handle<Constant>>,
    expressions: HashMap<Handle<Expression>, Handle<Expression>>,
    variables: HashMap<Handle<GlobalVariable>, Handle<GlobalVariable>>,
    functions: HashMap<Handle<Function>, Handle<Function>>,
}

impl Linked<'_> {
    fn span(&self, span: Span) -> Span {
        let start = self.start as usize;
        span.to_range().map_or(span, |range| (range.start + start..range.end + start).into())
    }

    /// Whether what stands there is common to all units.
    fn is_common(&self, span: Span) -> bool {
        span.to_range().is_some_and(|range| range.start < self.common as usize)
    }
}

/// The module in the making.
pub(super) struct Linker<'a> {
    module: Module,
    units: Vec<Linked<'a>>,
    sources: &'a Sources,
    /// What units share, by its name in the kernel.
    variables: HashMap<String, Handle<GlobalVariable>>,
    functions: HashMap<String, Handle<Function>>,
    /// Buffers that are nobody else's, whatever they are called.
    unlisted: Vec<Handle<GlobalVariable>>,
}

/// Puts units together, of which the last one has the entry points; `sources` are all their fragments in that order.
/// Places are those in the text of them all.
///
/// # Errors
/// [`KernelError::NoFunction`], [`KernelError::Variable`], and [`KernelError::Wgsl`] for functions that do not fit
/// where they are called.
pub(super) fn link(units: &[(&Unit, Arc<Module>)], sources: &Sources) -> Result<Module, KernelError> {
    let mut linker = Linker {
        module: Module::default(),
        units: Vec::new(),
        sources,
        variables: HashMap::new(),
        functions: HashMap::new(),
        unlisted: Vec::new(),
    };
    let mut start = 0;
    let bytes = |fragments: &[Fragment]| fragments.iter().map(|fragment| fragment.text.len() as u32 + 1).sum::<u32>();
    for (unit, module) in units {
        let common = bytes(&unit.common);
        linker.units.push(Linked { unit, module: module.clone(), start, common, copies: Copies::default() });
        start += common + bytes(&unit.own);
    }
    for number in 0..units.len() {
        linker.add_unit(number, number + 1 == units.len())?;
    }
    linker.name_unlisted();
    Ok(linker.module)
}

impl Linker<'_> {
    fn add_unit(&mut self, unit: usize, is_root: bool) -> Result<(), KernelError> {
        let module = self.units[unit].module.clone();
        if let Some((handle, value)) = module.overrides.iter().next() {
            let name = value.name.as_deref().unwrap_or_default();
            let message = format!("`{name}` is an `override`: nothing would set it");
            let span = self.units[unit].span(module.overrides.get_span(handle));
            return Err(self.sources.error_at(message, span, &["`const` says the same".to_owned()]));
        }
        for (of, &handle) in &module.special_types.predeclared_types {
            let handle = self.add_type(unit, handle);
            self.module.special_types.predeclared_types.insert(of.clone(), handle);
        }
        for (handle, _) in module.global_variables.iter() {
            self.variable(unit, handle, is_root)?;
        }
        if !is_root {
            return Ok(());
        }
        for point in &module.entry_points {
            let function = self.copied(unit, &point.function)?;
            self.module.entry_points.push(naga::EntryPoint { function, ..point.clone() });
        }
        Ok(())
    }

    fn add_type(&mut self, unit: usize, handle: Handle<Type>) -> Handle<Type> {
        if let Some(&known) = self.units[unit].copies.types.get(&handle) {
            return known;
        }
        let module = self.units[unit].module.clone();
        let mut copy = module.types[handle].clone();
        match &mut copy.inner {
            TypeInner::Pointer { base, .. } | TypeInner::Array { base, .. } | TypeInner::BindingArray { base, .. } => {
                *base = self.add_type(unit, *base);
            }
            TypeInner::Struct { members, .. } => {
                for member in members {
                    member.ty = self.add_type(unit, member.ty);
                }
            }
            _ => {}
        }
        // that of an alias: the type is the same
        copy.name.take_if(|_| !matches!(copy.inner, TypeInner::Struct { .. }));
        let span = self.units[unit].span(module.types.get_span(handle));
        let added = self.module.types.insert(copy, span);
        self.units[unit].copies.types.insert(handle, added);
        added
    }

    fn constant(&mut self, unit: usize, handle: Handle<Constant>) -> Handle<Constant> {
        if let Some(&known) = self.units[unit].copies.constants.get(&handle) {
            return known;
        }
        let module = self.units[unit].module.clone();
        let Constant { name, ty, init } = module.constants[handle].clone();
        let copy = Constant { name, ty: self.add_type(unit, ty), init: self.global_expression(unit, init) };
        let span = self.units[unit].span(module.constants.get_span(handle));
        let added = self.module.constants.append(copy, span);
        self.units[unit].copies.constants.insert(handle, added);
        added
    }

    /// An expression outside of functions. Without overrides these are made of values alone; what else there may be
    /// keeps its handles, which the validator refuses.
    fn global_expression(&mut self, unit: usize, handle: Handle<Expression>) -> Handle<Expression> {
        if let Some(&known) = self.units[unit].copies.expressions.get(&handle) {
            return known;
        }
        let module = self.units[unit].module.clone();
        let mut copy = module.global_expressions[handle].clone();
        match &mut copy {
            Expression::Constant(constant) => *constant = self.constant(unit, *constant),
            Expression::ZeroValue(ty) => *ty = self.add_type(unit, *ty),
            Expression::Splat { value, .. } => *value = self.global_expression(unit, *value),
            Expression::Compose { ty, components } => {
                *ty = self.add_type(unit, *ty);
                for component in components {
                    *component = self.global_expression(unit, *component);
                }
            }
            _ => {}
        }
        let span = self.units[unit].span(module.global_expressions.get_span(handle));
        let added = self.module.global_expressions.append(copy, span);
        self.units[unit].copies.expressions.insert(handle, added);
        added
    }

    fn variable(&mut self, unit: usize, handle: Handle<GlobalVariable>, is_root: bool) -> Result<(), KernelError> {
        let module = self.units[unit].module.clone();
        let mut copy = module.global_variables[handle].clone();
        let linked = &self.units[unit];
        let span = module.global_variables.get_span(handle);
        let here = copy.name.clone().unwrap_or_default();
        let is_common = linked.is_common(span);
        let listed = linked.unit.variables.iter().find(|(name, _)| *name == here).map(|(_, there)| there.to_string());
        let shared = match (is_common, copy.binding.is_some()) {
            (true, _) => Some(here),
            (false, true) if is_root => Some(here),
            (false, true) => listed,
            (false, false) => None,
        };
        let span = linked.span(span);
        copy.ty = self.add_type(unit, copy.ty);
        copy.init = copy.init.map(|init| self.global_expression(unit, init));
        let known = shared.as_ref().and_then(|name| self.variables.get(name)).copied();
        let added = match known {
            Some(known) => {
                self.widen(known, &copy)?;
                known
            }
            None => {
                copy.name = shared.clone().or_else(|| copy.name.take());
                let unlisted = shared.is_none() && copy.binding.is_some();
                let added = self.module.global_variables.append(copy, span);
                self.unlisted.extend(unlisted.then_some(added));
                self.variables.extend(shared.map(|name| (name, added)));
                added
            }
        };
        self.units[unit].copies.variables.insert(handle, added);
        Ok(())
    }

    /// A variable of two units: of the same type, and as accessible as either wants it.
    fn widen(&mut self, known: Handle<GlobalVariable>, other: &GlobalVariable) -> Result<(), KernelError> {
        use naga::AddressSpace::Storage;
        let variable = &mut self.module.global_variables[known];
        let as_one = match (&mut variable.space, other.space) {
            (Storage { access }, Storage { access: wanted }) => {
                *access |= wanted;
                true
            }
            (space, wanted) => *space == wanted,
        };
        if as_one && variable.ty == other.ty {
            return Ok(());
        }
        let (name, ty) = (variable.name.clone().unwrap_or_default(), variable.ty);
        let [one, another] = [ty, other.ty].map(|ty| type_name(&self.module, ty));
        let problem = format!("is `{one}` to one part of the kernel and `{another}` to another");
        Err(KernelError::Variable { variable: name, problem })
    }

    /// Other names for buffers that have those of others.
    fn name_unlisted(&mut self) {
        let mut taken: BTreeSet<String> = self.variables.keys().cloned().collect();
        for &handle in &self.unlisted {
            let variable = &mut self.module.global_variables[handle];
            let mut name = variable.name.clone().unwrap_or_default();
            while !taken.insert(name.clone()) {
                name.push('_');
            }
            variable.name = Some(name);
        }
    }

    fn function(&mut self, unit: usize, handle: Handle<Function>) -> Result<Handle<Function>, KernelError> {
        let linked = &self.units[unit];
        if let Some(&known) = linked.copies.functions.get(&handle) {
            return Ok(known);
        }
        let module = linked.module.clone();
        let function = &module.functions[handle];
        let span = module.functions.get_span(handle);
        let name = function.name.clone().unwrap_or_default();
        let (is_common, span) = (linked.is_common(span), linked.span(span));
        let known = if is_common { self.functions.get(&name).copied() } else { None };
        let added = match known {
            Some(known) => known,
            None => {
                let link = linked.unit.links.iter().find(|link| link.function == name);
                let copy = match link.map(|link| link.calls.clone()) {
                    Some(calls) => self.calling(unit, function, &calls)?,
                    None => self.copied(unit, function)?,
                };
                self.module.functions.append(copy, span)
            }
        };
        if is_common {
            self.functions.insert(name, added);
        }
        self.units[unit].copies.functions.insert(handle, added);
        Ok(added)
    }

    /// A function that calls others in place of its body, which is empty or returns what its type calls for.
    fn calling(
        &mut self,
        unit: usize,
        function: &Function,
        calls: &[(UnitId, std::borrow::Cow<'static, str>)],
    ) -> Result<Function, KernelError> {
        let mut copy = self.copied(unit, &Function { body: Block::new(), ..function.clone() })?;
        copy.local_variables = Arena::new();
        copy.named_expressions.clear();
        copy.expressions = Arena::new();
        let arguments: Vec<Handle<Expression>> = (0..copy.arguments.len() as u32)
            .map(|number| copy.expressions.append(Expression::FunctionArgument(number), Span::UNDEFINED))
            .collect();
        let mut value = None;
        for (of, name) in calls {
            let called = self.function_of(*of, name, &copy)?;
            let result = copy.result.is_some().then_some(Expression::CallResult(called));
            value = result.map(|result| copy.expressions.append(result, Span::UNDEFINED));
            let call = Statement::Call { function: called, arguments: arguments.clone(), result: value };
            copy.body.push(call, Span::UNDEFINED);
        }
        copy.body.push(Statement::Return { value }, Span::UNDEFINED);
        Ok(copy)
    }

    /// A unit's function by name, which takes and gives the same as another one.
    fn function_of(&mut self, unit: UnitId, name: &str, wanted: &Function) -> Result<Handle<Function>, KernelError> {
        let linked = &self.units[unit.0];
        let module = linked.module.clone();
        let found = module.functions.iter().find(|(_, function)| function.name.as_deref() == Some(name));
        let Some((handle, _)) = found else {
            let own =
                module.functions.iter().filter(|(handle, _)| !linked.is_common(module.functions.get_span(*handle)));
            return Err(KernelError::NoFunction {
                name: name.to_owned(),
                paths: linked.unit.own.iter().map(|fragment| fragment.path.as_str()).collect::<Vec<_>>().join(" + "),
                found: own.filter_map(|(_, function)| function.name.clone()).collect(),
            });
        };
        let added = self.function(unit.0, handle)?;
        let signature = |function: &Function| -> (Vec<Handle<Type>>, Option<Handle<Type>>) {
            let arguments = function.arguments.iter().map(|argument| argument.ty).collect();
            (arguments, function.result.as_ref().map(|result| result.ty))
        };
        if signature(&self.module.functions[added]) == signature(wanted) {
            return Ok(added);
        }
        let argument = |of: &naga::FunctionArgument| {
            format!("{}: {}", of.name.as_deref().unwrap_or("_"), type_name(&self.module, of.ty))
        };
        let arguments: Vec<String> = wanted.arguments.iter().map(argument).collect();
        let result = wanted.result.as_ref().map(|result| format!(" -> {}", type_name(&self.module, result.ty)));
        let must_be = format!("it must be: fn {name}({}){}", arguments.join(", "), result.unwrap_or_default());
        let span = self.module.functions.get_span(added);
        Err(self.sources.error_at(format!("`{name}` takes or gives something else than its caller"), span, &[must_be]))
    }

    /// A function with handles of the module: those of its expressions and local variables stay.
    fn copied(&mut self, unit: usize, function: &Function) -> Result<Function, KernelError> {
        let mut copy = function.clone();
        copy.diagnostic_filter_leaf = None;
        for argument in &mut copy.arguments {
            argument.ty = self.add_type(unit, argument.ty);
        }
        if let Some(result) = &mut copy.result {
            result.ty = self.add_type(unit, result.ty);
        }
        for (_, mut local, span) in std::mem::take(&mut copy.local_variables).drain() {
            local.ty = self.add_type(unit, local.ty);
            copy.local_variables.append(local, self.units[unit].span(span));
        }
        for (_, mut expression, span) in std::mem::take(&mut copy.expressions).drain() {
            match &mut expression {
                Expression::Constant(constant) => *constant = self.constant(unit, *constant),
                Expression::GlobalVariable(variable) => {
                    // all of the unit's are there already
                    *variable = self.units[unit].copies.variables.get(variable).copied().unwrap_or(*variable);
                }
                Expression::CallResult(called) => *called = self.function(unit, *called)?,
                Expression::ZeroValue(ty)
                | Expression::Compose { ty, .. }
                | Expression::AtomicResult { ty, .. }
                | Expression::WorkGroupUniformLoadResult { ty }
                | Expression::SubgroupOperationResult { ty } => *ty = self.add_type(unit, *ty),
                _ => {}
            }
            copy.expressions.append(expression, self.units[unit].span(span));
        }
        self.block(unit, &mut copy.body)?;
        Ok(copy)
    }

    fn block(&mut self, unit: usize, block: &mut Block) -> Result<(), KernelError> {
        for (statement, span) in block.span_iter_mut() {
            if let Some(span) = span {
                *span = self.units[unit].span(*span);
            }
            match statement {
                Statement::Call { function, .. } => *function = self.function(unit, *function)?,
                Statement::Block(inner) => self.block(unit, inner)?,
                Statement::If { accept, reject, .. } => {
                    self.block(unit, accept)?;
                    self.block(unit, reject)?;
                }
                Statement::Switch { cases, .. } => {
                    for case in cases {
                        self.block(unit, &mut case.body)?;
                    }
                }
                Statement::Loop { body, continuing, .. } => {
                    self.block(unit, body)?;
                    self.block(unit, continuing)?;
                }
                _ => {}
            }
        }
        Ok(())
    }
}
