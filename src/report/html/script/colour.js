// One colour for each finish, coating, medium, side, class of light or source; the same wherever it appears.

// After M. Okabe, K. Ito (2008) and P. Tol (2021): apart for every kind of eye; more kinds than colours repeat lighter.
const HUES = ["#4477aa", "#cc7a29", "#3f8f6b", "#b5495b", "#8a6bb0", "#3b9db3", "#a89a2d", "#9b6a4d", "#6c8ebf", "#c77fa8", "#79a861", "#7d7f86"];
const SIDES = ["#4477aa", "#cc7a29"];
// Classes of light, as the tables of a report have them.
const CLASSES = {
  signal: ["#1f5c7a"], incoming: ["#d2a000"], direct: ["#a3243b"], ghost: ["#d9822b", "#e8a95c", "#f1cc98"], scatter: ["#6a4c93", "#9479b8", "#bfaed6"],
};

function classColour(name) {
  const [kind, order] = name.split(" ");
  const shades = CLASSES[kind] ?? ["#8b939c"];
  return shades[Math.min(Math.max(parseInt(order) || 1, 1), shades.length) - 1];
}

// What the front (0) and the back (1) of a part are called by a way of colouring.
const NAMES = {
  finish: (part, side) => part.scatters[side] || part.speculars[side],
  coating: (part, side) => part.speculars[side],
  medium: (part, side) => (part.media[0] === part.media[1] ? "walls in " + part.media[side] : part.media[side]),
  side: (part, side) => ["front", "back"][side],
};

// Colours by name, in the order in which they are met.
function paletteOf(names, hues = HUES) {
  const known = new Map();
  for (const name of names) if (!known.has(name)) known.set(name, hues[known.size % hues.length]);
  return known;
}

// The palette of a way of colouring, and what it gives a side of a part.
function colouring(parts, by) {
  const name = NAMES[by];
  const both = parts.flatMap((part) => [name(part, 0), name(part, 1)]);
  const palette = paletteOf(both, by === "side" ? SIDES : HUES);
  return { palette, of: (part, side) => palette.get(name(part, side)) };
}

// Glass is seen through: what has other media in front than behind.
const isGlass = (part) => part.media[0] !== part.media[1];
