// Draws frames: bodies of one shape are one instanced mesh a run, lit at their vertices.

const PALETTE = [[214, 160, 96], [120, 160, 210], [170, 190, 110], [205, 120, 110],
  [160, 140, 190], [225, 200, 120]];
const FIXED = [200, 204, 209];
const BACKGROUND = [0.9, 0.925, 0.95];
const FIELD_OF_VIEW = 35;
// From the target to the eye.
const VIEW = [0.5, 0.5, 1];

const BODY_VERTEX = `#version 300 es
in vec3 position; in vec3 normal; in vec3 place; in vec4 turn; in vec3 tint;
uniform mat4 viewMatrix; uniform mat4 projectionMatrix; uniform vec3 sun;
out vec3 colour;
vec3 turned(vec3 v) { return v + 2.0 * cross(turn.xyz, cross(turn.xyz, v) + turn.w * v); }
void main() {
  vec3 n = turned(normal);
  // What is not there has no rotation, and shrinks to a point.
  vec3 world = turned(position) * min(1.0, 2.0 * dot(turn, turn)) + place;
  vec3 light = vec3(0.95, 0.91, 0.83) * max(dot(n, sun), 0.0)
    + mix(vec3(0.10, 0.09, 0.08), vec3(0.30, 0.33, 0.38), 0.5 + 0.5 * n.y);
  colour = pow(min(tint * light, 1.0), vec3(1.0 / 2.2));
  gl_Position = projectionMatrix * viewMatrix * vec4(world, 1.0);
}`;
const BODY_FRAGMENT = `#version 300 es
precision mediump float;
in vec3 colour; out vec4 seen;
void main() { seen = vec4(colour, 1.0); }`;
const POINT_VERTEX = `#version 300 es
in vec3 position; uniform mat4 viewMatrix; uniform mat4 projectionMatrix; uniform float size;
void main() {
  gl_Position = projectionMatrix * viewMatrix * vec4(position, 1.0);
  gl_PointSize = size;
}`;
const POINT_FRAGMENT = `#version 300 es
precision mediump float;
out vec4 seen;
void main() {
  if (length(gl_PointCoord - 0.5) > 0.5) discard;
  seen = vec4(0.85, 0.0, 0.1, 1.0);
}`;

// Least cosine between faces that look like one smooth surface.
const SMOOTH = 0.7;

// Vertices with normals: the mean of those faces around that look like one surface.
function faceted({ vertices, triangles }, smooth) {
  const corner = (index) => vertices.subarray(3 * index, 3 * index + 3);
  const [faces, around] = [[], []];
  for (let at = 0; at < triangles.length; at += 3) {
    const [a, b, c] = [0, 1, 2].map((k) => corner(triangles[at + k]));
    const [u, v] = [b, c].map((p) => [p[0] - a[0], p[1] - a[1], p[2] - a[2]]);
    const area = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    const norm = Math.hypot(...area) || 1;
    const face = { area, unit: area.map((k) => k / norm) };
    faces.push(face);
    for (let k = 0; k < 3; k++) (around[triangles[at + k]] ??= []).push(face);
  }
  const [position, normal, index, known] = [[], [], [], new Map()];
  triangles.forEach((vertex, at) => {
    const [x, y, z] = faces[Math.floor(at / 3)].unit;
    const sum = [0, 0, 0];
    for (const { area, unit } of around[vertex]) {
      if (x * unit[0] + y * unit[1] + z * unit[2] < smooth) continue;
      for (let k = 0; k < 3; k++) sum[k] += area[k];
    }
    const norm = Math.hypot(...sum) || 1;
    const key = `${vertex} ${sum.map((k) => (k / norm).toFixed(2))}`;
    if (!known.has(key)) {
      known.set(key, position.length / 3);
      position.push(...corner(vertex));
      normal.push(...sum.map((k) => k / norm));
    }
    index.push(known.get(key));
  });
  return { position, normal, index };
}

