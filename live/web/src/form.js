// Form with the keys that apply to a design of this kind, in groups. Keys and texts come from the schema.
import { h, newId } from "./dom.js";
import { fieldOf } from "./fields.js";
import { named, words } from "./units.js";

const OPEN = ["", "element", "array", "body"]; // groups that are open at first
const CHANGES_SHAPE = /(^|\.)(kind|arrangement|extent|model)$/;
const SIZES = ["element.base_mm", "element.aperture_mm", "element.diameter_mm"];

function allowedText(row) {
  const ends = [];
  if (row.low != null) ends.push(`${row.low_included === false ? "above" : "from"} ${row.low}`);
  if (row.high != null) ends.push(`${row.high_included === false ? "below" : "to"} ${row.high}`);
  return ends.join(" ");
}

/** Returns the description of a key, its range and its default. */
function meaningOf(row) {
  const without = row.default != null ? `Default: ${row.default}.` : row.otherwise ? `Default: ${row.otherwise}.` : "";
  const allowed = allowedText(row);
  return [row.meaning, allowed && `Allowed: ${allowed}.`, without].filter(Boolean).join(" ");
}

export class Form {
  /** \param edit function that shows the text of the design */
  constructor(session, edit) {
    this.session = session;
    this.edit = edit;
    this.keys = h("form", { class: "form", onsubmit: (event) => event.preventDefault() });
    this.help = h("p", { class: "help" });
    this.node = h("div", {}, this.keys, this.help);
    for (const event of ["pointerover", "focusin"]) this.keys.addEventListener(event, ({ target }) => this.explain(target));
    this.controls = new Map();
    this.states = new Map(); // for each group, whether it is open
    this.built = "";
  }

  start(groups, materials) {
    this.groups = groups;
    this.materials = materials;
    this.rows = new Map();
    for (const group of groups) for (const row of group.rows) this.rows.set(row.path, [...(this.rows.get(row.path) || []), row]);
    this.session.on("design", ({ design, isOpened }) => this.show(design, isOpened));
    this.session.on("refused", ({ error, changes }) => this.blame(error, changes));
  }

  /** Shows the description of the key under the pointer, or of the focused key, at the bottom of the form. */
  explain(target) {
    const field = target.closest(".field");
    const control = field && this.controls.get(field.dataset.key);
    if (!control || control.node === this.explained) return;
    this.explained = control.node;
    this.help.replaceChildren(h("code", {}, control.row.path), ` ${meaningOf(control.row)}`);
  }

  rowOf({ path, row, list }) {
    if (list) return { path, name: path.split(".").pop(), kind: "table", meaning: "A list of tables." };
    return (this.rows.get(path) || [])[row || 0];
  }

  /** Updates the form. It is rebuilt if other keys apply; otherwise only the values are updated. */
  show(design, isOpened) {
    const built = JSON.stringify(design.keys.map(({ path, row, value, entries }) => [path, row, Array.isArray(value), entries]));
    if (built !== this.built || isOpened) this.build(design);
    this.built = built;
    for (const entry of design.keys) {
      const control = this.controls.get(entry.path);
      if (!control) continue;
      if (!(entry.path in this.session.refused)) {
        control.node.classList.remove("refused");
        control.error.textContent = "";
      }
      control.node.classList.toggle("given", entry.given);
      control.back.hidden = !entry.given || this.rowOf(entry).required;
      const isHeld = control.field.holds.includes(document.activeElement) && this.session.isMoving;
      if (!isHeld && !(entry.path in this.session.changes) && !(entry.path in this.session.refused)) control.field.show(entry.value);
    }
    this.count(design);
  }

  build(design) {
    const size = design.keys.find(({ path }) => SIZES.includes(path));
    this.size_mm = size && size.value ? size.value : 1;
    const focused = document.activeElement && document.activeElement.id;
    this.controls.clear();
    this.groupNodes = [];
    this.keys.replaceChildren(...this.groups.map((group) => this.group(group, design)).filter(Boolean));
    if (focused && document.getElementById(focused)) document.getElementById(focused).focus();
  }

  group(group, design) {
    const paths = new Set(group.rows.map(({ path }) => path));
    const entries = design.keys.filter((entry) => (entry.list ? entry.path === group.path : paths.has(entry.path)) && this.isShown(entry));
    if (entries.length === 0) return null;
    const count = h("span", { class: "count" });
    const isOpen = this.states.get(group.path) ?? OPEN.includes(group.path);
    const node = h(
      "details",
      { open: isOpen, ontoggle: () => this.states.set(group.path, node.open) },
      h("summary", { title: group.meaning }, h("span", {}, words(group.title || group.path || "design")), count),
      ...entries.map((entry) => this.control(entry)),
    );
    this.groupNodes.push({ count, paths });
    return node;
  }

  /** Keys for files are shown only if they are given, because the page has no files. */
  isShown(entry) {
    const row = this.rowOf(entry);
    return Boolean(row) && (row.kind !== "file" || entry.given);
  }

  control(entry) {
    const row = this.rowOf(entry);
    const { label, unit } = named(row.name);
    const id = `key-${row.path.replaceAll(".", "-")}`;
    const change = (value) => this.session.change(row.path, value, row.kind === "word" || row.kind === "flag" || CHANGES_SHAPE.test(row.path));
    const field = fieldOf(row, entry, { id, size_mm: this.size_mm, materials: this.materials, change, edit: this.edit });
    const back = h("button", { type: "button", class: "plain back", title: "Reset to the default", "aria-label": `${label}: reset to the default`, onclick: () => this.session.change(row.path, null, true) }, "↺");
    const error = h("p", { class: "error", id: newId("error"), role: "alert" });
    const name = h(field.isGroup ? "span" : "label", { for: field.isGroup ? null : id, id: field.isGroup ? id : null }, label);
    for (const part of field.holds) if (part) part.setAttribute("aria-description", meaningOf(row));
    const node = h("div", { class: `field ${row.kind}`, "data-key": row.path }, name, h("span", { class: "with-unit" }, field.nodes[0], unit && h("span", { class: "unit" }, unit)), back, ...field.nodes.slice(1).filter(Boolean), error);
    this.controls.set(row.path, { node, row, field, back, error });
    field.show(entry.value);
    return node;
  }

  /** Shows the number of given keys in each group. */
  count(design) {
    const given = new Set(design.keys.filter((entry) => entry.given).map(({ path }) => path));
    for (const { count, paths } of this.groupNodes) {
      const number = [...paths].filter((path) => given.has(path)).length;
      count.textContent = number || "";
    }
  }

  /** Shows the message about an invalid value next to its key, or next to the key that was changed. */
  blame(error, changes) {
    if (!changes) return;
    const control = this.controls.get(error.key) || this.controls.get(Object.keys(changes)[0]);
    if (!control) return;
    control.node.classList.add("refused");
    control.error.textContent = error.message || error.text;
  }
}
