// The blocks of data of the page, taken apart. All scripts of a page are one module: strict, and nothing of them is global.

const bytes = (text) => Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
const singles = (text) => new Float32Array(bytes(text).buffer);
const words = (text) => new Uint32Array(bytes(text).buffer);

// The element of an id, or null.
const element = (id) => document.getElementById(id);

// A block of JSON, or null where the page has none.
function block(id) {
  const found = element(id);
  return found ? JSON.parse(found.textContent) : null;
}

// A new element with attributes and children.
function made(name, attributes = {}, ...children) {
  const node = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) node.setAttribute(key, value);
  node.append(...children);
  return node;
}

// The drawing: corners and triangles as arrays, `first` the first triangle of every part, ways with their own points.
function readDrawing() {
  const drawing = block("drawing");
  if (!drawing) return null;
  drawing.corners = singles(drawing.corners);
  drawing.triangles = words(drawing.triangles);
  let first = 0;
  for (const [index, part] of drawing.parts.entries()) {
    Object.assign(part, { index, first, hidden: false });
    first += part.triangles;
  }
  const points = singles(drawing.points);
  let start = 0;
  for (const way of drawing.ways) {
    way.points = points.subarray(start, (start += 3 * way.points));
  }
  return drawing;
}

// Least and greatest corner of everything that is drawn.
function bounds(corners) {
  const low = [Infinity, Infinity, Infinity];
  const high = [-Infinity, -Infinity, -Infinity];
  for (let i = 0; i < corners.length; i++) {
    low[i % 3] = Math.min(low[i % 3], corners[i]);
    high[i % 3] = Math.max(high[i % 3], corners[i]);
  }
  return corners.length ? [low, high] : [[-1, -1, -1], [1, 1, 1]];
}

// A colour of the style, such as "--ink", as [r, g, b] from 0 to 1.
function styleColour(name) {
  const text = getComputedStyle(document.documentElement).getPropertyValue(name).trim();
  return hex(text);
}

function hex(text) {
  const long = text.length === 4 ? text.replace(/[0-9a-f]/gi, "$&$&") : text;
  return [1, 3, 5].map((at) => parseInt(long.slice(at, at + 2), 16) / 255);
}

// A number with some digits, and a true minus sign.
function digits(value, count = 4) {
  if (!Number.isFinite(value)) return "–";
  const size = Math.abs(value);
  const text = size !== 0 && (size < 1e-3 || size >= 1e5) ? value.toExponential(count - 1) : String(Number(value.toPrecision(count)));
  const [mantissa, power] = text.split("e");
  const raised = power ? " × 10" + [...String(Number(power))].map((c) => "⁰¹²³⁴⁵⁶⁷⁸⁹"[c] ?? "⁻").join("") : "";
  return mantissa.replace("-", "−") + raised;
}
