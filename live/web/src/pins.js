// Texts for pinned designs: the keys whose values differ from the displayed design.
import { named, short } from "./units.js";

const MAX_KEYS = 2; // maximum number of keys that are named

/** Returns the value of a line of TOML without the comment at its end. */
function valueOf(text) {
  const string = text.match(/^("(?:[^"\\]|\\.)*"|'[^']*')/);
  return string ? string[0] : text.replace(/\s*#.*$/, "").trim();
}

/** Returns the values in a text of a design, by their paths. Keys of the second table of a list are "zone.1.gap_mm". */
function valuesOf(toml) {
  const values = new Map();
  const counts = new Map();
  let table = "";
  for (const line of toml.split(/\r?\n/)) {
    const head = line.match(/^\s*(\[{1,2})\s*([^\]]+?)\s*\]/);
    if (head) {
      const count = counts.get(head[2]) || 0;
      counts.set(head[2], count + 1);
      table = head[1] === "[[" ? `${head[2]}.${count}.` : `${head[2]}.`;
      continue;
    }
    const entry = line.match(/^\s*([\w."-]+)\s*=\s*(.*)$/);
    if (entry) values.set(`${table}${entry[1].replaceAll('"', "")}`, valueOf(entry[2]));
  }
  return values;
}

function areEqual(a, b) {
  return a === b || (a != null && b != null && Number.isFinite(Number(a)) && Number(a) === Number(b));
}

/** Returns the keys of a design that differ from those of another design, with their values, except the title. */
function differences(toml, other) {
  const [here, there] = [valuesOf(toml), valuesOf(other)];
  return [...new Set([...here.keys(), ...there.keys()])]
    .filter((path) => path !== "title" && path !== "schema" && !areEqual(here.get(path), there.get(path)))
    .map((path) => ({ path, value: here.get(path) }));
}

/** Returns a text about the differences of a design, such as "aperture 1.2 mm, thickness 3 mm". */
export function differenceText(toml, other) {
  const all = differences(toml, other);
  if (all.length === 0) return "same as this design";
  const texts = all.slice(0, MAX_KEYS).map(({ path, value }) => {
    const { label, unit } = named(path.split(".").pop());
    if (value == null) return `${label} by default`;
    const shown = Number.isFinite(Number(value)) ? short(Number(value)) : value.replaceAll('"', "");
    return `${label} ${shown}${unit === "°" ? "" : unit && " "}${unit}`;
  });
  return texts.join(", ") + (all.length > MAX_KEYS ? `, and ${all.length - MAX_KEYS} more` : "");
}
