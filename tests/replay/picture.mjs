// Takes a picture of a replay page, all its backends side by side, in headless Chromium.
//
//   npm ci && npm run picture -- PAGE.html PICTURE.png [STEP [X,Y,Z [ZOOM]]]
//
// STEP is the last one if it is left out. The view is the page's, or along X,Y,Z at what moves, so
// many times nearer. CHROMIUM names the browser if it is not /usr/bin/chromium.

import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import { resolve } from "node:path";
import { open } from "./browser.mjs";

const SIZE = { width: 1280, height: 720 };

const [page, picture, step, view, zoom = "1"] = process.argv.slice(2);
assert(page && picture, "the page or the picture is missing");
const { browser, tab, wrong } = await open(resolve(page), { viewport: SIZE, deviceScaleFactor: 2 });
try {
  await tab.addStyleTag({ content: "header, footer { display: none !important; }" });
  await tab.evaluate(({ step, view, zoom }) => {
    const { data, drawing, frames, seek, play } = window.replay;
    play(false);
    drawing.showsContacts = false;
    drawing.resize();
    drawing.look(view?.split(",").map((k) => -Number(k)));
    const { camera, orbit } = drawing;
    camera.position.sub(orbit.target).scale(1 / Number(zoom)).add(orbit.target);
    orbit.forcePosition();
    seek(step === undefined ? frames - 1 : Number(step) / data.stride);
  }, { step, view, zoom });
  await tab.waitForTimeout(1500);
  // Four samples a pixel, instead of smooth edges.
  const shot = (await tab.screenshot()).toString("base64");
  const small = await tab.evaluate(async ({ shot, width, height }) => {
    const image = await createImageBitmap(await (await fetch(`data:image/png;base64,${shot}`)).blob());
    const canvas = Object.assign(document.createElement("canvas"), { width, height });
    const context = canvas.getContext("2d");
    context.imageSmoothingQuality = "high";
    context.drawImage(image, 0, 0, width, height);
    return canvas.toDataURL("image/png").split(",")[1];
  }, { shot, ...SIZE });
  assert.deepEqual(wrong, []);
  writeFileSync(picture, Buffer.from(small, "base64"));
} finally {
  await browser.close();
}
