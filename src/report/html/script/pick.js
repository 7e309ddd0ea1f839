// Which triangle lies under the pointer: all that are shown are asked, which takes some milliseconds.
// Source: T. Moeller, B. Trumbore, Fast, minimum storage ray-triangle intersection, J. Graphics Tools 2 (1997).

// The nearest triangle that a ray meets on the kept side of the plane [x, y, z, w]: part, side, place; or null.
function pick(drawing, { origin, direction }, plane) {
  const { corners, triangles, parts } = drawing;
  let best = null;
  for (const part of parts) {
    if (part.hidden) continue;
    for (let i = 3 * part.first; i < 3 * (part.first + part.triangles); i += 3) {
      const [a, b, c] = [3 * triangles[i], 3 * triangles[i + 1], 3 * triangles[i + 2]];
      const u = [corners[b] - corners[a], corners[b + 1] - corners[a + 1], corners[b + 2] - corners[a + 2]];
      const v = [corners[c] - corners[a], corners[c + 1] - corners[a + 1], corners[c + 2] - corners[a + 2]];
      const p = cross(direction, v);
      const size = dot(u, p);
      if (size === 0) continue;
      const from = [origin[0] - corners[a], origin[1] - corners[a + 1], origin[2] - corners[a + 2]];
      const first = dot(from, p) / size;
      if (first < 0 || first > 1) continue;
      const q = cross(from, u);
      const second = dot(direction, q) / size;
      if (second < 0 || first + second > 1) continue;
      const distance = dot(v, q) / size;
      if (distance < 0 || (best && distance >= best.distance)) continue;
      const place = plus(origin, direction, distance);
      if (dot(plane, place) > plane[3]) continue;
      best = { part, front: size > 0, distance, place };
    }
  }
  return best;
}
