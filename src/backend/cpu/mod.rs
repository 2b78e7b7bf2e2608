//! The CPU backend: every core, vector registers as wide as the machine has them.

mod arenas;
mod element_kernel;
mod guard_kernel;
mod in_one_place;
mod law;
mod law_copies;
mod node_kernel;
mod own_kernels;
mod strain_kernel;
mod volume_kernel;

pub use element_kernel::{BlockColumns, InsidePatch, PatchInterior, kernel_effects, run_block, run_block_fast};
pub use guard_kernel::{BlockSums, GuardColumns, run_guard};
pub use law::BlockLaw;
pub use law_copies::{LawCopies, LawParameters, PerCopyLaw};
pub(crate) use node_kernel::{Asked, Met, ROWS_A_CHUNK};
pub use node_kernel::{
    Declared, Foreseen, IntegrationCoefficients, NodeColumns, NodeShare, OwnRows, Touches, Undeclared, move_nodes,
};
pub use own_kernels::OwnKernels;
pub use strain_kernel::{Kept, Strain, StrainColumns, Visit, strains};
pub(crate) use strain_kernel::{sizes, with_identity};
pub use volume_kernel::run_volumes;

use arenas::Arenas;
use bevy_ecs::prelude::*;
use bumpalo::Bump;
use rayon::prelude::*;
use std::sync::{Arc, Mutex, OnceLock, PoisonError, Weak};

/// Rows of a node column that make one task. A constant: tasks must not depend on the number of threads.
pub const ROWS_A_TASK: usize = 2048;

/// Elements below which one thread does a step as fast as two (6 000 tetrahedra break even, 25 000 gain 1.7 times).
const WORTH_SHARING: usize = 6000;

/// Which vector registers kernels use.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Instructions {
    /// The widest that the machine has.
    #[default]
    Widest,
    /// AVX2 also where there is AVX-512.
    Avx2,
    /// What any machine has.
    Portable,
}

/// The pool of so many threads: simulations of a process that ask for as many share it, as long as one of them is
/// there.
fn pool_of(threads: usize) -> Option<Arc<rayon::ThreadPool>> {
    static POOLS: Mutex<Vec<Weak<rayon::ThreadPool>>> = Mutex::new(Vec::new());
    let mut pools = POOLS.lock().unwrap_or_else(PoisonError::into_inner);
    pools.retain(|pool| pool.strong_count() > 0);
    let known = pools.iter().filter_map(Weak::upgrade).find(|pool| pool.current_num_threads() == threads);
    known.or_else(|| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().ok().map(Arc::new)?;
        pools.push(Arc::downgrade(&pool));
        Some(pool)
    })
}

/// Something to be done once, on any thread.
trait Job: Send {
    fn run(&mut self);
}

/// An item, and what is to be done with it.
struct ItemJob<'t, I, F> {
    item: Option<I>,
    task: &'t F,
}

impl<I: Send, F: Fn(I) + Sync> Job for ItemJob<'_, I, F> {
    fn run(&mut self) {
        self.item.take().into_iter().for_each(self.task);
    }
}

/// One kind of job for whatever is shared among threads: with a kind for each task, what rayon made of them took a
/// seventeenth of compiling (docs/performance.md).
fn run_jobs(pool: &rayon::ThreadPool, jobs: &mut [&mut dyn Job]) {
    pool.install(|| jobs.par_iter_mut().for_each(|job| job.run()));
}

/// Threads and instruction set of a run.
#[derive(Resource)]
pub struct Cpu {
    pool: Option<Arc<rayon::ThreadPool>>,
    /// A pool of one thread, made when something would otherwise spread over the machine.
    alone: OnceLock<Option<Arc<rayon::ThreadPool>>>,
    threads: usize,
    arch: pulp::Arch,
    arenas: Arenas,
}

