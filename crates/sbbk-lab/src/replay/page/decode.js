// Reads what `encode.rs` writes.

async function decode(text) {
  const packed = Uint8Array.from(atob(text.trim()), (char) => char.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"));
  const buffer = await new Response(stream).arrayBuffer();
  const length = new DataView(buffer).getUint32(0, true);
  const header = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 4, length)));
  let at = 4 + Math.ceil(length / 4) * 4;
  const take = (bytes) => buffer.slice(at, (at += bytes));

  // Differences, folded, by bytes: lowest, middle, highest.
  const planes = (lists, count) => Array.from({ length: lists }, () => {
    const bytes = new Uint8Array(take(3 * count));
    const numbers = new Int32Array(count);
    for (let index = 0, last = 0; index < count; index++) {
      const folded = bytes[index] | (bytes[count + index] << 8) | (bytes[2 * count + index] << 16);
      numbers[index] = last += (folded >>> 1) ^ -(folded & 1);
    }
    return numbers;
  });

  const shapes = header.shapes.map((levels) => levels.map(([vertices, triangles]) => ({
    vertices: new Float32Array(take(12 * vertices)),
    triangles: new Uint32Array(take(12 * triangles)),
  })));
  const runs = header.runs.map((run) => {
    const times = new Float32Array(take(4 * run.steps));
    const poses = planes(7, run.shapes.length * run.frames);
    const counts = new Uint32Array(take(4 * run.frames));
    const contacts = planes(3, run.contacts);
    const firsts = [0];
    counts.forEach((count) => firsts.push(firsts.at(-1) + count));
    return { ...run, times, poses, contacts, firsts };
  });
  return { ...header, shapes, runs };
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
