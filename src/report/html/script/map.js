// Maps that answer: what is in the pixel under the pointer, and the cross-sections through it. A click holds the place, arrow keys move it.

// Smallest decade of a cross-section, below its largest.
const DECADES = 6;

function startMaps() {
  const maps = block("maps") ?? [];
  for (const figure of document.querySelectorAll("[data-map]")) {
    const map = maps.find((map) => map.detector === figure.dataset.map);
    const image = figure.querySelector("image.pixels");
    if (map && image) readOut(figure, image, map);
  }
}

function readOut(figure, image, map) {
  const [rows, columns] = map.shape;
  const [mean, error] = [singles(map.mean), singles(map.error)];
  const stray = map.stray ? singles(map.stray) : null;
  let place = null;
  let held = false;
  const said = made("p", { class: "note readout", role: "status" }, "Point at the map to read a pixel; a click holds it.");
  const sections = made("div", { class: "sections" });
  figure.append(said, sections);
  figure.tabIndex = 0;
  figure.setAttribute("aria-label", `Map of ${map.detector}: arrow keys move from pixel to pixel`);
  const cross = [1, 2].map(() => document.createElementNS(image.namespaceURI, "line"));
  cross.forEach((line) => (line.classList.add("cross"), image.parentNode.append(line)));

  // A length of an axis in mm.
  const at = (axis, bin) => `${map.axes[axis].name} ${digits(1e3 * (map.axes[axis].start + (bin + 0.5) * map.axes[axis].step), 5)} mm`;
  function show() {
    const [row, column] = place;
    const bin = row * columns + column;
    const apart = stray ? `, stray ${digits(stray[bin], 3)}` : "";
    said.textContent = `row ${row}, column ${column} (${at(0, column)}, ${at(1, row)}): ${digits(mean[bin], 3)} ± ${digits(error[bin], 2)} ${map.unit}${apart}${held ? " · held" : ""}`;
    const [width, height] = [image.width.baseVal.value, image.height.baseVal.value];
    const [x, y] = [((column + 0.5) / columns) * width, (1 - (row + 0.5) / rows) * height];
    const ends = [[0, y, width, y], [x, 0, x, height]];
    cross.forEach((line, k) => ["x1", "y1", "x2", "y2"].forEach((name, i) => line.setAttribute(name, ends[k][i])));
    const along = (values) => values.subarray(row * columns, (row + 1) * columns);
    const up = (values) => Float32Array.from({ length: rows }, (_, r) => values[r * columns + column]);
    const lines = (slice) => [slice(mean), ...(stray ? [slice(stray)] : [])];
    sections.replaceChildren(
      profile(image.namespaceURI, `Row ${row}`, lines(along), column, map, 0),
      profile(image.namespaceURI, `Column ${column}`, lines(up), row, map, 1),
    );
  }
  const clamp = (value, count) => Math.min(Math.max(value, 0), count - 1);
  function point(event) {
    const box = image.getBoundingClientRect();
    const [x, y] = [(event.clientX - box.left) / box.width, (box.bottom - event.clientY) / box.height];
    if (x < 0 || x > 1 || y < 0 || y > 1) return false;
    place = [clamp(Math.floor(y * rows), rows), clamp(Math.floor(x * columns), columns)];
    return true;
  }
  figure.addEventListener("pointermove", (event) => !held && point(event) && show());
  figure.addEventListener("click", (event) => {
    if (!point(event)) return;
    held = !held;
    show();
  });
  figure.addEventListener("keydown", (event) => {
    const step = { ArrowLeft: [0, -1], ArrowRight: [0, 1], ArrowUp: [1, 0], ArrowDown: [-1, 0] }[event.key];
    if (!step) return;
    event.preventDefault();
    const [row, column] = place ?? [Math.floor(rows / 2), Math.floor(columns / 2)];
    place = [clamp(row + step[0], rows), clamp(column + step[1], columns)];
    held = true;
    show();
  });
}

// Logarithmic curves over the bins of a row or a column: all light, and stray light.
function profile(space, title, curves, marked, map, axis) {
  const [width, height, left, bottom] = [300, 120, 46, 22];
  const svg = (name, attributes) => {
    const node = document.createElementNS(space, name);
    for (const [key, value] of Object.entries(attributes)) node.setAttribute(key, value);
    return node;
  };
  const text = (x, y, content, anchor = "start") => {
    const node = svg("text", { x, y, "text-anchor": anchor });
    node.textContent = content;
    return node;
  };
  const top = Math.ceil(Math.log10(Math.max(...curves[0], 1e-300)));
  const lit = curves.flatMap((curve) => [...curve]).filter((value) => value > 0);
  const floor = Math.max(Math.floor(Math.log10(Math.min(...lit, 10 ** top))), top - DECADES);
  const count = curves[0].length;
  const x = (bin) => left + ((bin + 0.5) / count) * (width - left - 4);
  const y = (value) => 14 + (height - bottom - 14) * (1 - (Math.log10(Math.max(value, 10 ** floor)) - floor) / Math.max(top - floor, 1));
  const drawn = svg("svg", { viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": title });
  drawn.append(svg("rect", { class: "frame", x: left, y: 14, width: width - left - 4, height: height - bottom - 14 }));
  drawn.append(svg("line", { class: "cross", x1: x(marked), x2: x(marked), y1: 14, y2: height - bottom }));
  curves.forEach((curve, k) => {
    const points = Array.from(curve, (value, bin) => `${x(bin).toFixed(1)},${y(value).toFixed(1)}`).join(" ");
    drawn.append(svg("polyline", { class: k ? "stray" : "all", points }));
  });
  const edge = (bin) => digits(1e3 * (map.axes[axis].start + bin * map.axes[axis].step), 3);
  drawn.append(text(left, 10, title + (curves.length > 1 ? ": all light, stray light" : "")));
  drawn.append(text(left - 4, 22, digits(10 ** top, 1), "end"), text(left - 4, height - bottom, digits(10 ** floor, 1), "end"));
  drawn.append(text(left, height - 6, edge(0)), text(width - 4, height - 6, `${edge(count)} mm`, "end"));
  return drawn;
}

startMaps();
