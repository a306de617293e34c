// Text editor for the design. Each change is tested immediately, and errors are shown next to the line.
import { h } from "./dom.js";

const TYPING_MS = 250;

export class Editor {
  constructor(session) {
    this.session = session;
    this.lines = h("ol", { class: "numbers", "aria-hidden": "true" });
    this.area = h("textarea", { class: "text", spellcheck: "false", autocapitalize: "off", wrap: "off", "aria-label": "The design as TOML", "aria-describedby": "live-text-error" });
    this.error = h("p", { class: "error", id: "live-text-error", role: "alert" });
    this.node = h("div", { class: "editor" }, this.error, h("div", { class: "paper" }, this.lines, this.area));
    this.area.addEventListener("input", () => {
      this.number();
      clearTimeout(this.timer);
      this.timer = setTimeout(() => this.try(), TYPING_MS);
    });
    this.area.addEventListener("scroll", () => (this.lines.scrollTop = this.area.scrollTop));
  }

  start() {
    this.session.on("design", ({ design, isNew, isOpened }) => (isNew || isOpened) && this.show(design));
    this.session.on("refused", ({ error, text }) => text != null && this.blame(error, text));
  }

  try() {
    const source = this.session.base ? this.session.base.source : "design.toml";
    this.session.open(this.area.value, source);
  }

  show(design) {
    const isTyping = document.activeElement === this.area && this.area.value !== design.toml;
    if (isTyping && this.session.wanted) return;
    this.mark(null);
    if (this.area.value === design.toml || isTyping) return;
    this.area.value = design.toml;
    this.number();
  }

  blame(error, text) {
    if (this.area.value !== text) {
      this.area.value = text;
      this.number();
    }
    this.mark(error);
  }

  number() {
    const count = this.area.value.split("\n").length;
    if (this.lines.childElementCount === count) return;
    this.lines.replaceChildren(...Array.from({ length: count }, (_, k) => h("li", {}, k + 1)));
  }

  mark(error) {
    for (const line of this.lines.querySelectorAll(".wrong")) line.classList.remove("wrong");
    this.error.textContent = error ? error.text : "";
    this.area.setAttribute("aria-invalid", String(Boolean(error)));
    if (error && error.line && this.lines.children[error.line - 1]) this.lines.children[error.line - 1].classList.add("wrong");
  }
}
