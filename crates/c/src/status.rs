//! What functions give back, and the text of what went wrong.

use sinew::Error;
use std::cell::RefCell;
use std::ffi::{CString, c_char};
use std::panic::{AssertUnwindSafe, catch_unwind};

/// How a call ended: `SINEW_OK` or what went wrong.
pub type SinewStatus = i32;

/// All is done.
pub const SINEW_OK: SinewStatus = 0;
/// An argument that cannot be: NULL, a number out of its range, a name that the scene does not have.
pub const SINEW_WRONG_ARGUMENT: SinewStatus = 1;
/// A buffer with less room than is needed; how much that is has been written to `count`.
pub const SINEW_BUFFER_TOO_SMALL: SinewStatus = 2;
/// The scene is wrong; the text tells all mistakes with their places.
pub const SINEW_WRONG_SCENE: SinewStatus = 3;
/// A GPU was asked for and there is none.
pub const SINEW_NO_GPU: SinewStatus = 4;
/// The GPU failed.
pub const SINEW_GPU_FAILED: SinewStatus = 5;
/// Files could not be written.
pub const SINEW_NOT_WRITTEN: SinewStatus = 6;
/// The simulation broke down; it can be looked at, reset and taken back to a snapshot.
pub const SINEW_BROKE_DOWN: SinewStatus = 7;
/// No equilibrium was found.
pub const SINEW_NOT_CONVERGED: SinewStatus = 8;
/// A snapshot that cannot be taken, read or gone on from.
pub const SINEW_WRONG_SNAPSHOT: SinewStatus = 9;
/// A mistake of sinew's own. What the call had to do with can only be freed.
pub const SINEW_BUG: SinewStatus = 10;

thread_local! {
    static LAST: RefCell<CString> = RefCell::default();
}

/// What the last call of this thread that did not end with `SINEW_OK` says, in UTF-8 and perhaps several lines; empty
/// where there was none. The text stays until the next such call of the thread.
#[unsafe(no_mangle)]
pub extern "C" fn sinew_last_error() -> *const c_char {
    LAST.with(|last| last.try_borrow().map_or(c"".as_ptr(), |text| text.as_ptr()))
}

/// Why a call failed.
#[derive(Debug)]
pub(crate) struct Failure {
    status: SinewStatus,
    text: String,
}

pub(crate) type Outcome<T = ()> = Result<T, Failure>;

impl Failure {
    pub fn new(status: SinewStatus, text: impl Into<String>) -> Self {
        Self { status, text: text.into() }
    }

    /// An argument that cannot be.
    pub fn argument(text: impl Into<String>) -> Self {
        Self::new(SINEW_WRONG_ARGUMENT, text)
    }

    /// Keeps the text for `sinew_last_error`.
    fn keep(self) -> SinewStatus {
        // a text of C ends with its first 0
        let text = CString::new(self.text.replace('\0', "\u{fffd}")).unwrap_or_default();
        LAST.with(|last| {
            if let Ok(mut last) = last.try_borrow_mut() {
                *last = text;
            }
        });
        self.status
    }
}

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        let status = match &error {
            Error::Scene(_) => SINEW_WRONG_SCENE,
            Error::NoGpu(_) => SINEW_NO_GPU,
            Error::Gpu(_) | Error::GpuFailed(_) => SINEW_GPU_FAILED,
            Error::Output(_) => SINEW_NOT_WRITTEN,
            Error::Unstable(_) => SINEW_BROKE_DOWN,
            Error::NotConverged(_) | Error::NotUnloaded(_) => SINEW_NOT_CONVERGED,
            Error::Snapshot(_) => SINEW_WRONG_SNAPSHOT,
            Error::Options(_) => SINEW_WRONG_ARGUMENT,
            Error::Broken(_) => SINEW_BUG,
        };
        Self::new(status, error.to_string())
    }
}

/// What every function runs in: a panic must not go on into C.
pub(crate) fn entry(call: impl FnOnce() -> Outcome) -> SinewStatus {
    match catch_unwind(AssertUnwindSafe(call)) {
        Ok(Ok(())) => SINEW_OK,
        Ok(Err(failure)) => failure.keep(),
        Err(panic) => {
            let said = panic.downcast_ref::<String>().map(String::as_str);
            let said = said.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("nothing more is known");
            Failure::new(SINEW_BUG, format!("a mistake of sinew's own: {said}; please report it with the scene")).keep()
        }
    }
}

#[cfg(test)]
#[allow(clippy::panic)]
mod tests {
    use super::*;
    use std::ffi::CStr;

    fn last() -> String {
        // SAFETY: the text stays until the thread's next call that fails
        unsafe { CStr::from_ptr(sinew_last_error()) }.to_string_lossy().into_owned()
    }

    #[test]
    fn a_panic_is_a_status_with_what_it_said() {
        assert_eq!(entry(|| panic!("row {} of 3", 4)), SINEW_BUG);
        assert!(last().contains("row 4 of 3"), "{}", last());
    }

    #[test]
    fn texts_are_those_of_the_thread_and_of_the_last_failure() {
        assert_eq!(entry(|| Err(Failure::argument("first\0of two"))), SINEW_WRONG_ARGUMENT);
        assert_eq!(entry(|| Ok(())), SINEW_OK);
        assert_eq!(last(), "first\u{fffd}of two");
        assert_eq!(std::thread::spawn(last).join().unwrap_or_default(), "");
    }
}
