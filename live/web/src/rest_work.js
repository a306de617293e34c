// Computations that run while the user makes no changes: the result for the current direction with the highest
// accuracy, the test points of a standard, and the curves of pinned designs.
import { CurvePass } from "./curve_work.js";
import { RESTING } from "./target_errors.js";

const DIRECTION_S = 20;
const PHOTOMETRY_S = 60;

export class Rest {
  constructor(session) {
    this.session = session;
    this.programme = null; // {standard, class, colour, area_cm2} when the photometry panel is open
    this.pins = []; // {toml, source, title, pass}
    this.isDue = false;
    session.on("rest", () => {
      this.isDue = true;
      session.engine.prepareSlow();
    });
    session.on("moving", (moving) => moving && this.stop());
    session.engine.lane({ speed: "slow", next: () => this.nextDirection(), done: (job, data) => this.takeDirection(job, data) });
    this.pinned = session.engine.lane({ next: () => this.nextPin(), done: (job, data) => this.takePin(job, data) });
    session.engine.lane({ speed: "slow", next: () => this.nextPhotometry(), done: (job, data) => this.takePhotometry(job, data) });
  }

  stop() {
    this.isDue = false;
    if (this.isJudging) this.judged = null; // request it again later
    this.isJudging = false;
    this.session.engine.drop();
    this.session.engine.withdraw(this.pinned);
  }

  /** Returns a text that identifies design and direction. An answer is discarded if this text has changed. */
  stampOf() {
    const { base, direction } = this.session;
    return `${base.source}\n${base.toml}\n${direction.incidence_deg} ${direction.azimuth_deg}`;
  }

  nextDirection() {
    const { base, isMoving, direction } = this.session;
    if (!this.isDue || isMoving || !base || !base.traces) return null;
    this.isDue = false;
    const asks = [{ ask: "direction", ...direction, target_error: RESTING, seconds: DIRECTION_S }];
    return { toml: base.toml, source: base.source, asks, of: this.stampOf() };
  }

  takeDirection(job, data) {
    if (job.of !== this.stampOf() || this.session.isMoving) return;
    const answer = data.answers && data.answers[0];
    if (answer && answer.ok) {
      this.session.answer = { ...answer, ...this.session.direction };
      this.session.tell("rested", answer);
    } else this.session.tell("unrested", answer && answer.kind === "budget" ? `takes longer than ${DIRECTION_S} s` : "–");
  }

  pin(design) {
    if (this.pins.length >= 4) return false;
    this.pins = [...this.pins, { toml: design.toml, source: design.source, title: design.title, pass: null }];
    this.session.tell("pins");
    this.session.engine.pump();
    return true;
  }

  unpin(pin) {
    this.pins = this.pins.filter((other) => other !== pin);
    this.session.tell("pins");
  }

  nextPin() {
    const { isMoving, direction, curve } = this.session;
    if (isMoving) return null;
    for (const pin of this.pins) {
      const wanted = new CurvePass(pin, direction.azimuth_deg, curve.half_range_deg, 0);
      if (!pin.pass || pin.pass.key !== wanted.key) pin.pass = wanted;
      if (pin.pass.isWhole() && !pin.pass.advance()) continue;
      return { ...pin.pass.job(), pin };
    }
    return null;
  }

  takePin({ pin, pass }, data) {
    const answer = data.answers && data.answers[0];
    if (pin.pass !== pass) return;
    if (answer && answer.ok) pass.take(answer);
    else pass.queue = [];
    if (pass.isWhole()) this.session.tell("pins");
  }

  choose(programme) {
    this.programme = programme;
    this.judged = null;
    this.session.engine.pump();
  }

  nextPhotometry() {
    const { base, isMoving } = this.session;
    if (isMoving || !base || !base.traces || !this.programme) return null;
    const of = JSON.stringify([base.source, base.toml, this.programme]);
    if (this.judged === of) return null;
    this.judged = of;
    this.isJudging = true;
    this.session.tell("judging");
    const asks = [{ ask: "photometry", ...this.programme, seconds: PHOTOMETRY_S }];
    return { toml: base.toml, source: base.source, asks, of };
  }

  takePhotometry(job, data) {
    if (job.of !== this.judged) return;
    this.isJudging = false;
    const answer = data.answers ? data.answers[0] : data.error || { ok: false, text: data.fault };
    this.session.tell("judged", answer);
  }
}
