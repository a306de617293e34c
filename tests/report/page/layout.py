"""Measures pages in a browser: finds blocks that overlap or are cut off, and style rules that match too many
elements."""

# JavaScript that finds overlapping items: texts, pictures, controls, and boxes with a background or a border. Other
# elements cover nothing.
OVERLAPS = """
const MIN_PX = 1.5;  // rounding of positions, and ascenders of one line in the line above it
const GRAPHICS = "img, canvas, svg, iframe, input, select, textarea, button";
const [root] = document.getElementsByTagName("body");

const styles = new Map();
const styleOf = (element) => {
  if (!styles.has(element)) styles.set(element, getComputedStyle(element));
  return styles.get(element);
};

const lineage = (element) => {
  const chain = [];
  for (let at = element; at && at !== root; at = at.parentElement) chain.push(at);
  return chain;
};

// Layers cover the content of their own container on purpose, for example a sticky heading or a legend on a picture.
const layersOf = (chain) => chain.filter((at) => /absolute|fixed|sticky/.test(styleOf(at).position));
const containerOf = (layer) => {
  const { position } = styleOf(layer);
  if (position === "fixed") return root;
  return (position === "sticky" ? layer.parentElement : layer.offsetParent) || root;
};

// Returns the part of a rectangle that no surrounding box with hidden overflow cuts off.
const visible = (rectangle, chain) => {
  let { left, top, right, bottom } = rectangle;
  for (const at of chain) {
    const { overflowX, overflowY } = styleOf(at);
    if (overflowX === "visible" && overflowY === "visible") continue;
    const box = at.getBoundingClientRect();
    if (overflowX !== "visible") [left, right] = [Math.max(left, box.left), Math.min(right, box.right)];
    if (overflowY !== "visible") [top, bottom] = [Math.max(top, box.top), Math.min(bottom, box.bottom)];
  }
  return { left, top, right, bottom };
};

const items = [];
const add = (owner, isText, rectangle, chain, layers) => {
  const seen = visible(rectangle, isText ? chain : chain.slice(1));
  if (seen.right - seen.left < MIN_PX || seen.bottom - seen.top < MIN_PX) return;
  items.push({ owner, isText, chain, layers, ...seen });
};

// An element with display: contents has no box of its own, but its children have.
const isHidden = (element) =>
  /^(SCRIPT|STYLE|NOSCRIPT|TEMPLATE)$/.test(element.tagName) || styleOf(element).opacity === "0" ||
  (styleOf(element).display !== "contents" && !element.checkVisibility({ visibilityProperty: true }));
const walk = (element) => {
  if (isHidden(element)) return;
  const chain = lineage(element);
  const layers = layersOf(chain);
  const style = styleOf(element);
  const isGraphics = element.matches(GRAPHICS);
  const isBox = style.display !== "inline" && style.display !== "contents" &&
    (style.backgroundColor !== "rgba(0, 0, 0, 0)" || parseFloat(style.borderTopWidth) + parseFloat(style.borderLeftWidth) > 0);
  if (element !== root && (isGraphics || isBox)) add(element, false, element.getBoundingClientRect(), chain, layers);
  if (isGraphics) return;
  for (const child of element.childNodes) {
    if (child.nodeType === Node.ELEMENT_NODE) walk(child);
    if (child.nodeType !== Node.TEXT_NODE || child.data.trim() === "") continue;
    const range = document.createRange();
    range.selectNodeContents(child);
    for (const rectangle of range.getClientRects()) add(element, true, rectangle, chain, layers);
  }
};
walk(root);

const blockOf = ({ owner, isText }) => {
  let at = owner;
  if (!isText && !/^inline/.test(styleOf(at).display)) return at;
  while (at !== root && /^inline$|contents|ruby/.test(styleOf(at).display)) at = at.parentElement;
  return at;
};
for (const item of items) item.block = blockOf(item);

const isLayerOver = (a, b) => a.layers.some((layer) => !b.chain.includes(layer) && containerOf(layer).contains(b.owner));
const mayOverlap = (a, b) =>
  a.owner === b.owner ||
  (a.isText && b.isText && a.block === b.block) ||
  (!a.isText && a.owner.contains(b.owner)) ||
  (!b.isText && b.owner.contains(a.owner)) ||
  isLayerOver(a, b) ||
  isLayerOver(b, a);

const nameOf = ({ owner, isText, left, top, right, bottom }) => {
  const classes = owner.getAttribute("class");
  const text = isText ? ` "${owner.textContent.trim().replace(/\\s+/g, " ").slice(0, 40)}"` : "";
  const place = [left, top + scrollY, right, bottom + scrollY].map((v) => Math.round(v)).join(" ");
  return `${owner.tagName.toLowerCase()}${classes ? "." + classes.trim().split(/\\s+/).join(".") : ""}${text} [${place}]`;
};

items.sort((a, b) => a.top - b.top);
const faults = [];
const open = new Set();
for (const item of items) {
  for (const other of open) {
    if (other.bottom < item.top + MIN_PX) {
      open.delete(other);
      continue;
    }
    const across = Math.min(item.right, other.right) - Math.max(item.left, other.left);
    const down = Math.min(item.bottom, other.bottom) - item.top;
    if (across > MIN_PX && down > MIN_PX && !mayOverlap(item, other)) faults.push(`${nameOf(other)} and ${nameOf(item)}`);
    if (faults.length >= 20) return { items: items.length, faults };
  }
  open.add(item);
}
return { items: items.length, faults };
"""

