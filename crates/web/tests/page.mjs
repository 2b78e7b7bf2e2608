// The page in a browser without a window: what it draws by WebGPU and by WebGL, what its editor does, what is dropped
// on it, whether steps on the CPU and on the GPU come to what they come to in a program, and what becomes of a browser
// that cannot wait for a GPU.
//
//   node page.mjs SITE CHROMIUM OUT NATIVE.csv STEPS SCENE.ron    SITE: the folder of the page; OUT: for pictures
import { createServer } from "node:http";
import { readFile, writeFile, mkdir } from "node:fs/promises";
import { extname, join, normalize } from "node:path";
import { createRequire } from "node:module";

const [site, chromiumPath, out, nodesFile, steps, sceneFile] = process.argv.slice(2);
// where tests/run has put it
const { chromium } = createRequire(join(process.env.SINEW_NODE_MODULES, "x.js"))("playwright-core");
await mkdir(out, { recursive: true });

const kinds = { ".html": "text/html", ".js": "text/javascript", ".wasm": "application/wasm" };
const server = createServer(async (request, response) => {
  try {
    const name = normalize(decodeURIComponent(new URL(request.url, "http://x").pathname)).replace(/\/$/, "/index.html");
    const bytes = await readFile(join(site, name));
    response.writeHead(200, { "content-type": kinds[extname(name)] ?? "application/octet-stream" }).end(bytes);
  } catch {
    response.writeHead(404).end();
  }
});
await new Promise((ready) => server.listen(0, "127.0.0.1", ready));
const address = `http://127.0.0.1:${server.address().port}/`;

// a software device draws: SwiftShader, by Vulkan for WebGPU, by ANGLE for WebGL
const software = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist"];
const ways = {
  webgpu: [
    ...software, "--enable-unsafe-webgpu", "--enable-gpu", "--enable-features=Vulkan", "--use-vulkan=swiftshader",
  ],
  webgl: [...software, "--disable-features=WebGPU,WebGPUService"],
};
const wrong = [];
const check = (is, what) => { if (!is) wrong.push(what); console.log(`${is ? "ok" : "WRONG"}: ${what}`); };
const patience = Number(process.env.SINEW_PATIENCE ?? 240) * 1000;

async function open(browser, hash, about = {}) {
  const page = await browser.newPage({ viewport: { width: about.width ?? 1280, height: about.height ?? 800 } });
  if (about.first) await page.addInitScript(about.first);
  page.on("console", (message) => {
    if (message.type() === "error") console.log(`  console: ${message.text().slice(0, 400)}`);
  });
  page.on("pageerror", (error) => console.log(`  page: ${error}`));
  page.on("crash", () => console.log("  page: it crashed"));
  await page.goto(address + hash);
  return page;
}

const status = (page) => page.evaluate(() => window.sinew?.status() ?? null);

async function until(page, what, done) {
  const start = Date.now();
  for (;;) {
    const now = await status(page);
    if (now && done(now)) { check(true, what); return now; }
    const told = await page.evaluate(() => document.querySelector("#told.wrong")?.textContent);
    if (told || Date.now() - start > patience) {
      check(false, `${what}: ${told ?? JSON.stringify(now)}`);
      await page.screenshot({ path: join(out, "wrong.png") });
      return now ?? {};
    }
    await page.waitForTimeout(100);
  }
}

// A picture of the page, or of a part of it, in OUT; its bytes. One of one colour packs to next to nothing.
async function picture(page, name, clip) {
  const bytes = await page.screenshot({ clip, timeout: patience });
  await writeFile(join(out, `${name}.png`), bytes);
  return bytes.length;
}

// where the picture of the scene is: right of the panels
const middle = { x: 700, y: 150, width: 500, height: 500 };

async function drawn(way, device) {
  const browser = await chromium.launch({ executablePath: chromiumPath, args: ways[way] });
  const page = await open(browser, "#scene=cube_under_gravity.ron&run&field=von_mises");
  const seen = await until(page, `${way}: it runs and is drawn by ${device}`, (now) => now.step > 50);
  check((seen.drawn_by ?? "").includes(device), `${way}: drawn by ${seen.drawn_by}`);
  check((seen.backend ?? "").startsWith("CPU (1 thread, simd"), `${way}: simulated by ${seen.backend}`);
  const bytes = await picture(page, way, middle);
  check(bytes > 8000, `${way}: a picture of ${bytes} bytes`);
  return { browser, page };
}

// Pastes a text into the editor in place of what is there.
async function paste(page, text) {
  await page.mouse.click(200, 400);
  await page.keyboard.press("Control+A");
  await page.evaluate((text) => {
    const clipboardData = new DataTransfer();
    clipboardData.setData("text/plain", text);
    document.dispatchEvent(new ClipboardEvent("paste", { clipboardData, bubbles: true, cancelable: true }));
  }, text);
}

