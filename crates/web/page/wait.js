// How the engine waits for the GPU, though a page may not wait: WebAssembly that calls `suspend` is put aside by the
// browser (JavaScript Promise Integration) until `wake` is called, and the page goes on. One at a time: `inTurn`.

let woken = false;
let resume = null;

function suspended() {
  if (woken) {
    woken = false;
    return 0;
  }
  return new Promise((resolve) => { resume = resolve; }).then(() => 0);
}

export const canWait = "Suspending" in WebAssembly;

// what WebAssembly imports itself, without JavaScript in between, which cannot be put aside
export const suspend = canWait ? new WebAssembly.Suspending(suspended) : suspended;

export function wake() {
  if (resume === null) {
    woken = true;
    return;
  }
  const go = resume;
  resume = null;
  go();
}

let last = Promise.resolve();

// A function of WebAssembly that may be put aside, as one that gives a promise. They wait for each other.
export function inTurn(called) {
  const promised = canWait ? WebAssembly.promising(called) : called;
  return (...given) => {
    const next = last.then(() => promised(...given));
    last = next.catch(() => {});
    return next;
  };
}
