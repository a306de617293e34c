// Header of the page: title, import and export.
import { h } from "./dom.js";
import { bytesOf, copy, save } from "./files.js";
import { button } from "./frame.js";

function fileName(design, ending) {
  const stem = (design.source || "design.toml").replace(/^.*[\\/]/, "").replace(/\.toml$/, "");
  return `${stem || "design"}${ending}`;
}

export class Head {
  constructor(session, { isEmbedded, version }) {
    this.session = session;
    this.isEmbedded = isEmbedded;
    this.title = h("span", { class: "title" });
    this.done = h("span", { class: "done", role: "status" });
    this.templates = h("select", { class: "new", "aria-label": "Start from a template", onchange: () => this.template() }, h("option", { value: "" }, "New"));
    this.file = h("input", { type: "file", accept: ".toml,text/plain", hidden: true, onchange: () => this.read(this.file.files[0]) });
    const tools = [
      this.templates,
      button("Open", () => this.file.click(), { title: "Open a design from a file" }),
      button("Save", () => this.save(), { title: "Download the design as TOML" }),
      button("Copy", () => this.copyText(), { title: "Copy the design as TOML" }),
      button("Link", () => this.copyLink(), { id: "live-link", title: "Copy a link that contains the design and all settings of this page" }),
      button("STL", () => this.stl(), { title: "Download one element on its plate as STL" }),
      button("Pin", () => this.pin(), { title: "Keep this design for comparison (up to four)" }),
      h("button", { type: "button", id: "theme", hidden: true }),
    ];
    const name = isEmbedded ? null : h("h1", {}, "retrace ", h("small", { title: version }, "live"));
    this.node = h("header", { class: "live-head" }, name, this.title, h("div", { class: "tools", role: "toolbar", "aria-label": "Design" }, ...tools.filter((tool) => !isEmbedded || !["theme", "live-link"].includes(tool.id))), this.done, this.file);
  }

  start(kinds, link) {
    this.link = link;
    const extents = [
      ["infinite", "endless"],
      ["finite", "10 × 10 mm"],
    ];
    for (const { kind, title } of kinds)
      this.templates.append(h("optgroup", { label: title }, ...extents.map(([extent, text]) => h("option", { value: `${kind} ${extent}` }, `${title}, ${text}`))));
    this.session.on("design", ({ design }) => {
      this.title.textContent = design.title || design.source || "";
      if (!this.isEmbedded) document.title = design.title ? `${design.title} – retrace` : "retrace";
    });
    document.addEventListener("dragover", (event) => event.preventDefault());
    document.addEventListener("drop", (event) => {
      event.preventDefault();
      if (event.dataTransfer.files.length > 0) this.read(event.dataTransfer.files[0]);
    });
  }

  say(text) {
    this.done.textContent = text;
    clearTimeout(this.timer);
    this.timer = setTimeout(() => (this.done.textContent = ""), 4000);
  }

  async template() {
    const [kind, extent] = this.templates.value.split(" ");
    this.templates.value = "";
    if (!kind) return;
    const { answers } = await this.session.engine.ask({ asks: [{ ask: "template", kind, extent }] });
    if (answers[0].ok) this.session.open(answers[0].toml, `${kind}.toml`);
  }

  async read(file) {
    if (!file) return;
    this.session.open(await file.text(), file.name);
    this.file.value = "";
  }

  save() {
    const { base } = this.session;
    if (base) save(fileName(base, ".toml"), "application/toml", base.toml);
  }

  async copyText() {
    if (this.session.base) this.say((await copy(this.session.base.toml)) ? "The design is on the clipboard." : "The browser does not allow copying.");
  }

  async copyLink() {
    this.say((await copy(await this.link())) ? "The link is on the clipboard." : "The browser does not allow copying: copy the address of the page.");
  }

  async stl() {
    const { base } = this.session;
    if (!base) return;
    const { answers, error } = await this.session.engine.ask({ toml: base.toml, source: base.source, asks: [{ ask: "stl" }] });
    const answer = error || answers[0];
    if (answer.ok) save(fileName(base, ".stl"), "model/stl", bytesOf(answer.base64));
    else this.say(answer.text);
  }

  pin() {
    const { base, rest } = this.session;
    if (base) this.say(rest.pin(base) ? "Pinned: its curve stays visible for comparison." : "Four designs are pinned already: remove one first.");
  }
}
