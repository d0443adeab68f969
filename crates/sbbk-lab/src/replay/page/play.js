// The page: play, slider, graph.

const COLOURS = ["#000000", "#0072b2", "#d55e00", "#009e73"];
// Steps a second, and milliseconds of a frame above which bodies are drawn coarser.
const RATE = 60;
const SLOW = 24;

const find = (id) => document.getElementById(id);
const data = await decode(find("data").textContent);
const drawing = new Drawing(find("scene"), data);
const frames = Math.max(...data.runs.map((run) => run.frames));
const state = { time: 0, isPlaying: true, isStale: true, drawn: 0, pace: 0 };
find("slider").max = frames - 1;

const labels = data.runs.map((run, index) => {
  const label = document.createElement("b");
  label.textContent = run.name;
  label.style.color = COLOURS[index];
  find("labels").append(label);
  return label;
});
const times = data.runs.map((_, index) => {
  const time = document.createElement("span");
  time.style.color = COLOURS[index];
  find("times").append(time);
  return time;
});

// Places of the moving bodies of a run; null for those that are gone.
function places(index, frame) {
  const run = data.runs[index];
  const moving = run.fixed.flatMap((fixed, object) => (fixed ? [] : [object]));
  return moving.map((object) => {
    const place = [];
    return pose(data, run, object, frame, place, []) ? place : null;
  });
}

// Mean height of the moving bodies in each frame.
const heights = data.runs.map((run, index) => Float32Array.from({ length: run.frames }, (_, frame) => {
  const there = places(index, frame).filter((place) => place);
  return there.reduce((sum, place) => sum + place[1], 0) / Math.max(1, there.length);
}));

function graphs() {
  const times = data.runs.map((run) => run.times);
  // A few slow steps may reach above the graph.
  const all = times.flatMap((run) => [...run]).sort((a, b) => a - b);
  graph("graph", times, data.stride, 0, 1.15 * all[Math.floor(0.995 * (all.length - 1))], "ms a step");
  const [least, most] = [Math.min, Math.max].map((f) => f(...heights.map((run) => f(...run))));
  graph("heights", heights, 1, least, most > least ? most : least + 1, "mean height");
}

// Curves of all runs, of values between two limits, so many for a frame.
function graph(name, curves, rate, least, most, label) {
  const canvas = find(name);
  const scale = window.devicePixelRatio;
  const [width, height] = [canvas.clientWidth * scale, canvas.clientHeight * scale];
  Object.assign(canvas, { width, height });
  const context = canvas.getContext("2d");
  context.lineWidth = scale;
  curves.forEach((curve, index) => {
    context.strokeStyle = COLOURS[index];
    context.beginPath();
    curve.forEach((value, at) => context.lineTo((at / ((frames - 1) * rate)) * width,
      height * (1 - (value - least) / (most - least))));
    context.stroke();
  });
  context.font = `${11 * scale}px system-ui, sans-serif`;
  context.fillStyle = "#59626b";
  context.textAlign = "right";
  const shown = (value) => (Math.abs(value) < 10 ? value.toPrecision(2) : Math.round(value));
  context.fillText(`${label}, ${shown(least)} to ${shown(most)}`, width - 4 * scale, 11 * scale);
}

function layout() {
  drawing.resize();
  const { width, height } = drawing.gl.canvas;
  drawing.views().forEach((view, index) => {
    labels[index].style.left = `calc(${(100 * view.x) / width}% + 8px)`;
    labels[index].style.top = `calc(${100 - (100 * (view.y + view.height)) / height}% + 8px)`;
  });
  graphs();
  state.isStale = true;
}

function show() {
  const step = Math.min(Math.round(state.time * data.stride), (frames - 1) * data.stride);
  find("slider").value = Math.floor(state.time);
  for (const cursor of document.querySelectorAll(".cursor")) {
    cursor.style.left = `${(100 * state.time) / (frames - 1)}%`;
  }
  find("step").textContent = `step ${step}, ${(step / RATE).toFixed(2)} s`;
  data.runs.forEach((run, index) => {
    const near = run.times.slice(Math.max(0, step - 8), step);
    const mean = near.reduce((sum, time) => sum + time, 0) / Math.max(1, near.length);
    times[index].textContent = near.length ? `${run.name}: ${mean.toFixed(mean < 0.1 ? 3 : 2)} ms a step` : run.name;
  });
}

function seek(time) {
  state.time = Math.min(Math.max(time, 0), frames - 1);
  state.isStale = true;
}

function play(isPlaying) {
  state.isPlaying = isPlaying;
  find("play").textContent = isPlaying ? "Pause" : "Play";
  if (!isPlaying) drawing.level = 0;
  state.isStale = true;
}

let last = performance.now();
function tick(now) {
  const passed = now - last;
  last = now;
  if (state.isPlaying) {
    state.pace += 0.1 * (passed - state.pace);
    if (state.drawn > 10 && state.pace > SLOW) drawing.level = 1;
    if (state.time >= frames - 1) play(false);
    else seek(state.time + (Math.min(passed, 200) / 1000) * (RATE / data.stride));
  }
  if (state.isStale) {
    drawing.draw(state.time);
    show();
    state.drawn += 1;
    state.isStale = false;
  }
  requestAnimationFrame(tick);
}

find("play").onclick = () => {
  if (!state.isPlaying && state.time >= frames - 1) seek(0);
  play(!state.isPlaying);
};
find("slider").oninput = (event) => { play(false); seek(Number(event.target.value)); };
find("contacts").onchange = (event) => {
  drawing.showsContacts = event.target.checked;
  state.isStale = true;
};
for (const name of ["pointerdown", "pointermove", "touchmove", "wheel"]) {
  find("scene").addEventListener(name, () => { state.isStale = true; });
}
new ResizeObserver(layout).observe(find("scene"));
layout();
requestAnimationFrame(tick);

// For tests and pictures.
window.replay = { data, drawing, state, frames, seek, play, places };
