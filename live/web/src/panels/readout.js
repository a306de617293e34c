// Shows RRE with its accuracy during and after changes, and the direction of light.
import { h, newId } from "../dom.js";
import { short } from "../units.js";

/**
 * Returns RRE and its accuracy in percent as text. "76.235 ± 0.008" is two standard errors; "76.231 … 76.240" is a
 * range, if some light was not traced.
 */
function bounds({ rre, truncated, std_error = 0 }) {
  if (std_error > truncated) {
    const decimals = std_error > 1e-5 ? 3 : 5;
    return `${(100 * rre).toFixed(decimals)} ± ${(200 * std_error).toFixed(decimals)} %`;
  }
  const decimals = truncated > 5e-6 ? 3 : 5;
  const low = (100 * (rre - 2 * std_error)).toFixed(decimals);
  const high = (100 * (rre + Math.max(0, truncated) + 2 * std_error)).toFixed(decimals);
  return low === high ? `${low} %` : `${low} … ${high} %`;
}

function milliseconds(answer) {
  return answer.ms < 1000 ? `${answer.ms.toFixed(answer.ms < 10 ? 1 : 0)} ms` : `${(answer.ms / 1000).toFixed(1)} s`;
}

/** Line that shows an accuracy level: its name, the range of RRE and the computing time. */
class Accuracy {
  constructor(name, title) {
    this.value = h("output", {}, "–");
    this.power = h("span", { class: "power" }, name === "moving" ? "10⁻⁴" : "10⁻⁶");
    this.cost = h("span", { class: "quiet" });
    this.node = h("div", { class: `accuracy ${name}`, title }, h("i", { class: "lamp" }), this.power, this.value, this.cost);
  }

  show(answer) {
    if (answer.target_error) this.power.textContent = answer.target_error > 5e-4 ? "10⁻³" : "10⁻⁴";
    this.value.textContent = bounds(answer);
    this.cost.replaceChildren(milliseconds(answer), h("span", { class: "beams" }, ` · ${answer.beams} beams`));
    this.node.classList.toggle("incomplete", answer.complete === false);
    this.node.classList.remove("old");
  }

  fail(why) {
    this.value.textContent = why;
    this.cost.textContent = "";
  }

  stale() {
    this.node.classList.add("old");
  }
}

export class Readout {
  constructor(session, ledger) {
    this.session = session;
    this.number = h("output", { class: "number" }, "–");
    // Copy of the value next to the pictures on narrow screens.
    this.small = h("output", { "aria-hidden": "true" }, "–");
    this.what = h("span", { class: "what" }, "of the light returns");
    this.moving = new Accuracy("moving", "While you change a value: standard error or truncated light of at most 1e-4; 1e-3 if 1e-4 takes too long");
    this.resting = new Accuracy("resting", "At rest: at most 1e-6 of the light is truncated");
    this.spoken = h("p", { class: "spoken", "aria-live": "polite" });
    this.controls = [this.control("incidence_deg", "Incidence", -80, 80, 0.5), this.control("azimuth_deg", "Azimuth", 0, 360, 1)];
    this.node = h(
      "section",
      { class: "readout", "aria-label": "Retroreflective efficiency" },
      h("div", { class: "main-number" }, h("span", { class: "name", title: "Retroreflective efficiency: the fraction of the light that returns within the acceptance cone" }, "RRE"), this.number, this.what),
      h("div", { class: "accuracies" }, this.moving.node, this.resting.node),
      h("fieldset", { class: "direction" }, h("legend", { class: "spoken" }, "Direction of the light"), ...this.controls.map(({ node }) => node)),
      ledger.node,
      this.spoken,
    );
  }

  control(key, name, low, high, step) {
    const id = newId(key);
    const look = (value) => {
      if (!Number.isFinite(value)) return;
      const next = { ...this.session.direction, [key]: value };
      this.session.look(next.incidence_deg, next.azimuth_deg);
    };
    const number = h("input", { type: "number", id, min: low, max: high, step, onchange: () => look(Number(number.value)) });
    const slider = h("input", { type: "range", min: low, max: high, step, "aria-label": `${name} in degrees`, "data-direction": key, oninput: () => look(Number(slider.value)) });
    const node = h("div", { class: "control" }, h("label", { for: id }, name), h("span", { class: "with-unit" }, number, h("span", {}, "°")), slider);
    return { key, node, number, slider };
  }

  start() {
    this.session.on("direction", (direction) => this.point(direction));
    this.session.on("answer", () => this.show());
    this.session.on("rested", (answer) => this.rest(answer));
    this.session.on("unrested", (why) => this.resting.fail(why));
    this.session.on("moving", (moving) => {
      this.node.classList.toggle("is-moving", moving);
      if (moving) this.resting.stale();
    });
    this.point(this.session.direction);
  }

  point(direction) {
    for (const { key, number, slider } of this.controls) {
      number.value = direction[key];
      slider.value = direction[key];
    }
  }

  show() {
    const { answer, why } = this.session;
    this.node.classList.toggle("absent", !answer);
    if (!answer) {
      this.number.textContent = "–";
      this.what.textContent = why ? why.text : "";
      return;
    }
    this.number.textContent = this.small.textContent = `${(100 * answer.rre).toFixed(2)} %`;
    this.what.textContent = `returns within ${short(answer.acceptance_half_angle_deg)}°`;
    this.moving.show(answer);
  }

  rest(answer) {
    this.number.textContent = `${(100 * answer.rre).toFixed(3)} %`;
    this.resting.show(answer);
    this.spoken.textContent = `RRE ${(100 * answer.rre).toFixed(2)} percent`;
  }
}
