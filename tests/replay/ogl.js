// What the page needs of OGL.
export { Renderer } from 'ogl/src/core/Renderer.js';
export { Camera } from 'ogl/src/core/Camera.js';
export { Geometry } from 'ogl/src/core/Geometry.js';
export { Program } from 'ogl/src/core/Program.js';
export { Mesh } from 'ogl/src/core/Mesh.js';
export { Orbit } from 'ogl/src/extras/Orbit.js';
export { Vec3 } from 'ogl/src/math/Vec3.js';
