// A replay page in headless Chromium without a GPU.

import { chromium } from "playwright-core";

const ARGUMENTS = ["--no-sandbox", "--disable-gpu", "--use-angle=swiftshader",
  "--enable-unsafe-swiftshader", "--disable-quic", "--no-first-run",
  "--disable-background-networking", "--disable-component-update", "--disable-sync"];

// The page, once it is drawn, and what goes wrong on it.
export async function open(page, options) {
  const executablePath = process.env.CHROMIUM ?? "/usr/bin/chromium";
  const browser = await chromium.launch({ executablePath, args: ARGUMENTS });
  const tab = await (await browser.newContext(options)).newPage();
  const wrong = [];
  tab.on("pageerror", (error) => wrong.push(String(error)));
  tab.on("console", (message) => message.type() === "error" && wrong.push(message.text()));
  tab.on("request", (request) => {
    if (!/^(file|data|blob):/.test(request.url())) wrong.push(`asks for ${request.url()}`);
  });
  await tab.goto(`file://${page}`);
  await tab.waitForFunction(() => window.replay?.state.drawn > 0, null, { timeout: 120000 })
    .catch((error) => { throw new Error(`${wrong.join("\n")}\n${error}`); });
  return { browser, tab, wrong };
}
