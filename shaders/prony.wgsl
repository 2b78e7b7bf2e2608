// Viscosity; twin of src/materials/prony.rs. Generated: TERMS of the isochoric stress, then VOLUMETRIC_TERMS of the
// pressure.
struct PronyTerm {
    stress: f32,
    memory: f32,
    rate: f32,
    aim: f32,
}
@group(0) @binding(0) var<uniform> prony: array<PronyTerm, TERMS + VOLUMETRIC_TERMS>;
@group(0) @binding(1) var<storage, read_write> viscous_memory: array<f32>;

// Numbers of history that an element has.
const MEMORY: u32 = 6u * TERMS * POINTS + VOLUMETRIC_TERMS;

fn memory_vector(at: u32) -> vec3<f32> {
    return vec3<f32>(viscous_memory[at], viscous_memory[at + LANES], viscous_memory[at + 2u * LANES]);
}

fn set_memory_vector(at: u32, v: vec3<f32>) {
    viscous_memory[at] = v.x;
    viscous_memory[at + LANES] = v.y;
    viscous_memory[at + 2u * LANES] = v.z;
}

// S_iso − Υ (Pa); the memory is carried on by a step, but where forces are only tried.
fn relaxed(element: u32, point: u32, isochoric: Sym3) -> Sym3 {
    var stress = isochoric;
    for (var number = 0u; number < TERMS; number++) {
        let term = prony[number];
        let at = place(element, MEMORY, 6u * (point * TERMS + number));
        let memory = Sym3(memory_vector(at), memory_vector(at + 3u * LANES));
        let overstress = sym_plus(sym_scaled(isochoric, term.stress), sym_scaled(memory, term.memory));
        stress = sym_plus(stress, sym_scaled(overstress, -1.0));
        let change = sym_scaled(sym_plus(sym_scaled(isochoric, term.aim), sym_scaled(memory, -1.0)), term.rate);
        if step.trying == 0u {
            set_memory_vector(at, memory.diagonal + change.diagonal);
            set_memory_vector(at + 3u * LANES, memory.others + change.others);
        }
    }
    return stress;
}

// p − Υ (Pa); the memory is carried on by a step at the last of the points, which all have the same pressure.
fn relaxed_pressure(element: u32, point: u32, instant: f32) -> f32 {
    var pressure = instant;
    for (var number = 0u; number < VOLUMETRIC_TERMS; number++) {
        let term = prony[TERMS + number];
        let at = place(element, MEMORY, 6u * TERMS * POINTS + number);
        let memory = viscous_memory[at];
        pressure -= term.stress * instant + term.memory * memory;
        if point + 1u == POINTS && step.trying == 0u {
            viscous_memory[at] = memory + term.rate * (term.aim * instant - memory);
        }
    }
    return pressure;
}
