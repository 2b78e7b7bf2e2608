//! Errors that wgpu tells of by callbacks.

use std::pin::Pin;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::task::{Context, Poll, Waker};

/// Where wgpu's callbacks leave their errors until the next call picks them up.
#[derive(Clone, Default)]
pub(super) struct Inbox(Arc<Mutex<Letters>>);

/// The error of a scope, once it is known.
type Expected = Pin<Box<dyn Future<Output = Option<wgpu::Error>> + Send>>;

#[derive(Default)]
struct Letters {
    /// in a page they come when its own code has ended
    expected: Vec<Expected>,
    errors: Vec<Event>,
    /// stays: a lost device does not come back, and wgpu is silent about all that follows
    lost: Option<String>,
}

/// What a callback said.
pub(super) enum Event {
    OutOfMemory,
    Other(String),
    Lost(String),
}

impl Event {
    /// Of an error of wgpu.
    pub(super) fn of(error: wgpu::Error) -> Self {
        match error {
            wgpu::Error::OutOfMemory { .. } => Self::OutOfMemory,
            other => Self::Other(other.to_string()),
        }
    }
}

impl Inbox {
    /// Hears the device's errors from now on.
    pub(super) fn listen(device: &wgpu::Device) -> Self {
        let inbox = Self::default();
        let errors = inbox.clone();
        device.on_uncaptured_error(Arc::new(move |error| {
            errors.put(Event::of(error));
        }));
        let lost = inbox.clone();
        device.set_device_lost_callback(move |_, text| lost.open().lost = Some(text));
        inbox
    }

    /// Leaves what a scope will have caught: known at once, but in a page.
    pub(super) fn expect(&self, error: impl Future<Output = Option<wgpu::Error>> + Send + 'static) {
        self.open().expected.push(Box::pin(error));
    }

    /// Leaves something that went wrong.
    pub(super) fn put(&self, event: Event) {
        self.open().errors.push(event);
    }

    fn open(&self) -> MutexGuard<'_, Letters> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// A lost device, or else the first thing that went wrong since the last call; forgets the others, which are its
    /// consequences.
    pub(super) fn take(&self) -> Option<Event> {
        let mut letters = self.open();
        let Letters { expected, errors, .. } = &mut *letters;
        expected.retain_mut(|error| match error.as_mut().poll(&mut Context::from_waker(Waker::noop())) {
            Poll::Ready(error) => {
                errors.extend(error.map(Event::of));
                false
            }
            Poll::Pending => true,
        });
        let errors = std::mem::take(&mut letters.errors);
        letters.lost.clone().map(Event::Lost).or_else(|| errors.into_iter().next())
    }
}
