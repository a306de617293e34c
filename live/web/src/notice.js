// Messages about the design: errors, limitations of the page with alternatives, and warnings.
import { h } from "./dom.js";
import { copy } from "./files.js";
import { button } from "./frame.js";

/** Creates a command line that the user can copy, for computations that the page does not support. */
function commandLine(command, source) {
  const text = command.replaceAll("DESIGN", source || "design.toml");
  return h("span", { class: "command" }, h("code", {}, text), button("Copy", (event) => copy(text).then((done) => (event.target.textContent = done ? "Copied" : "Copy"))));
}

export class Notice {
  constructor(session) {
    this.session = session;
    this.refusal = h("div", { class: "refusal", role: "alert" });
    this.remarks = h("div", { class: "remarks", role: "status" });
    this.trouble = h("div", { class: "remarks", role: "status" });
    this.node = h("div", { class: "notice" }, this.refusal, this.trouble, this.remarks);
    this.shown = "";
  }

  start() {
    this.session.on("refused", ({ error }) => this.refuse(error));
    this.session.on("accepted", () => this.refusal.replaceChildren());
    this.session.on("design", ({ design }) => this.tell(design));
    this.session.on("answer", () => this.blame());
  }

  /** Explains why the new design cannot be shown. The last valid design stays visible. */
  refuse(error) {
    const shown = this.session.base ? " The last valid design is still shown." : "";
    this.refusal.replaceChildren(h("p", {}, h("strong", {}, "Invalid design: "), error.text, h("span", { class: "quiet" }, shown)));
    if (error.command) this.refusal.append(commandLine(error.command, this.session.base && this.session.base.source));
  }

  tell(design) {
    const shown = JSON.stringify([design.traces, design.why_not, design.command, design.notes, design.warnings, design.source]);
    if (shown === this.shown) return;
    this.shown = shown;
    const lines = [...(design.notes || []), ...(design.warnings || [])].map((text) => h("p", {}, text));
    if (!design.traces) {
      lines.unshift(h("p", { class: "cannot" }, h("strong", {}, "This page cannot trace this design: "), design.why_not));
      if (design.command) lines.splice(1, 0, commandLine(design.command, design.source));
    }
    this.remarks.replaceChildren(...lines);
  }

  /** Shows a command for a direction that the page could not trace, although the design is valid. */
  blame() {
    const { why, base } = this.session;
    this.trouble.replaceChildren();
    if (!why || !why.command || (base && !base.traces)) return;
    this.trouble.append(h("p", {}, why.text));
    this.trouble.append(commandLine(why.command, base && base.source));
  }
}
