// RRE against incidence at the azimuth that is pointed at: a coarse curve first, which is finished even while the
// design moves on, then finer ones, at rest each place once more and surer.
import { AT_ONCE, MOVING } from "./session.js";

const CHUNK_S = 0.012;
const PATIENCE_MS = 700; // after which a coarse curve is shown that is not whole
export const CURVE_STEPS_DEG = [5, 2.5, 1];

/** From -`to` to `to`, those first that stand farther apart, so that a few say something of the whole. */
function range(to, step) {
  const most = Math.floor(to / step + 1e-9);
  const all = Array.from({ length: 2 * most + 1 }, (_, k) => k - most);
  const rank = (k) => (k % 6 === 0 ? 0 : k % 3 === 0 ? 1 : 2);
  return all.sort((a, b) => rank(a) - rank(b)).map((k) => k * step);
}

/** A curve of one design that is being traced, from coarse to fine. */
export class CurvePass {
  constructor(design, azimuth_deg, half_range_deg, stamp) {
    Object.assign(this, { design, azimuth_deg, half_range_deg, stamp });
    this.key = `${design.source}\n${design.toml}\n${azimuth_deg}\n${half_range_deg}`;
    this.points = new Map(); // by incidence: [rre, truncated, std_error]
    this.level = -1;
    this.target_error = AT_ONCE;
    this.begun = performance.now();
    this.queue = [];
    this.advance();
  }

  isWhole() {
    return this.queue.length === 0;
  }

  /** The next finer steps. \return whether there are any */
  advance() {
    if (this.level + 1 >= CURVE_STEPS_DEG.length) return false;
    this.level += 1;
    this.queue = range(this.half_range_deg, CURVE_STEPS_DEG[this.level]).filter(
      (incidence) => !this.points.has(incidence),
    );
    return true;
  }

  /** All places once more, surer. */
  refine() {
    if (this.target_error === MOVING) return false;
    this.target_error = MOVING;
    this.queue = [...this.points.keys()].sort((a, b) => Math.abs(a) - Math.abs(b));
    return true;
  }

  job() {
    const directions = this.queue.map((incidence) => [incidence, this.azimuth_deg]);
    const { toml, source } = this.design;
    return { toml, source, pass: this, asks: [{ ask: "rre", directions, target_error: this.target_error, seconds: CHUNK_S }] };
  }

  take(answer) {
    answer.points.forEach((point, k) => this.points.set(this.queue[k], point));
    this.queue = this.queue.slice(answer.points.length);
  }

  /** Rising incidences and what was found there. */
  rows() {
    return [...this.points.entries()].sort((a, b) => a[0] - b[0]).map(([x, [rre, truncated, std_error = 0]]) => ({ x, rre, truncated, std_error }));
  }
}

export class Curve {
  constructor(session) {
    this.session = session;
    this.half_range_deg = 60;
    this.pass = null;
    this.shown = null; // the last pass that was whole once
    session.engine.lane({ next: () => this.next(), done: (job, data) => this.take(job, data) });
  }

  wanted() {
    const { base, direction, measure } = this.session;
    return new CurvePass(base, direction.azimuth_deg, this.half_range_deg, measure.drawn.point);
  }

  next() {
    const { base, isMoving } = this.session;
    if (!base || !base.traces) return null;
    if (!this.pass || this.pass.failed || this.pass.level > 0 || this.pass.isWhole()) {
      const wanted = this.wanted();
      if (!this.pass || wanted.key !== this.pass.key) this.pass = wanted;
    }
    const { pass } = this;
    if (pass.failed || (pass.isWhole() && (isMoving || !(pass.advance() || pass.refine())))) return null;
    return pass.job();
  }

  take(job, data) {
    const answer = data.answers && data.answers[0];
    if (job.pass !== this.pass) return;
    if (!answer || !answer.ok) {
      this.pass.failed = true; // what one direction cannot, the others will not
      return;
    }
    this.pass.take(answer);
    if (this.pass.level === 0 && !this.pass.isWhole() && performance.now() - this.pass.begun < PATIENCE_MS) return;
    this.shown = this.pass;
    this.session.tell("curve", this.pass);
  }
}
