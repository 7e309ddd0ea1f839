// Path tables that can be sorted and filtered; a row that is chosen lights up its rays in the 3-D view and shows its light.

function startTable(table) {
  const tools = table.previousElementSibling;
  const filter = tools.querySelector("[data-filter]");
  const more = tools.querySelector("[data-more]");
  const found = tools.querySelector("[data-found]");
  const rows = [...table.tBodies].filter((body) => body.dataset.path !== undefined);
  const last = table.querySelector("tbody.last");
  let sorted = { key: "", rising: false };

  function sort(key) {
    sorted = { key, rising: sorted.key === key ? !sorted.rising : key === "class" };
    const sign = sorted.rising ? 1 : -1;
    const value = (row) => (key === "class" ? row.dataset.class : Number(row.dataset[key]));
    const before = (a, b) => (value(a) < value(b) ? -sign : value(a) > value(b) ? sign : 0);
    rows.sort(before).forEach((row) => table.insertBefore(row, last));
    for (const button of table.querySelectorAll("[data-sort]")) {
      const on = button.dataset.sort === key;
      button.closest("th").setAttribute("aria-sort", on ? (sorted.rising ? "ascending" : "descending") : "none");
    }
    table.classList.add("all");
    more?.remove();
  }

  function sift() {
    const words = filter.value.toLowerCase().split(/\s+/).filter(Boolean);
    const said = (row) => `${row.dataset.path} ${row.dataset.class}`.toLowerCase().replaceAll(" > ", " ");
    let kept = 0;
    for (const row of rows) {
      const fits = words.every((word) => said(row).includes(word));
      row.hidden = !fits;
      kept += fits;
    }
    table.classList.toggle("sifted", words.length > 0);
    found.textContent = words.length ? `${kept} of ${rows.length} paths` : "";
  }

  for (const button of table.querySelectorAll("[data-sort]")) button.addEventListener("click", () => sort(button.dataset.sort));
  filter.addEventListener("input", sift);
  more?.addEventListener("click", () => (table.classList.add("all"), more.remove()));
  for (const row of rows) {
    row.addEventListener("click", () => choose(row));
    row.addEventListener("keydown", (event) => {
      const to = { ArrowDown: "nextElementSibling", ArrowUp: "previousElementSibling" }[event.key];
      if (event.key === "Enter" || event.key === " ") choose(row);
      else if (to && row[to]?.dataset.path !== undefined) row[to].focus();
      else return;
      event.preventDefault();
    });
  }
}

// The chosen row of all tables, or none.
let chosen = null;
function choose(row) {
  chosen?.removeAttribute("aria-selected");
  chosen = chosen === row ? null : row;
  chosen?.setAttribute("aria-selected", "true");
  const path = chosen ? [chosen.dataset.detector, chosen.dataset.path] : null;
  stage?.choose(path, row);
  showLight(path);
}

// The light of one path on its detector, on a coarse grid, logarithmic over four decades.
function showLight(path) {
  const figure = element("pathmap");
  const all = block("paths") ?? [];
  const found = path && all.find((entry) => entry.path.join("\n") === path.join("\n"));
  if (!figure) return;
  figure.hidden = !found;
  if (!found) return;
  const cells = singles(found.cells);
  const side = Math.round(Math.sqrt(cells.length));
  const top = Math.max(...cells);
  const canvas = figure.querySelector("canvas");
  const context = canvas.getContext("2d");
  const size = canvas.width / side;
  cells.forEach((cell, index) => {
    const part = cell > 0 ? Math.max(0, 1 + Math.log10(cell / top) / 4) : -1;
    context.fillStyle = part < 0 ? "#c6cbd1" : `hsl(${260 - 210 * part} 70% ${12 + 68 * part}%)`;
    context.fillRect((index % side) * size, canvas.height - (Math.floor(index / side) + 1) * size, size, size);
  });
  figure.querySelector("h3").textContent = `Its light on ${path[0]}`;
  figure.querySelector("figcaption").textContent = `${side} × ${side} cells, up to ${digits(top, 3)} W/m², logarithmic over four decades; grey: none`;
}

for (const table of document.querySelectorAll("[data-sortable]")) startTable(table);