impl Cpu {
    /// `threads` 0: one a core, and one only for bodies too small to share.
    #[doc(hidden)]
    pub fn new(threads: usize, elements: usize, instructions: Instructions) -> Self {
        let threads = match threads {
            0 if elements < WORTH_SHARING => 1,
            0 => std::thread::available_parallelism().map_or(1, |n| n.get()),
            n => n,
        };
        let pool = if threads == 1 { None } else { pool_of(threads) };
        let threads = if pool.is_some() { threads } else { 1 };
        let arch = match (instructions, pulp::Arch::new()) {
            // the library's unit tests have no kernels for vector registers: they would take most of the time of
            // compiling, and are tested from outside
            _ if cfg!(test) => pulp::Arch::Scalar,
            (Instructions::Portable, _) => pulp::Arch::Scalar,
            #[cfg(target_arch = "x86_64")]
            (Instructions::Avx2, pulp::Arch::V4(simd)) => pulp::Arch::V3(*simd),
            (_, widest) => widest,
        };
        Self { pool, alone: OnceLock::new(), threads, arch, arenas: Arenas::default() }
    }

    /// The same threads and instructions, for what has no hold on the world while it works.
    pub(crate) fn twin(&self) -> Self {
        let Self { pool, threads, arch, .. } = self;
        Self { pool: pool.clone(), alone: OnceLock::new(), threads: *threads, arch: *arch, arenas: Arenas::default() }
    }

    /// How many threads work.
    pub fn threads(&self) -> usize {
        self.threads
    }

    /// The instruction set that was found, in a word.
    pub fn instruction_set(&self) -> String {
        let debug = format!("{:?}", self.arch);
        match debug.split('(').next() {
            Some("V4") => "AVX-512".into(),
            Some("V3") => "AVX2".into(),
            Some(other) => other.to_lowercase(),
            None => debug,
        }
    }

    /// The threads, to run a whole loop of steps on: from there sharing a task costs a few microseconds, from outside
    /// several times that in every system. `None` when one thread works.
    #[doc(hidden)]
    pub fn pool(&self) -> Option<Arc<rayon::ThreadPool>> {
        self.pool.clone()
    }

    /// Runs a task so that what it shares among threads stays on those of this run: on one, where one is asked for.
    #[doc(hidden)]
    pub fn confine<R: Send>(&self, task: impl FnOnce() -> R + Send) -> R {
        let alone = || self.alone.get_or_init(|| pool_of(1)).as_deref();
        match self.pool.as_deref().or_else(alone) {
            Some(pool) => pool.install(task),
            None => task(),
        }
    }

    /// Threads and instruction set in a few words.
    pub fn describe(&self) -> String {
        let plural = if self.threads == 1 { "" } else { "s" };
        format!("CPU ({} thread{plural}, {})", self.threads, self.instruction_set())
    }

    /// Runs a task with the machine's vector registers, of 256 bits where it has wider ones too: most kernels are not
    /// worth their code a third time.
    #[inline] // so that what it runs is compiled where it is asked for
    pub(crate) fn dispatch<O: pulp::WithSimd>(&self, task: O) -> O::Output {
        #[cfg(target_arch = "x86_64")]
        {
            use pulp::Simd;
            // arm by arm: `Arch::dispatch` has the code for all of them compiled, wherever it is called
            match self.arch {
                #[cfg(not(test))]
                pulp::Arch::V4(simd) => Simd::vectorize(*simd, task),
                #[cfg(not(test))]
                pulp::Arch::V3(simd) => Simd::vectorize(simd, task),
                _ => Simd::vectorize(pulp::Scalar, task),
            }
        }
        #[cfg(not(target_arch = "x86_64"))]
        self.arch.dispatch(task)
    }

    /// Whether there are registers for more than one number.
    pub(crate) fn has_vectors(&self) -> bool {
        !matches!(self.arch, pulp::Arch::Scalar)
    }

    /// Runs a task with the widest registers that the machine has; `None` where it has [none](Self::has_vectors): there
    /// is no code for that.
    #[inline]
    pub(crate) fn dispatch_vectors<O: pulp::WithSimd>(&self, task: O) -> Option<O::Output> {
        #[cfg(target_arch = "x86_64")]
        {
            use pulp::Simd;
            match self.arch {
                pulp::Arch::V4(simd) => Some(Simd::vectorize(simd, task)),
                pulp::Arch::V3(simd) => Some(Simd::vectorize(simd, task)),
                _ => None,
            }
        }
        #[cfg(not(target_arch = "x86_64"))]
        self.dispatch_the_vectors(task)
    }