WIDTHS = (1400, 800, 390)

# JavaScript that finds content that a box cuts off: at the right side, and rows with failures that are visible only after
# scrolling in a box. Texts that end with an ellipsis, code and fields for texts may be cut.
CUTS = """
const MAY_BE_CUT = "pre, input, textarea, select, .spoken, .editor *, .u-wrap, .u-wrap *";
const faults = [];
const nameOf = (element) => `${element.tagName.toLowerCase()}.${element.getAttribute("class") || ""} "${element.textContent.trim().slice(0, 40)}"`;
for (const element of document.body.querySelectorAll("*")) {
  if (!element.checkVisibility({ visibilityProperty: true }) || element.matches(MAY_BE_CUT)) continue;
  const style = getComputedStyle(element);
  if (style.overflowX === "visible" || style.textOverflow === "ellipsis") continue;
  if (element.scrollWidth > element.clientWidth + 1) faults.push(`${nameOf(element)}: ${element.clientWidth} of ${element.scrollWidth} px`);
}
for (const row of document.querySelectorAll("tr.bad")) {
  const box = row.closest(".table-box");
  if (!box || !row.checkVisibility()) continue;
  if (row.getBoundingClientRect().bottom > box.getBoundingClientRect().bottom + 1) faults.push(`${nameOf(row)} is below the edge of its box`);
}
return faults.slice(0, 20);
"""


def cuts(driver):
    """Returns a line for each element of the loaded page whose content is cut off."""
    return driver.execute_script(CUTS)


def overlaps(driver):
    """Returns the number of measured items of the loaded page, and a line for each pair of blocks that overlap."""
    found = driver.execute_script(OVERLAPS)
    return found["items"], found["faults"]


# JavaScript that lists style rules of the page that are missing in a given style sheet. A rule is listed if it matches
# an element outside of the live section.
LEAKS = """
const live = document.getElementById("live");
const visit = (rules, see, media = "") => {
  for (const rule of rules)
    if (rule.selectorText) see(rule, media);
    else if (rule.cssRules) visit(rule.cssRules, see, media + rule.conditionText);
};
const sheet = new CSSStyleSheet();
sheet.replaceSync(arguments[0]);
const shared = new Set();
visit(sheet.cssRules, (rule, media) => shared.add(media + rule.cssText));
const faults = [];
for (const { cssRules } of document.styleSheets)
  visit(cssRules, (rule, media) => {
    if (shared.has(media + rule.cssText)) return;
    const selector = rule.selectorText.replace(/::[\\w-]+/g, "");
    const found = [...document.querySelectorAll(selector)].find((element) => !live.contains(element));
    if (found) faults.push(`${rule.selectorText} matches ${found.tagName.toLowerCase()}.${found.className}`);
  });
return faults;
"""


def leaks(driver, shared_style):
    """Returns a line for each rule that is not in `shared_style` and matches an element outside the live section."""
    return driver.execute_script(LEAKS, shared_style)
