#![allow(clippy::unwrap_used)]

use super::{Bell, Waiting, suspended_on, wait_by};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Condvar, Mutex};
use std::task::Poll;
use std::time::Duration;

static WOKEN: (Mutex<bool>, Condvar) = (Mutex::new(false), Condvar::new());
static SUSPENDED: AtomicUsize = AtomicUsize::new(0);

/// A page's two functions, by threads.
fn pretend() {
    let suspend = || {
        SUSPENDED.fetch_add(1, Ordering::SeqCst);
        let mut woken = WOKEN.0.lock().unwrap();
        while !*woken {
            woken = WOKEN.1.wait(woken).unwrap();
        }
        *woken = false;
    };
    let wake = || {
        *WOKEN.0.lock().unwrap() = true;
        WOKEN.1.notify_all();
    };
    wait_by(Waiting { suspend, wake });
}

#[test]
fn what_is_waited_for_comes_before_during_and_after_a_wait_for_something_else() {
    pretend();
    let bell = Arc::new(Bell::default());
    bell.ring();
    bell.wait();
    assert_eq!(SUSPENDED.load(Ordering::SeqCst), 0, "it was rung before");
    let late = bell.clone();
    let thread = std::thread::spawn(move || {
        // somebody else's comes first: the wait goes on
        Bell::default().ring();
        std::thread::sleep(Duration::from_millis(20));
        late.ring();
    });
    bell.wait();
    thread.join().unwrap();
    let mut asked = 0;
    let answer = suspended_on(std::future::poll_fn(|context| {
        asked += 1;
        if asked == 3 {
            return Poll::Ready(42);
        }
        let waker = context.waker().clone();
        std::thread::spawn(move || waker.wake());
        Poll::Pending
    }));
    assert_eq!((answer, asked), (42, 3));
}
