// Looks at a replay page in headless Chromium without a GPU: is it drawn, are bodies where the run
// had them, is it fast enough, does the slider work?
//
//   npm ci && npm run check -- ../../pile.html [FOLDER FOR SCREENSHOTS]
//
// CHROMIUM names the browser if it is not /usr/bin/chromium.

import assert from "node:assert/strict";
import { mkdirSync, statSync } from "node:fs";
import { join, resolve } from "node:path";
import { open } from "./browser.mjs";

const MOST_BYTES = 5e6;
const LEAST_FRAMES = 30;
const SIZES = { desktop: [960, 540], phone: [390, 844] };
// Share of the bodies in sight at whose place a body must be seen. The others are behind the floor's
// edge, or have their middle outside of themselves.
const LEAST_SEEN = 0.95;

const [page, folder = "."] = process.argv.slice(2).map((path) => resolve(path));
assert(page, "the page is missing");
const bytes = statSync(page).size;
assert(bytes <= MOST_BYTES, `${bytes} bytes`);
mkdirSync(folder, { recursive: true });

for (const [name, [width, height]] of Object.entries(SIZES)) await look(name, width, height);

async function look(name, width, height) {
  const options = { viewport: { width, height }, hasTouch: name === "phone" };
  const { browser, tab, wrong } = await open(page, options);
  try {
    await lookAt(tab, name, width, height);
  } finally {
    await browser.close();
  }
  assert.deepEqual(wrong, []);
}

async function lookAt(tab, name, width, height) {
  // It plays by itself.
  const passed = await tab.evaluate(async () => {
    const { state, seek, play } = window.replay;
    const wait = (ms) => new Promise((done) => setTimeout(done, ms));
    seek(0);
    play(true);
    // A short run starts again.
    const again = setInterval(() => {
      if (state.isPlaying) return;
      seek(0);
      play(true);
    }, 10);
    await wait(1500);
    const [drawn, start] = [state.drawn, performance.now()];
    await wait(4000);
    const frames = (1000 * (state.drawn - drawn)) / (performance.now() - start);
    clearInterval(again);
    play(false);
    return { frames, drawn: state.drawn };
  });
  console.log(`${name}: ${passed.frames.toFixed(1)} frames a second`);
  assert(passed.drawn > 10, "time stands still");
  if (name === "desktop") assert(passed.frames >= LEAST_FRAMES, `${passed.frames} frames a second`);

  // The slider goes to its ends.
  const texts = [];
  for (const end of ["0", "max"]) {
    await tab.evaluate((end) => {
      const slider = document.getElementById("slider");
      slider.value = end === "max" ? slider.max : end;
      slider.dispatchEvent(new Event("input"));
    }, end);
    await tab.waitForTimeout(600);
    texts.push(await tab.textContent("#step"));
    const shot = await tab.screenshot({ path: join(folder, `${name}-${end}.png`) });
    await inspect(tab, shot, `${name} at ${texts.at(-1)}`);
  }
  assert.notEqual(texts[0], texts[1]);

  // The view turns with the mouse.
  const eye = () => tab.evaluate(() => [...window.replay.drawing.camera.position]);
  const before = await eye();
  await tab.mouse.move(width / 3, height / 3);
  await tab.mouse.down();
  await tab.mouse.move(width / 3 + 80, height / 3, { steps: 4 });
  await tab.mouse.up();
  await tab.waitForTimeout(400);
  assert.notDeepEqual(await eye(), before);
}

// Projects the places of the run, and looks at the screenshot there.
async function inspect(tab, shot, what) {
  const seen = await tab.evaluate(async (shot) => {
    const image = await createImageBitmap(await (await fetch(`data:image/png;base64,${shot}`)).blob());
    const canvas = new OffscreenCanvas(image.width, image.height);
    const pixels = canvas.getContext("2d");
    pixels.drawImage(image, 0, 0);
    const { drawing, data, state, places } = window.replay;
    const { camera, gl } = drawing;
    const box = gl.canvas.getBoundingClientRect();
    const scale = gl.canvas.width / box.width;
    const product = (m, v) => [0, 1, 2, 3].map((row) =>
      v.reduce((sum, value, column) => sum + m[4 * column + row] * value, 0));
    // Bodies have colours; the floor and the sky are grey.
    const colourful = (x, y) => {
      const [r, g, b] = pixels.getImageData(Math.round(x), Math.round(y), 1, 1).data;
      return (Math.max(r, g, b) - Math.min(r, g, b)) / Math.max(r, g, b, 1) > 0.13;
    };
    return data.runs.map((run, index) => {
      const view = drawing.views()[index];
      const [left, top] = [box.left + view.x / scale,
        box.top + (gl.canvas.height - view.y - view.height) / scale];
      const [width, height] = [view.width / scale, view.height / scale];
      const found = { count: 0, bodies: 0, sky: 0, colours: new Set() };
      for (const place of places(index, state.time)) {
        if (!place) continue;
        const clip = product(camera.projectionMatrix, product(camera.viewMatrix, [...place, 1]));
        const [x, y] = [clip[0] / clip[3], clip[1] / clip[3]];
        if (Math.abs(x) > 0.95 || Math.abs(y) > 0.85) continue;
        found.count += 1;
        found.bodies += colourful(left + (0.5 + 0.5 * x) * width, top + (0.5 - 0.5 * y) * height);
      }
      for (let at = 0; at < 500; at++) {
        const [x, y] = [left + width * ((at * 0.618) % 1), top + height * (at / 500)];
        found.colours.add(pixels.getImageData(Math.round(x), Math.round(y), 1, 1).data.join());
        found.sky += !colourful(x, y);
      }
      return { ...found, colours: found.colours.size };
    });
  }, shot.toString("base64"));
  for (const { count, bodies, sky, colours } of seen) {
    console.log(`${what}: ${bodies} of ${count} bodies seen, ${colours} colours, ${sky} of 500 grey`);
    assert(count > 0, "no body is in sight");
    assert(bodies >= LEAST_SEEN * count, `bodies are not where they should be: ${bodies} of ${count}`);
    assert(colours > 20 && sky > 50, "blank, or without a background");
  }
}