    /// The same with registers of 256 bits at most, as [`dispatch`](Self::dispatch) has them.
    #[inline]
    pub(crate) fn dispatch_narrow_vectors<O: pulp::WithSimd>(&self, task: O) -> Option<O::Output> {
        #[cfg(target_arch = "x86_64")]
        {
            use pulp::Simd;
            match self.arch {
                pulp::Arch::V4(simd) => Some(Simd::vectorize(*simd, task)),
                pulp::Arch::V3(simd) => Some(Simd::vectorize(simd, task)),
                _ => None,
            }
        }
        #[cfg(not(target_arch = "x86_64"))]
        self.dispatch_the_vectors(task)
    }

    /// The same where registers have one length only.
    #[cfg(not(target_arch = "x86_64"))]
    #[inline]
    fn dispatch_the_vectors<O: pulp::WithSimd>(&self, task: O) -> Option<O::Output> {
        match self.arch {
            // a page is compiled for those: without them as well, its kernels would be twice as large
            #[cfg(target_arch = "wasm32")]
            pulp::Arch::Simd128(simd) => Some(pulp::Simd::vectorize(simd, task)),
            #[cfg(target_arch = "wasm32")]
            _ => None,
            #[cfg(not(target_arch = "wasm32"))]
            arch => Some(arch.dispatch(task)),
        }
    }

    /// Runs a task with the widest registers that the machine has.
    #[inline]
    #[doc(hidden)]
    pub fn dispatch_widest<O: pulp::WithSimd>(&self, task: O) -> O::Output {
        #[cfg(test)]
        return pulp::Simd::vectorize(pulp::Scalar, task);
        #[cfg(not(test))]
        self.arch.dispatch(task)
    }

    /// Results of `task` for 0 to `count` − 1, in order.
    #[doc(hidden)]
    pub fn map<R: Send>(&self, count: usize, task: impl Fn(usize) -> R + Sync + Send) -> Vec<R> {
        if self.pool.is_none() || count < 2 {
            return (0..count).map(task).collect();
        }
        let mut results: Vec<Option<R>> = std::iter::repeat_with(|| None).take(count).collect();
        self.for_each(results.iter_mut().enumerate(), |(index, result)| *result = Some(task(index)));
        results.into_iter().flatten().collect()
    }

    /// Runs `task` on each item, on all threads. Items must be independent; their order of work does not matter then.
    /// They are kept where those of the last step were.
    #[doc(hidden)]
    pub fn for_each<I: Send>(&self, mut items: impl Iterator<Item = I>, task: impl Fn(I) + Sync + Send) {
        match (&self.pool, items.size_hint().1) {
            (None, _) | (_, Some(0 | 1)) => items.for_each(task),
            (Some(pool), Some(most)) => self.with_arena(|arena| {
                let jobs = arena.alloc_slice_fill_with(most, |_| ItemJob { item: items.next(), task: &task });
                run_jobs(pool, arena.alloc_slice_fill_iter(jobs.iter_mut().map(|job| job as &mut dyn Job)));
            }),
            (Some(_), None) => self.for_each(items.collect::<Vec<I>>().into_iter(), task),
        }
    }

    /// Lends a task memory that is there from step to step. What is put there is forgotten, not dropped.
    pub(crate) fn with_arena<R>(&self, task: impl FnOnce(&Bump) -> R) -> R {
        self.arenas.with(task)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    #[test]
    fn simulations_with_as_many_threads_share_them() {
        let [one, other, more] = [3, 3, 5].map(|threads| Cpu::new(threads, 0, Instructions::Widest).pool().unwrap());
        assert!(Arc::ptr_eq(&one, &other) && !Arc::ptr_eq(&one, &more));
        assert_eq!([one, more].map(|pool| pool.current_num_threads()), [3, 5]);
    }
}