// Whether each edge has a neighbour, so that backs of triangles cannot be seen.
function isClosed({ triangles }) {
  const edges = new Set();
  const name = (at, next) => triangles[at] * 2 ** 26 + triangles[next];
  for (let at = 0; at < triangles.length; at += 3) {
    for (let k = 0; k < 3; k++) edges.add(name(at + k, at + ((k + 1) % 3)));
  }
  for (let at = 0; at < triangles.length; at += 3) {
    for (let k = 0; k < 3; k++) if (!edges.has(name(at + ((k + 1) % 3), at + k))) return false;
  }
  return true;
}

// Without a graphics card smooth edges cost more than all else.
function isSoftware() {
  const gl = document.createElement("canvas").getContext("webgl2");
  const named = gl?.getExtension("WEBGL_debug_renderer_info");
  return /swiftshader|llvmpipe|software/i.test(named ? gl.getParameter(named.UNMASKED_RENDERER_WEBGL) : "");
}

class Drawing {
  constructor(canvas, data) {
    this.data = data;
    this.canvas = canvas;
    const antialias = !isSoftware();
    this.renderer = new OGL.Renderer({ canvas, antialias, powerPreference: "high-performance" });
    this.gl = this.renderer.gl;
    this.camera = new OGL.Camera(this.gl, { fov: FIELD_OF_VIEW });
    this.level = 0;
    this.showsContacts = true;
    const sun = { value: [0.35, 0.8, 0.5].map((k, _, v) => k / Math.hypot(...v)) };
    const bodies = [false, this.gl.BACK].map((cullFace) => new OGL.Program(this.gl,
      { vertex: BODY_VERTEX, fragment: BODY_FRAGMENT, uniforms: { sun }, cullFace }));
    this.runs = data.runs.map((run) => ({ run, groups: this.groups(run, bodies), contacts: this.points(run) }));
    this.resize();
    this.look();
  }

  // For each shape of a run: its objects, and a mesh of each level that share their poses.
  groups(run, programs) {
    const linear = (colour) => colour.map((channel) => (channel / 255) ** 2.2);
    let moving = 0;
    const tints = run.shapes.map((_, object) =>
      linear(run.fixed[object] ? FIXED : PALETTE[moving++ % PALETTE.length]));
    const together = this.data.shapes.map((_, shape) =>
      run.shapes.flatMap((other, object) => (other === shape ? [object] : [])));
    return together.flatMap((objects) => {
      if (!objects.length) return [];
      const levels = this.data.shapes[run.shapes[objects[0]]];
      const instanced = (size, data) => ({ instanced: 1, size, data });
      const place = instanced(3, new Float32Array(3 * objects.length));
      const turn = instanced(4, new Float32Array(4 * objects.length));
      const tint = instanced(3, new Float32Array(objects.flatMap((object) => tints[object])));
      const program = programs[Number(isClosed(levels[0]))];
      const meshes = levels.map((level, at) => {
        // Many small bodies have all vertices once.
        const isSmooth = at > 0 && level.triangles.length > 3 * 24;
        const { position, normal, index } = faceted(level, isSmooth ? -1 : SMOOTH);
        const geometry = new OGL.Geometry(this.gl, {
          position: { size: 3, data: new Float32Array(position) },
          normal: { size: 3, data: new Float32Array(normal) },
          index: { data: new Uint32Array(index) },
          place: { ...place }, turn: { ...turn }, tint: { ...tint },
        });
        return new OGL.Mesh(this.gl, { geometry, program, frustumCulled: false });
      });
      return [{ objects, place: place.data, turn: turn.data, meshes }];
    });
  }

  // Contacts of a frame.
  points(run) {
    const most = Math.max(1, ...run.firsts.slice(1).map((end, frame) => end - run.firsts[frame]));
    const program = new OGL.Program(this.gl, {
      vertex: POINT_VERTEX, fragment: POINT_FRAGMENT, depthTest: false, depthWrite: false,
      uniforms: { size: { value: 4 * Math.min(window.devicePixelRatio, 2) } },
    });
    const position = { size: 3, data: new Float32Array(3 * most) };
    const geometry = new OGL.Geometry(this.gl, { position });
    return new OGL.Mesh(this.gl, { mode: this.gl.POINTS, geometry, program, frustumCulled: false });
  }

