//! An explanation as a page for people.

use super::{Buffer, ContactInUse, Explanation, KernelInUse, Part, SolverInUse, SystemInUse};
use crate::backend::dispatch::NodeKernel;
use std::fmt::{Display, Formatter, Result};

impl Display for Explanation {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        if !self.title.is_empty() {
            writeln!(f, "{}", self.title)?;
        }
        writeln!(f, "{} nodes, {} elements", self.nodes, self.elements)?;
        writeln!(f, "on {}, {}: {}", self.backend, self.precision, self.backend_because)?;
        if let Some(time_step) = &self.time_step {
            writeln!(f, "steps of {time_step}")?;
        }
        if !self.scene_parts.is_empty() {
            writeln!(f, "\nParts of the scene")?;
        }
        for part in &self.scene_parts {
            let from = if part.file.is_empty() { "the scene itself" } else { &part.file };
            let brings = if part.brings.is_empty() { "nothing".into() } else { part.brings.join(", ") };
            writeln!(f, "  {:<16}  from {from}, brings {brings}", part.name)?;
        }
        writeln!(f, "\nSystems, in the order of a step")?;
        self.systems.iter().try_for_each(|system| write_system(system, self.on_gpu, f))?;
        if !self.systems_off.is_empty() {
            writeln!(f, "\nSystems that are off")?;
        }
        for system in &self.systems_off {
            writeln!(f, "  {:<16}  turned on by {}", system.name, system.turned_on_by)?;
        }
        self.parts.iter().try_for_each(|part| write_part(part, f))?;
        if self.on_gpu {
            writeln!(f, "\nAll steps of a submission in one dispatch")?;
        }
        for body in &self.dispatched {
            let on = if body.many_steps { "yes" } else { "no " };
            writeln!(f, "  {:<16}  {on}  {}", body.body, body.because)?;
        }
        if self.on_gpu {
            writeln!(f, "\nNodes that move with the patch that they are inside")?;
        }
        for body in &self.dispatched {
            writeln!(f, "  {:<16}  {}  {}", body.body, body.interior, body.interior_because)?;
        }
        let parted = |of: &&NodeKernel| !of.because.is_empty();
        let mut kernels = self
            .dispatched
            .iter()
            .flat_map(|of| of.node_kernels.iter().filter(parted).map(|kernel| (&of.body, kernel)));
        if let Some(first) = kernels.next() {
            writeln!(f, "\nWhy nodes have another kernel")?;
            for (body, NodeKernel { systems, because, .. }) in std::iter::once(first).chain(kernels) {
                writeln!(f, "  {body:<16}  after {}: {because}", systems.join(" + "))?;
            }
        }
        self.kernels.iter().try_for_each(|kernel| write_kernel(kernel, f))?;
        if let Some(SolverInUse { of, held }) = &self.solver {
            writeln!(f, "\nWhat solves")?;
            of.iter().try_for_each(|line| writeln!(f, "  {line}"))?;
            write_held(held, f)?;
        }
        self.contacts.iter().try_for_each(|contact| write_contact(contact, f))?;
        if self.on_gpu {
            write_buffers("Buffers on the device", &self.buffers, self.device_bytes, f)?;
        }
        write_buffers("Columns on the host", &self.columns, self.host_bytes, f)?;
        let place = if self.on_gpu { "device" } else { "host" };
        writeln!(f, "\n{:.0} bytes an element on the {place}", self.bytes_an_element)
    }
}

