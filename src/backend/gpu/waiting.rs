//! Waiting for a device, where a thread may wait and where it may not.

#[cfg(any(target_arch = "wasm32", test))]
use std::sync::Arc;
#[cfg(any(target_arch = "wasm32", test))]
use std::sync::OnceLock;
#[cfg(any(target_arch = "wasm32", test))]
use std::sync::atomic::{AtomicBool, Ordering};
#[cfg(any(target_arch = "wasm32", test))]
use std::task::{Context, Poll, Wake, Waker};

/// How a page waits for its device. Threads of a browser may not; what runs by the browser's
/// [JavaScript Promise Integration](https://github.com/WebAssembly/js-promise-integration) can be put aside instead,
/// while the page goes on drawing.
#[cfg(any(target_arch = "wasm32", test))]
#[derive(Clone, Copy, Debug)]
pub struct Waiting {
    /// Puts the caller aside until [`wake`](Self::wake) is called; comes back at once if it was since the last time.
    pub suspend: fn(),
    /// Something came that may be what is waited for.
    pub wake: fn(),
}

#[cfg(any(target_arch = "wasm32", test))]
static WAITING: OnceLock<Waiting> = OnceLock::new();

/// Says how this page waits, once, before a device is opened or adopted; without it there is no GPU in a page.
#[cfg(any(target_arch = "wasm32", test))]
pub fn wait_by(waiting: Waiting) {
    let _ = WAITING.set(waiting);
}

/// Whether this program can wait for a device.
pub(super) fn can_wait() -> bool {
    #[cfg(target_arch = "wasm32")]
    return WAITING.get().is_some();
    #[cfg(not(target_arch = "wasm32"))]
    true
}

/// Waits for a future's end.
#[cfg(not(target_arch = "wasm32"))]
pub(super) use pollster::block_on;
#[cfg(target_arch = "wasm32")]
pub(super) use suspended_on as block_on;

/// The same where no thread may wait.
#[cfg(any(target_arch = "wasm32", test))]
pub(super) fn suspended_on<F: Future>(future: F) -> F::Output {
    let bell = Arc::new(Bell::default());
    let waker = Waker::from(bell.clone());
    let mut future = std::pin::pin!(future);
    loop {
        if let Poll::Ready(done) = future.as_mut().poll(&mut Context::from_waker(&waker)) {
            return done;
        }
        bell.wait();
    }
}

/// What something that comes rings, and what is waited for.
#[cfg(any(target_arch = "wasm32", test))]
#[derive(Default)]
pub(super) struct Bell {
    rung: AtomicBool,
}

#[cfg(any(target_arch = "wasm32", test))]
impl Bell {
    /// Ends the wait, the one now or the next.
    pub(super) fn ring(&self) {
        self.rung.store(true, Ordering::SeqCst);
        if let Some(waiting) = WAITING.get() {
            (waiting.wake)();
        }
    }

    /// Until it is rung; at once if it was since the last wait.
    pub(super) fn wait(&self) {
        while !self.rung.swap(false, Ordering::SeqCst) {
            // nothing is opened where this is not known
            let Some(waiting) = WAITING.get() else { return };
            (waiting.suspend)();
        }
    }
}

#[cfg(any(target_arch = "wasm32", test))]
impl Wake for Bell {
    fn wake(self: Arc<Self>) {
        self.ring();
    }
}

/// Whether a buffer is mapped. Elsewhere it is when all that was submitted is done; in a page it is when that is told.
#[derive(Default)]
pub(super) struct Mapped {
    #[cfg(target_arch = "wasm32")]
    bell: Arc<Bell>,
}

impl Mapped {
    /// What is to be told.
    pub(super) fn told(&self) -> impl FnOnce(Result<(), wgpu::BufferAsyncError>) + Send + 'static {
        #[cfg(target_arch = "wasm32")]
        let bell = self.bell.clone();
        move |_| {
            #[cfg(target_arch = "wasm32")]
            bell.ring();
        }
    }

    /// Until it was told.
    pub(super) fn wait(&self) {
        #[cfg(target_arch = "wasm32")]
        self.bell.wait();
    }
}

#[cfg(test)]
mod tests;
