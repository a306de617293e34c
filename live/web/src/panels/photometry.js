// Panel of a photometric standard: for each test point, the coefficient of retroreflection, its limit and the verdict.
import { coloursOf } from "../body_colour.js";
import { h } from "../dom.js";
import { panel } from "../frame.js";
import { short, words } from "../units.js";

// Verdicts and their CSS classes. Rows of the table are sorted in this order, so that failures come first.
const VERDICTS = { fail: "bad", undetermined: "open", unconfirmed: "open", pass: "good" };
const rankOf = ({ verdict }) => Object.keys(VERDICTS).indexOf(verdict);

export class PhotometryPanel {
  constructor(session) {
    this.session = session;
    this.isColourChosen = false; // true if the user chose the colour; otherwise it follows the colour of the body
    const choice = (label) => h("select", { "aria-label": label, onchange: () => this.choose(label) });
    this.standard = choice("Standard");
    this.part_class = choice("Class");
    this.colour = choice("Colour");
    this.area = h("input", { type: "number", min: 0.01, step: "any", value: 100, "aria-label": "Area in square centimetres", onchange: () => this.choose() });
    this.verdict = h("p", { class: "verdict", "aria-live": "polite" });
    this.rows = h("tbody", {});
    this.table = h(
      "div",
      { class: "table-box", tabindex: "0", role: "region", "aria-label": "Test points", hidden: true },
      h("table", {}, h("thead", {}, h("tr", {}, ...["Verdict", "Observation", "V", "H", "R_I (mcd/lx)", "Limit"].map((text, k) => h("th", { scope: "col", class: k > 0 ? "n" : "" }, text)))), this.rows),
    );
    this.remarks = h("p", { class: "caption" });
    const controls = h("div", { class: "programme" }, this.standard, this.part_class, this.colour, h("label", {}, this.area, " cm²"));
    this.node = panel("test", "Test points of a standard", {}, controls, this.verdict, this.table, this.remarks);
  }

  start(standards) {
    this.standards = standards;
    this.standard.append(h("option", { value: "" }, "choose a standard"), ...standards.map(({ name, description }) => h("option", { value: name }, `${name} – ${description}`)));
    this.fillChoices();
    this.session.on("design", () => this.followBody());
    this.session.on("judging", () => (this.verdict.textContent = "computing …"));
    this.session.on("judged", (answer) => this.show(answer));
    this.session.on("moving", (moving) => this.node.classList.toggle("stale", moving && Boolean(this.standard.value)));
  }

  fillChoices() {
    const chosen = this.standards.find(({ name }) => name === this.standard.value);
    for (const [select, list] of [
      [this.part_class, chosen ? chosen.classes : []],
      [this.colour, chosen ? chosen.colours : []],
    ]) {
      const before = select.value;
      select.replaceChildren(...list.map((name) => h("option", { value: name }, name)));
      if (list.includes(before)) select.value = before;
      else if (select === this.colour) this.isColourChosen = false;
      select.hidden = list.length < 2;
    }
    this.pickColour();
  }

  /**
   * Selects the colour of the body if the standard has this colour. Returns true if the selected colour has changed.
   */
  pickColour() {
    const before = this.colour.value;
    const list = [...this.colour.options].map(({ value }) => value);
    const colour = coloursOf(this.session.base).find((name) => list.includes(name));
    if (!this.isColourChosen && colour) this.colour.value = colour;
    return this.colour.value !== before;
  }

  followBody() {
    if (this.pickColour()) this.ask();
  }

  /** Returns the test plan for the request, or null if no standard is selected. */
  programme() {
    if (!this.standard.value) return null;
    const programme = { standard: this.standard.value, area_cm2: Number(this.area.value) };
    if (this.part_class.value) programme.class = this.part_class.value;
    if (this.colour.value) programme.colour = this.colour.value;
    return programme;
  }

  /** Returns the test plan for the address of the page. A colour that follows the body is omitted. */
  state() {
    const programme = this.programme();
    if (programme && !this.isColourChosen) delete programme.colour;
    return programme;
  }

  restore(programme) {
    if (!programme) return;
    this.standard.value = programme.standard;
    this.isColourChosen = false;
    this.fillChoices();
    if (programme.class) this.part_class.value = programme.class;
    if (programme.colour) this.colour.value = programme.colour;
    this.isColourChosen = Boolean(programme.colour);
    this.area.value = programme.area_cm2;
    this.session.rest.choose(this.programme());
  }

  choose(label) {
    if (label === "Colour") this.isColourChosen = true;
    if (label === "Standard") this.fillChoices();
    this.ask();
  }

  ask() {
    this.clear();
    this.session.rest.choose(this.programme());
    this.session.tell("state");
  }

  clear() {
    this.verdict.replaceChildren();
    this.table.hidden = true;
    this.remarks.textContent = "";
  }

  show(answer) {
    this.node.classList.remove("stale");
    if (!answer.ok) {
      this.clear();
      this.verdict.textContent = answer.text;
      return;
    }
    const chip = (verdict) => h("span", { class: `chip ${VERDICTS[verdict] || ""}` }, verdict);
    this.verdict.replaceChildren(chip(answer.verdict), answer.reason ? ` ${answer.reason}` : "");
    this.rows.replaceChildren(
      ...[...answer.points].sort((a, b) => rankOf(a) - rankOf(b)).map((point) =>
        h(
          "tr",
          { class: VERDICTS[point.verdict] === "bad" ? "bad" : null },
          h("td", {}, chip(point.verdict)),
          ...[`${short(60 * point.observation_deg, 3)}′`, `${short(point.v_deg)}°`, `${short(point.h_deg)}°`, short(point.value_mcd_per_lx, 3), short(point.limit_mcd_per_lx, 3)].map((text) => h("td", { class: "n" }, text)),
        ),
      ),
    );
    this.table.hidden = false;
    const notes = [...(answer.left_out || []), ...(answer.warnings || [])];
    this.remarks.textContent = [answer.has_diffraction ? "With diffraction." : "Without diffraction.", ...notes.map(words)].join(" ");
  }
}
