// Vectors as arrays of three; a turn is three rows: what is to the right, up, and towards the eye, in coordinates of the system.

const plus = (a, b, factor = 1) => [a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2]];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const scaled = (a, factor) => [a[0] * factor, a[1] * factor, a[2] * factor];
const unit = (a) => scaled(a, 1 / (Math.hypot(...a) || 1));

// The turn, turned about its own right and up axes (rad).
function turned(turn, aboutRight, aboutUp) {
  const [right, up, back] = turn;
  const [c, s] = [Math.cos(aboutUp), Math.sin(aboutUp)];
  const aside = plus(scaled(right, c), back, -s);
  const towards = plus(scaled(back, c), right, s);
  const [d, t] = [Math.cos(aboutRight), Math.sin(aboutRight)];
  const upward = plus(scaled(up, d), towards, -t);
  const forward = plus(scaled(towards, d), up, t);
  return upright([aside, upward, forward]);
}

// The same with the rounding of many turns taken out.
function upright([right, , back]) {
  const towards = unit(back);
  const aside = unit(plus(right, towards, -dot(right, towards)));
  return [aside, cross(towards, aside), towards];
}

// Parallel projection: `half` is half the height that is seen, `deep` half the depth. Columns, as WebGL wants them.
function projection(turn, target, half, aspect, deep) {
  const rows = [scaled(turn[0], 1 / (half * aspect)), scaled(turn[1], 1 / half), scaled(turn[2], -1 / deep)];
  const column = (i) => [rows[0][i], rows[1][i], rows[2][i], 0];
  return new Float32Array([...column(0), ...column(1), ...column(2), ...rows.map((row) => -dot(row, target)), 1]);
}
