//! What the machine can do at best, measured.

use pulp::{Simd, WithSimd};
use serde::{Deserialize, Serialize};
use sinew::backend::cpu::{Cpu, Instructions};
use sinew::math::{Real, SimdScalar};
use std::time::Instant;

/// Bounds for a number of threads.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct Machine {
    /// Threads.
    pub threads: usize,
    /// The instruction set in use.
    pub instructions: String,
    /// Bytes read and written a second by copying arrays that no cache holds.
    pub bytes_per_s: f64,
    /// Operations of f32 a second by fused multiply-adds in registers.
    pub flops_per_s: f64,
}

/// Numbers of the arrays that are copied: 64 MB each.
const NUMBERS: usize = 16 << 20;
const ROUNDS: usize = 4_000;
const CHAINS: usize = 10;

impl Machine {
    /// Measures for some tenths of a second.
    pub fn measure(threads: usize) -> Self {
        let cpu = Cpu::new(threads, 0, Instructions::Widest);
        let from = vec![1.0_f32; NUMBERS];
        let mut to = vec![0.0_f32; NUMBERS];
        let chunk = NUMBERS / threads.max(1);
        let (mut copy, mut arithmetic) = (f64::INFINITY, f64::INFINITY);
        for _ in 0..6 {
            let started = Instant::now();
            cpu.for_each(to.chunks_mut(chunk).zip(from.chunks(chunk)), |(to, from)| to.copy_from_slice(from));
            copy = copy.min(started.elapsed().as_secs_f64());
            std::hint::black_box(&to);
        }
        let mut lanes = 0;
        for _ in 0..10 {
            let started = Instant::now();
            let counted = cpu.map(threads, |_| cpu.dispatch_widest(Chains));
            arithmetic = arithmetic.min(started.elapsed().as_secs_f64());
            lanes = counted[0].0;
            std::hint::black_box(counted);
        }
        Self {
            threads,
            instructions: cpu.instruction_set(),
            bytes_per_s: (8 * NUMBERS) as f64 / copy,
            flops_per_s: (2 * ROUNDS * CHAINS * lanes * threads) as f64 / arithmetic,
        }
    }
}

/// Multiply-adds that do not wait for each other.
struct Chains;

impl WithSimd for Chains {
    type Output = (usize, f32);

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> (usize, f32) {
        let factor = f32::splat(simd, std::hint::black_box(0.999_f32));
        let mut chains = [f32::splat(simd, 1.0); CHAINS];
        for _ in 0..ROUNDS {
            for chain in &mut chains {
                *chain = chain.mul_add(factor, factor);
            }
        }
        let mut sum = chains[0];
        for chain in &chains[1..] {
            sum += *chain;
        }
        let mut lanes = [0.0; sinew::math::LANES];
        f32::store(sum, &mut lanes);
        (f32::width::<S>(), lanes.iter().sum())
    }
}

/// Largest memory of the process since it was last forgotten (bytes); Linux only.
pub fn memory_peak() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM:"))?;
    line.split_whitespace().nth(1)?.parse::<u64>().ok().map(|kilobytes| 1024 * kilobytes)
}

/// Begins anew; where that cannot be done the peak is that of the whole run.
pub(super) fn forget_memory_peak() {
    let _ = std::fs::write("/proc/self/clear_refs", "5");
}
