// Where one looks from, and how mouse, touch and keys change it. Parallel projection: lengths can be compared everywhere.

// How much one step of a key turns (rad), moves (of the height) and zooms.
const STEP = { turn: Math.PI / 24, move: 0.06, zoom: 1.15 };

// A camera on the box from `low` to `high`; `changed` is called whenever it moves.
function makeCamera(low, high, changed) {
  const centre = scaled(plus(low, high), 0.5);
  const size = plus(high, low, -1);
  const radius = 0.5 * Math.hypot(...size) || 1;
  // The longest side lies across the screen, y stands upright if it can.
  const across = size.indexOf(Math.max(...size));
  const upward = across === 1 ? 2 : 1;
  const depth = 3 - across - upward;
  const axis = (i) => [0, 1, 2].map((k) => (k === i ? 1 : 0));
  const camera = { turn: null, target: null, half: null, aspect: 1.6, radius, depth };

  camera.look = (along) => {
    const beside = along === depth ? across : along === across ? depth : across;
    const [right, back] = [axis(beside), axis(along)];
    const up = cross(back, right);
    const sign = up.some((x) => x < 0) ? -1 : 1;
    camera.turn = [right, scaled(up, sign), scaled(back, sign)];
    camera.fit();
  };
  camera.reset = () => {
    camera.look(depth);
    camera.turn = turned(camera.turn, 0.32, -0.45);
    camera.fit();
  };
  // All of the box is seen.
  camera.fit = () => {
    const reach = (row) => [0, 1, 2].reduce((sum, k) => sum + 0.5 * size[k] * Math.abs(row[k]), 0);
    camera.target = centre;
    camera.half = 1.12 * Math.max(reach(camera.turn[1]), reach(camera.turn[0]) / camera.aspect, 0.05 * radius);
    changed();
  };
  camera.spin = (x, y) => {
    camera.turn = turned(camera.turn, y, x);
    changed();
  };
  // By parts of the height.
  camera.move = (x, y) => {
    camera.target = plus(plus(camera.target, camera.turn[0], -2 * camera.half * x), camera.turn[1], 2 * camera.half * y);
    changed();
  };
  // Keeps what is at (x, y), from -1 to 1, in its place.
  camera.zoom = (factor, x = 0, y = 0) => {
    const half = Math.min(Math.max(camera.half * factor, 1e-5 * radius), 50 * radius);
    const shift = camera.half - half;
    camera.target = plus(plus(camera.target, camera.turn[0], shift * camera.aspect * x), camera.turn[1], shift * y);
    camera.half = half;
    changed();
  };
  // The line of sight through (x, y), from -1 to 1.
  camera.sight = (x, y) => {
    const across = plus(camera.target, camera.turn[0], camera.half * camera.aspect * x);
    const origin = plus(plus(across, camera.turn[1], camera.half * y), camera.turn[2], 60 * radius);
    return { origin, direction: scaled(camera.turn[2], -1) };
  };
  camera.matrix = () => projection(camera.turn, camera.target, camera.half, camera.aspect, 60 * radius);
  camera.look(depth);
  return camera;
}

// Lets a canvas steer a camera; `clicked` gets the place of a click, from -1 to 1.
function steer(canvas, camera, clicked) {
  const down = new Map();
  let travelled = 0;
  let spread = null;
  const place = (event) => {
    const box = canvas.getBoundingClientRect();
    return [(2 * (event.clientX - box.left)) / box.width - 1, 1 - (2 * (event.clientY - box.top)) / box.height];
  };
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    canvas.focus({ preventScroll: true });
    down.set(event.pointerId, [event.clientX, event.clientY]);
    if (down.size === 1) travelled = 0;
    spread = null;
  });
  canvas.addEventListener("pointermove", (event) => {
    const from = down.get(event.pointerId);
    if (!from) return;
    const [x, y] = [event.clientX - from[0], event.clientY - from[1]];
    travelled += Math.hypot(x, y);
    down.set(event.pointerId, [event.clientX, event.clientY]);
    const height = canvas.clientHeight;
    if (down.size === 2) {
      const [a, b] = [...down.values()];
      const apart = Math.hypot(a[0] - b[0], a[1] - b[1]);
      if (spread) camera.zoom(spread / apart);
      spread = apart;
      camera.move((0.5 * x) / height, (0.5 * y) / height);
    } else if (event.shiftKey || event.buttons & 6) camera.move(x / height, y / height);
    else camera.spin((-Math.PI * x) / height, (Math.PI * y) / height);
  });
  const up = (event) => {
    const was = down.delete(event.pointerId);
    if (was && event.type === "pointerup" && travelled < 5 && down.size === 0) clicked(...place(event));
  };
  canvas.addEventListener("pointerup", up);
  canvas.addEventListener("pointercancel", up);
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    camera.zoom(Math.exp(0.0015 * event.deltaY), ...place(event));
  }, { passive: false });
  canvas.addEventListener("keydown", (event) => {
    const [x, y] = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key] ?? [0, 0];
    const steps = { "+": 1 / STEP.zoom, "=": 1 / STEP.zoom, "-": STEP.zoom };
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (x || y) event.shiftKey ? camera.move(STEP.move * x, STEP.move * y) : camera.spin(-STEP.turn * x, STEP.turn * y);
    else if (steps[event.key]) camera.zoom(steps[event.key]);
    else if (event.key === "0") camera.reset();
    else if (event.key === "Enter") clicked(0, 0);
    else return;
    event.preventDefault();
  });
}
