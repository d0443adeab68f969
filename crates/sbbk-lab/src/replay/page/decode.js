// Reads what `encode.rs` writes.

async function decode(text) {
  const packed = Uint8Array.from(atob(text.trim()), (char) => char.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"));
  const data = await new Response(stream).json();
  const summed = (differences) => {
    let last = 0;
    return Int32Array.from(differences, (difference) => (last += difference));
  };
  for (const level of data.shapes.flat()) {
    level.vertices = new Float32Array(level.vertices);
    level.triangles = new Uint32Array(level.triangles);
  }
  for (const run of data.runs) {
    run.times = new Float32Array(run.times);
    run.poses = run.poses.map(summed);
    run.contacts = run.contacts.map(summed);
    run.frames = run.counts.length;
    run.firsts = [0];
    run.counts.forEach((count) => run.firsts.push(run.firsts.at(-1) + count));
  }
  return data;
}

// Writes place and rotation of an object between two frames; whether it is there.
function pose(data, run, object, time, place, turn) {
  const frame = Math.min(Math.floor(time), run.frames - 1);
  const next = Math.min(frame + 1, run.frames - 1);
  const share = time - frame;
  const [one, other] = [frame, next].map((frame) => object * run.frames + frame);
  const mixed = (part) => {
    const numbers = run.poses[part];
    return numbers[one] + share * (numbers[other] - numbers[one]);
  };
  let norm = 0;
  for (let part = 0; part < 4; part++) {
    turn[part] = mixed(3 + part);
    norm += turn[part] ** 2;
  }
  // Half of a rotation is left where the other frame has none.
  const is_there = norm > (0.6 * data.turn) ** 2;
  for (let part = 0; part < 4; part++) turn[part] *= is_there ? norm ** -0.5 : 0;
  for (let axis = 0; axis < 3; axis++) place[axis] = data.quantum * mixed(axis);
  return is_there;
}
