// Reads the sheet of a run from the page: arrays of sheet_data.py.
"use strict";

/** Array of numbers from deflated bytes of equal weight side by side. */
async function inflated({shape, data}, Kind) {
  const bytes = Uint8Array.from(atob(data), (letter) => letter.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  const planes = new Uint8Array(await new Response(stream).arrayBuffer());
  const size = Kind.BYTES_PER_ELEMENT, count = planes.length / size, mixed = new Uint8Array(planes.length);
  for (let plane = 0; plane < size; plane++)
    for (let i = 0; i < count; i++) mixed[i * size + plane] = planes[plane * count + i];
  return {shape, values: new Kind(mixed.buffer)};
}

/** Integers whose differences along the last axis are stored; a list of its rows. */
async function integers(packed) {
  const {shape, values} = await inflated(packed, Uint32Array);
  const length = shape[shape.length - 1], rows = length ? values.length / length : shape[0], found = [];
  for (let row = 0; row < rows; row++) {
    const part = new Int32Array(length);
    for (let i = 0, sum = 0; i < length; i++) {
      const step = values[row * length + i];
      part[i] = sum += (step >>> 1) ^ -(step & 1);
    }
    found.push(part);
  }
  return found;
}

/** Arrays of a sheet: position[frame] = [x, y] and speed[frame] in multiples of their quanta, bonds, triangles. */
async function readSheet(data) {
  const sheet = {...data};
  const names = ["position", "speed", "site", "degree", "bonds", "bondEnd", "triangles", "triangleEnd"];
  for (const name of names) sheet[name] = await integers(data[name]);
  for (const name of ["site", "degree", "bondEnd", "triangleEnd"]) sheet[name] = sheet[name][0];
  const rows = sheet.position; // x and y of each frame, as differences to the frame before
  for (let row = 2; row < rows.length; row++)
    for (let i = 0; i < rows[row].length; i++) rows[row][i] += rows[row - 2][i];
  sheet.position = sheet.times.map((_, frame) => rows.slice(2 * frame, 2 * frame + 2));
  const {values, shape} = await inflated(data.reference, Float64Array);
  sheet.reference = [values.subarray(0, shape[1]), values.subarray(shape[1])];
  sheet.length = lengths(sheet.reference, sheet.bonds);
  for (const name of Object.keys(data.colours)) {
    const rgb = atob(data.colours[name]), table = new Uint32Array(257);
    for (let i = 0; i < 256; i++)
      table[i] = 0xff000000 | rgb.charCodeAt(3 * i + 2) << 16 | rgb.charCodeAt(3 * i + 1) << 8 | rgb.charCodeAt(3 * i);
    table[256] = name === "stretch" ? 0xff005ed5 : table[255]; // beyond the breaking stretch
    sheet.colours[name] = table;
  }
  return sheet;
}

/** Distance of the ends of each bond. */
function lengths([x, y], [from, to]) {
  const found = new Float64Array(from.length);
  for (let i = 0; i < from.length; i++) { // Math.hypot takes ten times as long
    const u = x[from[i]] - x[to[i]], v = y[from[i]] - y[to[i]];
    found[i] = Math.sqrt(u * u + v * v);
  }
  return found;
}
