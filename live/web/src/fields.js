// Controls of the form, one for each type of key. A control shows a value and reports when the user changes it.
import { h, newId } from "./dom.js";
import { clean, sliderOf } from "./sliders.js";
import { short, words } from "./units.js";

/** Creates a number field with a slider. */
function numberField(row, entry, { id, size_mm, change }) {
  const slider = sliderOf(row, entry.value, size_mm);
  const step = row.kind === "whole" ? 1 : "any";
  const number = h("input", { type: "number", id, step, onchange: () => number.value !== "" && change(Number(number.value)) });
  const range =
    slider &&
    h("input", {
      type: "range",
      min: slider.low,
      max: slider.high,
      step: slider.step,
      "aria-label": `${words(row.name)}, slider`,
      "data-path": row.path,
      oninput: () => {
        const value = clean(Number(range.value), slider.step);
        number.value = value;
        change(value);
      },
    });
  const show = (value) => {
    number.value = value ?? "";
    number.placeholder = value == null && row.otherwise ? "default" : "";
    number.title = value == null && row.otherwise ? `Default: ${row.otherwise}` : "";
    if (!range) return;
    range.value = value ?? slider.low;
    range.classList.toggle("unset", value == null);
  };
  return { nodes: [number, range], show, holds: [number, range] };
}

function wordField(row, entry, { id, change }) {
  if (row.words.length > 4) {
    const select = h("select", { id, onchange: () => change(select.value) }, ...row.words.map((word) => h("option", { value: word }, words(word))));
    return { nodes: [select], show: (value) => (select.value = value), holds: [select] };
  }
  const name = newId("word");
  const inputs = row.words.map((word) => h("input", { type: "radio", name, value: word, onchange: () => change(word) }));
  const labels = row.words.map((word, k) => h("label", {}, inputs[k], h("span", {}, words(word))));
  const box = h("div", { class: "segments", role: "radiogroup", "aria-labelledby": id }, ...labels);
  return { nodes: [box], show: (value) => inputs.forEach((input) => (input.checked = input.value === value)), holds: inputs, isGroup: true };
}

function flagField(row, entry, { id, change }) {
  const input = h("input", { type: "checkbox", id, onchange: () => change(input.checked) });
  return { nodes: [input], show: (value) => (input.checked = Boolean(value)), holds: [input] };
}

function textField(row, entry, { id, change, materials }) {
  const list = row.path === "body.material" && materials.length > 0 ? newId("list") : null;
  const input = h("input", { type: "text", id, list, spellcheck: "false", onchange: () => change(input.value === "" ? null : input.value) });
  const options = list && h("datalist", { id: list }, ...materials.map(({ name, description }) => h("option", { value: name }, description || "")));
  return { nodes: [input, options], show: (value) => (input.value = value ?? ""), holds: [input] };
}

/** Maximum number of sliders of one key. */
const MAX_SLIDERS = 3;

/** Creates the sliders of a short list of numbers. A slider calls change() with the list that contains its new value. */
function slidersOf(row, entry, { size_mm, change }) {
  const values = Array.isArray(entry.value) ? entry.value : [];
  const slider = values.length <= MAX_SLIDERS && sliderOf(row, values.find((v) => Math.abs(v) === Math.max(...values.map(Math.abs))), size_mm);
  if (!slider) return [];
  const ranges = values.map((value, k) =>
    h("input", {
      type: "range",
      min: slider.low,
      max: slider.high,
      step: slider.step,
      value,
      "aria-label": `${words(row.name)}, slider ${k + 1}`,
      "data-path": row.path,
      oninput: () => change(ranges.map((range) => clean(Number(range.value), slider.step))),
    }),
  );
  return ranges;
}

/** Creates a field for several numbers, separated by commas, with sliders for a short list. */
function numbersField(row, entry, { id, size_mm, change }) {
  const input = h("input", {
    type: "text",
    id,
    inputmode: "decimal",
    onchange: () => {
      const values = input.value.split(/[\s,;]+/).filter((text) => text !== "").map(Number);
      if (values.length === 0) change(null);
      else if (values.every(Number.isFinite)) change(values);
    },
  });
  const write = (value) => (input.value = value == null ? "" : [].concat(value).map((v) => short(v, 12).replace("−", "-")).join(", "));
  const move = (value) => {
    write(value);
    change(value);
  };
  const ranges = slidersOf(row, entry, { size_mm, change: move });
  const show = (value) => {
    write(value);
    ranges.forEach((range, k) => (range.value = [].concat(value)[k] ?? 0));
  };
  return { nodes: [input, ...ranges], show, holds: [input, ...ranges] };
}

/**
 * Creates a read-only field for values that can be changed only in the text. For a list, the number of entries is
 * shown.
 */
function writtenField(row, entry, { edit }) {
  const text = h("code", {});
  const show = (value) => (text.textContent = entry.list ? entry.entries || "none" : value == null ? "–" : JSON.stringify(value).slice(0, 60));
  return { nodes: [text, h("button", { type: "button", class: "plain", onclick: edit }, "in the text")], show, holds: [] };
}

const FIELDS = {
  number: numberField,
  whole: numberField,
  word: wordField,
  flag: flagField,
  text: textField,
  numbers: numbersField,
};

/**
 * Creates the control for a key.
 * \param row description of the key in the form
 * \param entry entry of the design's keys
 * \param given id, size_mm, materials, change(value), edit()
 */
export function fieldOf(row, entry, given) {
  const isList = Array.isArray(entry.value) && row.kind === "number";
  return (isList ? numbersField : FIELDS[row.kind] || writtenField)(row, entry, given);
}