  // The camera that sees nearly all moving bodies, some times of the run together, from this side.
  look(side = VIEW) {
    const run = this.data.runs.at(-1);
    const isStill = run.fixed.every((fixed) => fixed);
    const bodies = run.shapes.flatMap((shape, object) => {
      if (run.fixed[object] && !isStill) return [];
      const { vertices } = this.data.shapes[shape][1];
      const reach = vertices.reduce((most, k) => Math.max(most, Math.abs(k)), 0);
      return [0.2, 0.6, 1].flatMap((share) => {
        const place = [];
        return pose(this.data, run, object, share * (run.frames - 1), place, []) ? [{ place, reach }] : [];
      });
    });
    const sorted = (numbers) => numbers.sort((a, b) => a - b);
    const most = (numbers) => sorted(numbers)[Math.ceil(0.97 * (numbers.length - 1))] ?? 1;
    const target = [0, 1, 2].map((axis) => {
      const along = sorted(bodies.map(({ place }) => place[axis]));
      return 0.5 * ((along[Math.floor(0.03 * along.length)] ?? 0) + most(along));
    });
    const dot = (u, v) => u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
    const back = side.map((k) => k / Math.hypot(...side));
    const flat = Math.hypot(back[0], back[2]);
    const right = [back[2] / flat, 0, -back[0] / flat];
    const up = [back[1] * right[2], back[2] * right[0] - back[0] * right[2], -back[1] * right[0]];
    const [view] = this.views();
    const slope = Math.tan((FIELD_OF_VIEW * Math.PI) / 360);
    const far = most(bodies.map(({ place, reach }) => {
      const from = place.map((k, axis) => k - target[axis]);
      const across = (Math.abs(dot(from, right)) + reach) * (view.height / view.width);
      return dot(from, back) + Math.max(across, Math.abs(dot(from, up)) + reach) / slope;
    }));
    this.camera.position.set(...target.map((k, axis) => k + far * back[axis]));
    Object.assign(this.camera, { near: 0.02 * far, far: 40 * far });
    this.orbit = new OGL.Orbit(this.camera,
      { element: this.canvas, target: new OGL.Vec3(...target), ease: 1, inertia: 0 });
  }

  // Of each run, its part of the canvas, in pixels from below.
  views() {
    const { width, height } = this.gl.canvas;
    const count = this.runs.length;
    return this.runs.map((_, index) => (width > height
      ? { x: Math.round((index * width) / count), y: 0, width: Math.round(width / count), height }
      : { x: 0, y: Math.round(((count - 1 - index) * height) / count), width,
        height: Math.round(height / count) }));
  }

  resize() {
    const { clientWidth, clientHeight } = this.canvas;
    this.renderer.dpr = Math.min(window.devicePixelRatio, 2);
    this.renderer.setSize(clientWidth, clientHeight);
    this.canvas.style.width = this.canvas.style.height = "";
  }

  draw(time) {
    const { gl, data, camera } = this;
    this.orbit.update();
    const views = this.views();
    camera.perspective({ aspect: views[0].width / views[0].height });
    camera.updateMatrixWorld();
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.viewport(0, 0, gl.canvas.width, gl.canvas.height);
    gl.depthMask(true);
    this.renderer.state.depthMask = true;
    gl.clearColor(...BACKGROUND, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    this.runs.forEach(({ run, groups, contacts }, index) => {
      const { x, y, width, height } = views[index];
      gl.viewport(x, y, width, height);
      for (const { objects, place, turn, meshes } of groups) {
        objects.forEach((object, at) => pose(data, run, object, time,
          place.subarray(3 * at, 3 * at + 3), turn.subarray(4 * at, 4 * at + 4)));
        const mesh = meshes[this.level];
        const { attributes } = mesh.geometry;
        attributes.place.needsUpdate = attributes.turn.needsUpdate = true;
        mesh.draw({ camera });
      }
      if (!this.showsContacts) return;
      const frame = Math.min(Math.floor(time), run.frames - 1);
      const [first, end] = [run.firsts[frame], run.firsts[frame + 1]];
      const { position } = contacts.geometry.attributes;
      for (let at = first; at < end; at++) {
        for (let k = 0; k < 3; k++) position.data[3 * (at - first) + k] = data.quantum * run.contacts[k][at];
      }
      position.needsUpdate = true;
      contacts.geometry.setDrawRange(0, end - first);
      if (end > first) contacts.draw({ camera });
    });
  }
}
