// Changes values in the text of a design in place, so that comments and order are kept. Only lines "key = value" below
// a "[table]" are supported. For other forms, the engine writes a new text. It also does so for texts with former names
// of tables or keys, because a line with the current name next to them would be an error.

function headerOf(line) {
  const found = /^\s*\[([A-Za-z0-9_.-]+)\]\s*(#.*)?\r?$/.exec(line);
  return found ? found[1] : null;
}

/**
 * Returns the lines of a table, from the line after its header to the next header. The root table begins at line 0.
 * Returns null if the table does not exist.
 */
function reachOf(lines, table) {
  const begin = table === "" ? 0 : lines.findIndex((line) => headerOf(line) === table) + 1;
  if (begin === 0 && table !== "") return null;
  const length = lines.slice(begin).findIndex((line) => /^\s*\[/.test(line));
  return [begin, length < 0 ? lines.length : begin + length];
}

function textOf(value) {
  if (Array.isArray(value)) return `[${value.map(textOf).join(", ")}]`;
  return JSON.stringify(value);
}

const SCALAR = `("(?:[^"\\\\]|\\\\.)*"|'[^']*'|\\[[^\\]\\n]*\\]|[^\\s#"'\\[{]+)`;

/**
 * Returns the line with a key, or nothing if there are several.
 * \param mark text before the key
 */
function find(lines, [from, to], key, mark) {
  const shape = new RegExp(`^(\\s*)(${mark})(${key})(\\s*=\\s*)${SCALAR}([ \\t]*)(#.*)?(\\r?)$`);
  const places = [];
  for (let k = from; k < to; ++k) if (shape.test(lines[k])) places.push(k);
  return places.length === 1 ? { place: places[0], parts: shape.exec(lines[places[0]]) } : null;
}

function mentions(lines, [from, to], key) {
  return lines.slice(from, to).some((line) => new RegExp(`^\\s*["']?${key}["']?\\s*[=.]`).test(line));
}

/** Returns the line with a new value. A comment keeps its column if there is room. */
function rewritten([, indent, mark, key, equals, old, gap, comment, end], value) {
  const text = textOf(value);
  if (!comment) return `${indent}${key}${equals}${text}${gap}${end}`;
  const room = gap.includes("\t") ? gap : " ".repeat(Math.max(1, mark.length + gap.length + old.length - text.length));
  return `${indent}${key}${equals}${text}${room}${comment}${end}`;
}

/** Returns the position after the last line of the table that is neither empty nor a comment. */
function insertAt(lines, [from, to]) {
  for (let k = to; k > from; --k) if (/^\s*[^\s#]/.test(lines[k - 1])) return k;
  return from;
}

/**
 * Returns the lines with an added header for the table. A commented-out header is used if there is one. Returns null if
 * the table is written in another form.
 */
function withTable(lines, table) {
  const name = table.split(".")[0];
  if (table === "" || lines.some((line) => new RegExp(`^\\s*\\[*\\s*["']?${name}["']?\\s*[\\].=]`).test(line))) return null;
  const hint = lines.findIndex((line) => /^\s*#/.test(line) && headerOf(line.replace(/#\s*/, "")) === table);
  if (hint >= 0) return lines.map((line, k) => (k === hint ? line.replace(/#\s*/, "") : line));
  const end = lines.length - [...lines].reverse().findIndex((line) => line.trim() !== "");
  return [...lines.slice(0, end), "", `[${table}]`, ...lines.slice(end)];
}

function changed(lines, path, value) {
  const dot = path.lastIndexOf(".");
  const table = dot < 0 ? "" : path.slice(0, dot);
  const key = path.slice(dot + 1);
  const reach = reachOf(lines, table);
  if (!reach) {
    if (value === null) return lines;
    const more = withTable(lines, table);
    return more && changed(more, path, value);
  }
  const given = find(lines, reach, key, "");
  if (given && value === null) return lines.filter((_, k) => k !== given.place);
  if (given) return lines.map((line, k) => (k === given.place ? rewritten(given.parts, value) : line));
  if (mentions(lines, reach, key)) return null;
  if (value === null) return lines;
  const hint = find(lines, reach, key, "#\\s*");
  if (hint) return lines.map((line, k) => (k === hint.place ? rewritten(hint.parts, value) : line));
  const place = insertAt(lines, reach);
  return [...lines.slice(0, place), `${key} = ${textOf(value)}`, ...lines.slice(place)];
}

// Former names of the design format (`former` in design/io and geometry/io) that a text may contain.
const FORMER_TABLES = "base|front";
const FORMER_KEYS = "elements|turned|share|dust_forward_share|height_map_level_axis|map_level_axis|level|down";
const FORMER = new RegExp(
  `^\\s*(\\[\\s*["']?(${FORMER_TABLES})["']?\\s*[\\].]|["']?(${FORMER_TABLES})["']?\\s*[.=]|` +
    `(["']?\\w+["']?\\s*\\.\\s*)?["']?(${FORMER_KEYS})["']?\\s*=)`,
  "m",
);

/** Returns the text with the new values, or null if this is not possible line by line. */
export function edited(toml, changes) {
  if (FORMER.test(toml)) return null;
  let lines = toml.split("\n");
  for (const [path, value] of Object.entries(changes)) {
    if (value !== null && typeof value === "object" && !Array.isArray(value)) return null;
    if (Array.isArray(value) && value.some((entry) => typeof entry === "object")) return null;
    if (/[^A-Za-z0-9_.-]/.test(path)) return null;
    lines = changed(lines, path, value);
    if (!lines) return null;
  }
  return lines.join("\n");
}
