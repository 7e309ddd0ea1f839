// What is drawn of a drawing: corners with normals, edges, the lines of a section, ways as segments.

// Faces that meet at a smaller angle than this share a normal; a larger one is an edge.
const CREASE = Math.cos((35 * Math.PI) / 180);

// Normal of every triangle, unit, and its area.
function facets(drawing) {
  const { corners, triangles } = drawing;
  const count = triangles.length / 3;
  const normals = new Float32Array(3 * count);
  const areas = new Float32Array(count);
  const at = (index) => [corners[3 * index], corners[3 * index + 1], corners[3 * index + 2]];
  for (let t = 0; t < count; t++) {
    const [a, b, c] = [at(triangles[3 * t]), at(triangles[3 * t + 1]), at(triangles[3 * t + 2])];
    const doubled = cross(plus(b, a, -1), plus(c, a, -1));
    areas[t] = 0.5 * Math.hypot(...doubled);
    normals.set(unit(doubled), 3 * t);
  }
  return { normals, areas };
}

// Nine numbers for each triangle's corners, and as many for their normals: smooth where faces meet flatly.
function shaded(drawing, { normals, areas }) {
  const { corners, triangles } = drawing;
  const faces = Array.from({ length: corners.length / 3 }, () => []);
  triangles.forEach((corner, i) => faces[corner].push(Math.floor(i / 3)));
  const places = new Float32Array(3 * triangles.length);
  const smooth = new Float32Array(3 * triangles.length);
  for (let i = 0; i < triangles.length; i++) {
    const corner = triangles[i];
    const own = 3 * Math.floor(i / 3);
    for (let k = 0; k < 3; k++) places[3 * i + k] = corners[3 * corner + k];
    for (const face of faces[corner]) {
      const [x, y, z] = [normals[3 * face], normals[3 * face + 1], normals[3 * face + 2]];
      if (x * normals[own] + y * normals[own + 1] + z * normals[own + 2] < CREASE) continue;
      smooth[3 * i] += areas[face] * x;
      smooth[3 * i + 1] += areas[face] * y;
      smooth[3 * i + 2] += areas[face] * z;
    }
  }
  return { places, smooth };
}

// Ends of the edges of every part: where it ends or bends. Per part [first, count] in corners.
function edges(drawing, { normals }) {
  const { corners, triangles, parts } = drawing;
  const ends = [];
  const ranges = [];
  const bends = (a, b) => [0, 1, 2].reduce((sum, k) => sum + normals[3 * a + k] * normals[3 * b + k], 0) < CREASE;
  for (const part of parts) {
    const known = new Map();
    const first = ends.length / 3;
    for (let t = part.first; t < part.first + part.triangles; t++) {
      for (let k = 0; k < 3; k++) {
        const [a, b] = [triangles[3 * t + k], triangles[3 * t + ((k + 1) % 3)]].sort((p, q) => p - q);
        const key = a * 4294967296 + b;
        const other = known.get(key);
        known.set(key, other === undefined ? t : other === -1 || !bends(other, t) ? -1 : -2 - t);
      }
    }
    for (const [key, state] of known) {
      if (state === -1) continue;
      for (const corner of [Math.floor(key / 4294967296), key % 4294967296]) {
        ends.push(corners[3 * corner], corners[3 * corner + 1], corners[3 * corner + 2]);
      }
    }
    ranges.push([first, ends.length / 3 - first]);
  }
  return { ends: new Float32Array(ends), ranges };
}

// Segments in which the plane at `place` along an axis cuts the triangles of parts that are shown: [a, b] after each other.
function sectionLines(drawing, axis, place) {
  const { corners, triangles, parts } = drawing;
  const lines = [];
  for (const part of parts) {
    if (part.hidden) continue;
    for (let i = 3 * part.first; i < 3 * (part.first + part.triangles); i += 3) {
      const heights = [0, 1, 2].map((k) => corners[3 * triangles[i + k] + axis] - place);
      if (heights.every((h) => h > 0) || heights.every((h) => h <= 0)) continue;
      for (let k = 0; k < 3; k++) {
        const [here, there] = [heights[k], heights[(k + 1) % 3]];
        if (here > 0 === there > 0) continue;
        const [a, b] = [3 * triangles[i + k], 3 * triangles[i + ((k + 1) % 3)]];
        const share = here / (here - there);
        for (let c = 0; c < 3; c++) lines.push(corners[a + c] + share * (corners[b + c] - corners[a + c]));
      }
    }
  }
  return lines;
}

// Ten numbers for each segment of ways: both ends, red, green, blue and opacity.
function segments(ways, colourOf) {
  const all = [];
  for (const way of ways) {
    const colour = colourOf(way);
    if (!colour) continue;
    for (let i = 0; i + 5 < way.points.length; i += 3) all.push(...way.points.subarray(i, i + 6), ...colour);
  }
  return new Float32Array(all);
}

// Needles on up to `most` triangles that are shown, as segments.
function needles(drawing, { normals }, length, colour, most = 4000) {
  const { corners, triangles, parts } = drawing;
  const all = [];
  const step = Math.max(1, Math.ceil(triangles.length / 3 / most));
  for (const part of parts) {
    if (part.hidden) continue;
    for (let t = part.first; t < part.first + part.triangles; t += step) {
      const foot = [0, 1, 2].map((k) => [0, 1, 2].reduce((sum, c) => sum + corners[3 * triangles[3 * t + c] + k] / 3, 0));
      all.push(...foot, ...foot.map((x, k) => x + length * normals[3 * t + k]), ...colour);
    }
  }
  return new Float32Array(all);
}