async function edited(page) {
  const scene = (await readFile(sceneFile, "utf8"));
  await paste(page, scene.replace("duration:", "durations:"));
  const tells = (pattern) => (now) => now.number === 0 && now.mistakes.some((line) => pattern.test(line));
  await until(page, "editor: a mistake is told where it is", tells(/:\d+:\d+: .*durations/));
  await picture(page, "mistake");
  await paste(page, scene.replace("z0", "z7"));
  await page.keyboard.press("Control+Enter");
  await until(page, "editor: what only loading finds is told", tells(/z7/));
  await paste(page, scene);
  await page.keyboard.press("Control+Enter");
  await until(page, "editor: the text is loaded", (now) => now.number === 1 && now.mistakes.length === 0);
}

async function dropped(page) {
  const scene = await readFile(sceneFile, "utf8");
  await page.evaluate((text) => {
    const data = new DataTransfer();
    data.items.add(new File([text], "dropped.ron"));
    const canvas = document.getElementById("canvas");
    const about = { dataTransfer: data, bubbles: true, cancelable: true };
    for (const kind of ["dragover", "drop"]) canvas.dispatchEvent(new DragEvent(kind, about));
  }, scene);
  await until(page, "a scene that is dropped is opened", (now) => now.scene === "dropped.ron");
}

// Steps in the page against those of a program: not the same bits, for no register of the page multiplies and adds at
// once. Without a viewer, whose pictures take a software device all its time.
async function compared(browser, backend) {
  const page = await open(browser, "wait.js");
  await page.evaluate(async () => {
    const [sinew, { inTurn }] = [await import("./sinew_web.js"), await import("./wait.js")];
    const wasm = await sinew.default({ module_or_path: new URL("sinew_web_bg.wasm", location.href) });
    const makeRun = inTurn(wasm.make_run);
    window.run = async (...asked) => { sinew.ask_for_run(...asked); await makeRun(); return sinew.answer_of_run(); };
  });
  const asked = [await readFile(sceneFile, "utf8"), Number(steps), backend];
  const run = JSON.parse(await page.evaluate((asked) => window.run(...asked), asked));
  await page.close();
  check(run.backend.toLowerCase().startsWith(backend), `${backend}: steps on ${run.backend}`);
  const [head, ...rows] = (await readFile(nodesFile, "utf8")).trim().split("\n").map((line) => line.split(","));
  const column = (name) => head.findIndex((title) => title.trim().split(" ")[0] === name);
  const [places, moves] = [["X", "Y", "Z"].map(column), ["ux", "uy", "uz"].map(column)];
  const body = Object.values(run.bodies)[0];
  let far = 0, moved = 0;
  rows.forEach((row, node) => {
    const by = moves.map((place) => Number(row[place]));
    const native = by.map((part, axis) => part + Number(row[places[axis]]));
    far = Math.max(far, Math.hypot(...native.map((part, axis) => part - body[node][axis])));
    moved = Math.max(moved, Math.hypot(...by));
  });
  const micro = (1e6 * run.seconds / run.steps).toFixed(0);
  console.log(`  ${backend}: ${run.elements} elements, ${run.steps} steps: ${micro} µs a step`);
  const is = rows.length === body.length && moved > 0 && far < 1e-4 * moved;
  check(is, `${backend}: nodes are where a program's are: ${far} m off of ${moved} m`);
}

// Steps on the device that draws, whose pictures show them where they are.
async function drawnFromGpu(browser) {
  const hash = "#scene=cube_under_gravity.ron&run&field=von_mises&backend=gpu";
  const page = await open(browser, hash, { width: 900, height: 500 });
  const seen = await until(page, "gpu: it runs while it is drawn", (now) => now.step > 3);
  check((seen.backend ?? "").startsWith("GPU"), `gpu: simulated by ${seen.backend}`);
  const bytes = await picture(page, "gpu", { x: 640, y: 120, width: 250, height: 300 });
  check(bytes > 4000, `gpu: a picture of ${bytes} bytes`);
  await page.close();
}

// A browser that cannot put WebAssembly aside: a GPU is refused where it is asked for, and else not taken.
async function withoutWaiting(browser) {
  const first = () => { delete WebAssembly.Suspending; delete WebAssembly.promising; };
  for (const [backend, told, is] of [
    ["gpu", "refused", (now) => /JavaScript Promise Integration/.test(now.refusal ?? "")],
    ["auto", "the CPU", (now) => now.step > 3 && now.backend.startsWith("CPU")],
  ]) {
    const hash = `#scene=cube_under_gravity.ron&run&backend=${backend}`;
    const page = await open(browser, hash, { first, width: 400, height: 300 });
    await until(page, `without waiting, ${backend}: ${told}`, is);
    await page.close();
  }
}

try {
  const { browser, page } = await drawn("webgpu", "BrowserWebGpu");
  await edited(page);
  await dropped(page);
  await page.close();
  await compared(browser, "cpu");
  await compared(browser, "gpu");
  await drawnFromGpu(browser);
  await withoutWaiting(browser);
  await browser.close();
  const other = await drawn("webgl", "(Gl)");
  await other.browser.close();
} catch (error) {
  check(false, String(error));
}
server.close();
process.exit(wrong.length ? 1 : 0);
