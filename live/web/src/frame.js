// Layout of the page: header, design, results, panels.
import { h, newId } from "./dom.js";

/** Creates a panel with a title, tools next to the title and a caption below. */
export function panel(name, title, { tools = [], caption = null } = {}, ...content) {
  const id = newId(name);
  return h(
    "section",
    { class: `panel ${name}`, "aria-labelledby": id, "data-panel": name },
    h("div", { class: "panel-head" }, h("h2", { id }, title), h("div", { class: "panel-tools" }, ...tools)),
    ...content,
    caption,
  );
}

export function button(text, run, attributes = {}) {
  return h("button", { type: "button", onclick: run, ...attributes }, text);
}

/** Creates tabs to choose the picture on screens that have room for only one. */
function stageTabs(results, names, number) {
  const tabs = names.map(([name, text]) =>
    h("button", { type: "button", "data-show": name, "aria-pressed": "false", onclick: () => choose(name) }, text),
  );
  const choose = (name) => {
    results.dataset.stage = name;
    tabs.forEach((tab) => tab.setAttribute("aria-pressed", String(tab.dataset.show === name)));
  };
  choose(names[0][0]);
  return h("div", { class: "stage-tabs", role: "group", "aria-label": "Displayed picture" }, ...tabs, number);
}

export function layOut(root, { header, design, notice, readout, stage, more, number, isEmbedded }) {
  const results = h("div", { class: "results", id: "live-results", tabindex: "-1" });
  const tabs = stageTabs(results, [
    ["scene", "3D"],
    ["plan", "Plan"],
    ["curve", "Curve"],
    ["map", "Map"],
  ], number);
  results.append(notice, readout, h("div", { class: "stage" }, tabs, ...stage), h("div", { class: "more" }, ...more));
  root.classList.add("live");
  root.replaceChildren(
    h("a", { class: "skip", href: "#live-results", onclick: (event) => (event.preventDefault(), results.focus()) }, "Skip to the results"),
    header,
    h("div", { class: "desk" }, design, results),
  );
  if (!isEmbedded) document.body.classList.add("live-page");
}