fn write_system(system: &SystemInUse, on_gpu: bool, f: &mut Formatter<'_>) -> Result {
    writeln!(f, "  {:<16}  {}", system.name, system.does)?;
    let every = if system.every == 1 { String::new() } else { format!(", in every {}th step", system.every) };
    let place = match (on_gpu, system.on, system.kernels) {
        (false, ..) => String::new(),
        (true, "device", 0) => ", on the device, where it needs no kernel".to_string(),
        (true, "device", 1) => ", on the device, 1 kernel".to_string(),
        (true, "device", kernels) => format!(", on the device, {kernels} kernels"),
        (true, ..) => ", on the host".to_string(),
    };
    writeln!(f, "  {:16}  because: {}{place}{every}", "", system.because)?;
    if let Some(sums) = &system.sums {
        writeln!(f, "  {:16}  {sums}", "")?;
    }
    if let Some(repeat) = &system.repeat {
        writeln!(f, "  {:16}  {repeat}", "")?;
    }
    if let Some(rows) = &system.rows {
        writeln!(f, "  {:16}  for {rows}", "")?;
    }
    if !system.shares_with.is_empty() {
        writeln!(f, "  {:16}  in one pass with {}", "", system.shares_with.join(", "))?;
    }
    let Some(travels) = &system.travels else { return Ok(()) };
    let list = |names: &[&str], bytes: u64| match names {
        [] => "nothing".to_string(),
        names => format!("{} ({bytes} bytes)", names.join(", ")),
    };
    writeln!(f, "  {:16}  brings to the host in each run: {}", "", list(&travels.brought, travels.brought_bytes))?;
    writeln!(f, "  {:16}  sends back in each run: {}", "", list(&travels.sent, travels.sent_bytes))
}

fn write_part(part: &Part, f: &mut Formatter<'_>) -> Result {
    writeln!(f, "\n{}: {}", capital(&part.name), part.size)?;
    for effect in &part.effects {
        match &effect.on {
            Some(parameters) => writeln!(f, "  {:<16}  on   {parameters}", effect.name)?,
            None => writeln!(f, "  {:<16}  off  turned on by {}", effect.name, effect.turned_on_by)?,
        }
    }
    match &part.cpu_variant {
        Some(variant) => writeln!(f, "  {:<16}  {variant}", "compiled kernel"),
        None => Ok(()),
    }
}

fn write_kernel(kernel: &KernelInUse, f: &mut Formatter<'_>) -> Result {
    let workgroups = kernel.threads.div_ceil(kernel.workgroup.max(1));
    let times = if kernel.times == 1 { String::new() } else { format!(", {} times in a step", kernel.times) };
    writeln!(f, "\nKernel {} (system {}){times}", kernel.label, kernel.system)?;
    let KernelInUse { entry, threads, workgroup, workgroup_memory, storage_buffers, lines, .. } = kernel;
    let shared = match workgroup_memory {
        0 => String::new(),
        bytes => format!(", which share {bytes} bytes"),
    };
    writeln!(f, "  fn {entry}: {threads} invocations in {workgroups} workgroups of {workgroup}{shared};")?;
    writeln!(f, "  {storage_buffers} storage buffers; {lines} lines of")?;
    for piece in &kernel.fragments {
        writeln!(f, "    {:>4}  {}", piece.lines, piece.path)?;
    }
    for bound in &kernel.bindings {
        writeln!(f, "  {:<10}  {:<26} <- {} ({} bytes)", bound.access, bound.variable, bound.buffer, bound.bytes)?;
    }
    Ok(())
}

fn write_contact(contact: &ContactInUse, f: &mut Formatter<'_>) -> Result {
    writeln!(f, "\nContact by {}", contact.system)?;
    contact.of.iter().try_for_each(|line| writeln!(f, "  {line}"))?;
    write_held(&contact.held, f)?;
    if contact.bytes_a_face > 0.0 {
        writeln!(f, "  {:>12.0}  bytes a face, columns of contact with them", contact.bytes_a_face)?;
    }
    Ok(())
}

fn write_held(held: &[(&str, u64)], f: &mut Formatter<'_>) -> Result {
    held.iter().try_for_each(|(name, bytes)| writeln!(f, "  {bytes:>12}  bytes of {name}"))
}

fn write_buffers(heading: &str, buffers: &[Buffer], total: u64, f: &mut Formatter<'_>) -> Result {
    writeln!(f, "\n{heading}: {total} bytes")?;
    for buffer in buffers {
        let of = if buffer.of.is_empty() { String::new() } else { format!(" of {}", buffer.of) };
        writeln!(f, "  {:>12}  {}{of}", buffer.bytes, buffer.name)?;
    }
    Ok(())
}

fn capital(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}
