// Viscosity of the isochoric stress; twin of src/materials/prony.rs. TERMS is generated.
struct PronyTerm {
    stress: f32,
    memory: f32,
    rate: f32,
    aim: f32,
}
@group(0) @binding(0) var<uniform> prony: array<PronyTerm, TERMS>;
@group(0) @binding(1) var<storage, read_write> viscous_memory: array<f32>;

fn memory_vector(at: u32) -> vec3<f32> {
    return vec3<f32>(viscous_memory[at], viscous_memory[at + LANES], viscous_memory[at + 2u * LANES]);
}

fn set_memory_vector(at: u32, v: vec3<f32>) {
    viscous_memory[at] = v.x;
    viscous_memory[at + LANES] = v.y;
    viscous_memory[at + 2u * LANES] = v.z;
}

// S_iso − Υ (Pa); the memory is carried on by a step.
fn relaxed(element: u32, point: u32, isochoric: Sym3) -> Sym3 {
    var stress = isochoric;
    for (var number = 0u; number < TERMS; number++) {
        let term = prony[number];
        let at = place(element, 6u * TERMS * POINTS, 6u * (point * TERMS + number));
        let memory = Sym3(memory_vector(at), memory_vector(at + 3u * LANES));
        let overstress = sym_plus(sym_scaled(isochoric, term.stress), sym_scaled(memory, term.memory));
        stress = sym_plus(stress, sym_scaled(overstress, -1.0));
        let change = sym_scaled(sym_plus(sym_scaled(isochoric, term.aim), sym_scaled(memory, -1.0)), term.rate);
        set_memory_vector(at, memory.diagonal + change.diagonal);
        set_memory_vector(at + 3u * LANES, memory.others + change.others);
    }
    return stress;
}
