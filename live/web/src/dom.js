// Creates HTML and SVG elements.
const SVG = "http://www.w3.org/2000/svg";

function fill(node, attributes, children) {
  for (const [name, value] of Object.entries(attributes || {})) {
    if (value == null || value === false) continue;
    if (name.startsWith("on")) node.addEventListener(name.slice(2), value);
    else node.setAttribute(name, value === true ? "" : value);
  }
  node.append(...children.flat().filter((child) => child != null && child !== false));
  return node;
}

/**
 * Creates an HTML element, such as h("button", { type: "button", onclick: run }, "Run"). Attributes that are null or
 * false are omitted.
 */
export function h(name, attributes, ...children) {
  return fill(document.createElement(name), attributes, children);
}

/** Creates an SVG element in the same manner as h(). */
export function s(name, attributes, ...children) {
  return fill(document.createElementNS(SVG, name), attributes, children);
}

let count = 0;
/** Returns a unique id for an element that labels refer to. */
export function newId(what) {
  count += 1;
  return `live-${what}-${count}`;
}

/** Canvas that fills its parent element, in the resolution of the screen. `draw` is called when the size changes. */
export class Canvas {
  constructor(element, draw) {
    this.element = element;
    this.node = h("canvas", { "aria-hidden": "true" });
    // For few lines and many frames, drawing on the CPU is faster than on the graphics card.
    this.context = this.node.getContext("2d", { willReadFrequently: true });
    element.append(this.node);
    new ResizeObserver(() => {
      if (this.fit()) draw();
    }).observe(element);
    this.fit();
  }

  fit() {
    const ratio = Math.min(2, window.devicePixelRatio || 1);
    const width = Math.floor(this.element.clientWidth);
    const height = Math.floor(this.element.clientHeight);
    if (width === this.width && height === this.height && ratio === this.ratio) return false;
    Object.assign(this, { width, height, ratio });
    this.node.width = Math.max(1, Math.round(width * ratio));
    this.node.height = Math.max(1, Math.round(height * ratio));
    return true;
  }

  /** Clears the canvas and sets its units to CSS pixels. */
  begin() {
    this.context.setTransform(this.ratio, 0, 0, this.ratio, 0, 0);
    this.context.clearRect(0, 0, this.width, this.height);
    return this.context;
  }

  /** Returns the position of a pointer relative to the top left corner. */
  placeOf(event) {
    const box = this.node.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  }
}
