// The view: its buttons, the list of parts, what is said of what was picked.

// Opacity of glass beside that of walls.
const GLASS = 0.22;
const MOST_LISTED = 400;

function startStage() {
  const [canvas, drawing] = [element("canvas"), readDrawing()];
  if (!canvas || !drawing) return null;
  const flat = facets(drawing);
  const painter = makePainter(canvas, drawing, shaded(drawing, flat), edges(drawing, flat));
  if (!painter) {
    canvas.replaceWith(made("p", { class: "note" }, "This browser has no WebGL 2, which the 3-D view needs."));
    return null;
  }
  const [low, high] = bounds(drawing.corners);
  const state = { picked: null, chosen: null, wanted: false };
  const redraw = () => {
    if (!state.wanted) requestAnimationFrame(draw);
    state.wanted = true;
  };
  const camera = makeCamera(low, high, redraw);
  const value = (id) => element(id).value;
  const shown = (id) => element(id).checked;

  // [x, y, z, w]: what lies beyond is cut away; and where it stands.
  function plane() {
    const axis = value("axis");
    if (axis === "") return { cut: [0, 0, 0, 1], axis: null };
    const sign = shown("flip") ? -1 : 1;
    const place = low[axis] + (0.5 + value("slide") / 2002) * (high[axis] - low[axis]);
    const cut = [0, 0, 0, sign * place];
    cut[axis] = sign;
    return { cut, axis: Number(axis), place };
  }

  function tints(look) {
    const { palette, of } = colouring(drawing.parts, value("colour"));
    const opacity = value("opacity") / 100;
    const [ink, accent] = [styleColour("--ink"), styleColour("--accent")];
    look.parts = drawing.parts.map((part) => {
      const solid = (isGlass(part) ? GLASS : 1) * opacity;
      const lit = state.picked === part ? 0.35 : 0;
      const tint = (side) => [...hex(of(part, side)).map((x, k) => x + lit * (accent[k] - x)), solid];
      const strong = part.detectors.length || state.picked === part;
      return { front: tint(0), back: tint(1), edge: strong ? [...accent, 1] : [...ink, 0.3] };
    });
    return palette;
  }

  // The square of the section plane, and the solids that it fills.
  function sheet(look, { axis, place }, palette) {
    const size = 4 * camera.radius;
    const others = [0, 1, 2].filter((k) => k !== axis);
    const corner = ([x, y]) => [0, 1, 2].map((k) => (k === axis ? place : 0.5 * (low[k] + high[k]) + size * (k === others[0] ? x : y)));
    look.cut = new Float32Array([[-1, -1], [1, -1], [-1, 1], [1, 1]].flatMap(corner));
    const solid = drawing.parts.filter((part) => part.solid || isGlass(part));
    const within = (part) => (isGlass(part) ? part.media[1] : "");
    look.fills = [...new Set(solid.map(within))].map((medium) => {
      const glass = value("colour") === "medium" ? hex(palette.get(medium) ?? "#9cc3dd") : hex("#9cc3dd");
      return { parts: solid.filter((part) => within(part) === medium), colour: medium ? [...glass, 0.85] : [...styleColour("--cut"), 1] };
    });
  }

  let buffers = null;
  // What changes only with the controls is made once for many turns.
  function prepared() {
    if (buffers) return buffers;
    const cut = plane();
    const look = { plane: cut.cut, edges: shown("edges"), ribbons: [], paper: styleColour("--stage"), cut: null, fills: [] };
    const palette = tints(look);
    const add = (data, width, nearer) => data.length && look.ribbons.push({ ...painter.ribbons(data), width, nearer });
    if (cut.axis !== null) {
      sheet(look, cut, palette);
      const lines = sectionLines(drawing, cut.axis, cut.place);
      const ink = styleColour("--ink");
      const data = [];
      for (let i = 0; i + 5 < lines.length; i += 6) data.push(...lines.slice(i, i + 6), ...ink, 1);
      add(new Float32Array(data), 1.5, 1e-5);
    }
    const light = lightColours();
    if (shown("rays")) add(segments(drawing.ways.filter((way) => isFrom(way) && !isChosen(way)), (way) => [...hex(light.get(key(way))), state.chosen ? 0.15 : 0.75]), 1, 0);
    if (state.chosen) add(segments(drawing.ways.filter(isChosen), (way) => [...hex(light.get(key(way))), 1]), 2.6, 0.5);
    if (shown("normals")) add(needles(drawing, flat, 0.02 * camera.radius, [...styleColour("--accent"), 1]), 1, 0);
    legend(palette, light);
    return (buffers = look);
  }

  const isFrom = (way) => value("from") === "" || way.source === value("from");
  const key = (way) => way[value("raycolour")];
  const isChosen = (way) => state.chosen !== null && way.path !== null && way.path.join("\n") === state.chosen;
  function lightColours() {
    const names = [...new Set(drawing.ways.filter((way) => isFrom(way) || isChosen(way)).map(key))];
    return value("raycolour") === "class" ? new Map(names.map((name) => [name, classColour(name)])) : paletteOf(names);
  }

  function legend(palette, light) {
    const entry = (shape) => ([name, colour]) => {
      const swatch = made("span", { class: shape });
      swatch.style.background = colour;
      return made("li", {}, swatch, name);
    };
    const rows = [...palette].map(entry("swatch"));
    element("legend").replaceChildren(...rows, ...(shown("rays") ? [...light].map(entry("swatch ray")) : []));
  }

  function draw() {
    state.wanted = false;
    const scale = Math.min(window.devicePixelRatio || 1, 2);
    const [width, height] = [Math.round(scale * canvas.clientWidth), Math.round(scale * canvas.clientHeight)];
    if (width === 0 || height === 0) return;
    if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
    painter.paint(camera, { ...prepared(), scale, sight: camera.turn[2] });
  }
  function changed() {
    buffers?.ribbons.forEach(painter.free);
    buffers = null;
    redraw();
  }

  const millimetres = (place) => "(" + place.map((x, k) => digits(1e3 * (x + drawing.centre[k]), 5)).join(", ") + ") mm";
  function tell(hit) {
    state.picked = hit?.part ?? null;
    const said = element("picked");
    if (hit) {
      const { part } = hit;
      const finish = (side) => part.speculars[side] + (part.scatters[side] ? " + scatter " + part.scatters[side] : "");
      const same = finish(0) === finish(1);
      const where = hit.place ? ` · ${hit.front ? "front" : "back"} at ${millimetres(hit.place)}` : "";
      const finishes = same ? finish(0) : `front ${finish(0)}, back ${finish(1)}`;
      const media = isGlass(part) ? ` · ${part.media[0]} in front, ${part.media[1]} behind` : ` · in ${part.media[0]}`;
      const seen = part.detectors.length ? ` · detector ${part.detectors.join(", ")}` : "";
      said.replaceChildren(made("b", {}, part.label), where, made("br"), `${finishes}${media}${seen} · ${digits(1e6 * part.area)} mm²`);
    } else said.replaceChildren();
    for (const row of element("parts").children) row.classList.toggle("on", row.dataset.part === String(state.picked?.index));
    changed();
  }

  function list() {
    const wanted = element("find").value.toLowerCase();
    const found = drawing.parts.filter((part) => (part.label + NAMES.finish(part, 0)).toLowerCase().includes(wanted));
    const rows = found.slice(0, MOST_LISTED).map((part) => {
      const box = made("input", { type: "checkbox", "aria-label": "show " + part.label });
      box.checked = !part.hidden;
      box.addEventListener("change", () => {
        part.hidden = !box.checked;
        changed();
      });
      const name = made("button", { type: "button", class: "name" }, part.label);
      name.addEventListener("click", () => tell({ part }));
      return made("li", { "data-part": part.index }, box, name);
    });
    if (found.length > MOST_LISTED) rows.push(made("li", {}, `and ${found.length - MOST_LISTED} more`));
    element("parts").replaceChildren(...rows);
    element("count").textContent = found.length === drawing.parts.length ? found.length : `${found.length} of ${drawing.parts.length}`;
    return found;
  }
  const hide = (hidden) => {
    list().forEach((part) => (part.hidden = hidden));
    list();
    changed();
  };

  const sources = [...new Set(drawing.ways.map((way) => way.source))];
  element("from").replaceChildren(made("option", { value: "" }, "all sources"), ...sources.map((name) => made("option", { value: name }, name)));
  // The rays of many sources at once are a blot.
  if (sources.length > 3) element("from").value = sources[0];
  // The half before the eye is cut away.
  element("axis").value = String(camera.depth);
  element("flip").checked = camera.turn[2][camera.depth] < 0;
  element("panel").addEventListener("submit", (event) => event.preventDefault());
  for (const id of ["colour", "opacity", "rays", "normals", "edges", "raycolour", "from", "axis", "flip", "slide"]) {
    element(id).addEventListener("input", () => {
      const { axis, place } = plane();
      element("place").textContent = axis === null ? "" : digits(1e3 * (place + drawing.centre[axis]), 4) + " mm";
      changed();
    });
  }
  element("find").addEventListener("input", list);
  element("all").addEventListener("click", () => hide(false));
  element("none").addEventListener("click", () => hide(true));
  for (const button of document.querySelectorAll("[data-look]")) {
    const along = ["x", "y", "z"].indexOf(button.dataset.look);
    button.addEventListener("click", () => (along < 0 ? camera.reset() : camera.look(along)));
  }
  steer(canvas, camera, (x, y) => tell(pick(drawing, camera.sight(x, y), plane().cut)));
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", changed);
  const resized = () => {
    camera.aspect = canvas.clientWidth / Math.max(canvas.clientHeight, 1);
    redraw();
  };
  new ResizeObserver(resized).observe(canvas);
  resized();
  camera.reset();
  list();
  element("axis").dispatchEvent(new Event("input"));
  // The rays of one path [detector, sequence] light up; null: all are alike again.
  return {
    choose: (path, from) => {
      state.chosen = path ? path.join("\n") : null;
      const said = element("picked");
      said.replaceChildren();
      if (path) {
        const count = drawing.ways.filter(isChosen).length;
        const back = made("button", { type: "button" }, "back to the table");
        back.addEventListener("click", () => from.scrollIntoView({ block: "center" }));
        const rays = count ? `${count} of its rays` : "no ray of it was kept to be drawn";
        said.append(made("b", {}, path[1].replaceAll(" > ", " › ")), made("br"), `on ${path[0]}: ${rays} `, back);
        element("stage").scrollIntoView({ block: "nearest" });
      }
      changed();
    },
  };
}

const stage = startStage();
