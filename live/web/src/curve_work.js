// RRE against incidence at the azimuth that is pointed at: a coarse curve first, which is finished even while the
// design moves on, then finer ones, at rest each place once more and surer.
import { directionOf, nameOf } from "./directions.js";
import { AT_ONCE, MOVING } from "./session.js";

const PIECE_S = 0.012;
const PATIENCE_MS = 700; // after which a coarse curve is shown that is not whole
const QUICK_MS = 60; // of the engine's time: a curve that takes longer begins with wider steps
export const CURVE_STEPS_DEG = [10, 5, 2.5, 1];

/** From -`to` to `to`, those first that stand farther apart, so that a few say something of the whole. */
function range(to, step) {
  const most = Math.floor(to / step + 1e-9);
  const all = Array.from({ length: 2 * most + 1 }, (_, k) => k - most);
  const rank = (k) => (k % 6 === 0 ? 0 : k % 3 === 0 ? 1 : 2);
  return all.sort((a, b) => rank(a) - rank(b)).map((k) => k * step);
}

/** A curve of one design that is being traced, from coarse to fine. \param level that it begins with */
export class CurvePass {
  constructor(design, azimuth_deg, half_range_deg, stamp, level = 1) {
    Object.assign(this, { design, azimuth_deg, half_range_deg, stamp });
    this.key = `${design.source}\n${design.toml}\n${azimuth_deg}\n${half_range_deg}`;
    this.points = new Map(); // by the name of the direction that is traced: [rre, truncated, std_error]
    this.incidences = new Set();
    this.first = level;
    this.level = level - 1;
    this.target_error = AT_ONCE;
    this.begun = performance.now();
    this.queue = []; // names of directions
    this.ms = 0; // of the engine's time at AT_ONCE
    this.advance();
  }

  nameOf(incidence) {
    return nameOf(incidence, this.azimuth_deg, this.design.azimuth_symmetry);
  }

  isWhole() {
    return this.queue.length === 0;
  }

  /** The next finer steps. \return whether there are any */
  advance() {
    if (this.level + 1 >= CURVE_STEPS_DEG.length) return false;
    this.level += 1;
    const incidences = range(this.half_range_deg, CURVE_STEPS_DEG[this.level]);
    incidences.forEach((incidence) => this.incidences.add(incidence));
    this.queue = [...new Set(incidences.map((incidence) => this.nameOf(incidence)))].filter((name) => !this.points.has(name));
    return true;
  }

  /** All places once more, surer. */
  refine() {
    if (this.target_error === MOVING) return false;
    this.target_error = MOVING;
    this.queue = [...this.points.keys()].sort((a, b) => directionOf(a)[0] - directionOf(b)[0]);
    return true;
  }

  job() {
    const directions = this.queue.map(directionOf);
    const { toml, source } = this.design;
    return { toml, source, pass: this, long: true, asks: [{ ask: "rre", directions, target_error: this.target_error, seconds: PIECE_S }] };
  }

  take(answer) {
    answer.points.forEach((point, k) => this.points.set(this.queue[k], point));
    this.queue = this.queue.slice(answer.points.length);
    if (this.target_error === AT_ONCE) this.ms += answer.ms;
  }

  /** The level that the next curve is to begin with, by what this one took. */
  firstLevel() {
    const directions = 2 * Math.floor(this.half_range_deg / CURVE_STEPS_DEG[1]) + 1;
    return (this.ms / this.incidences.size) * directions > QUICK_MS ? 0 : 1;
  }

  /** Rising incidences and what was found there. */
  rows() {
    return [...this.incidences]
      .sort((a, b) => a - b)
      .map((x) => ({ x, point: this.points.get(this.nameOf(x)) }))
      .filter(({ point }) => point)
      .map(({ x, point: [rre, truncated, std_error = 0] }) => ({ x, rre, truncated, std_error }));
  }
}

export class Curve {
  constructor(session) {
    this.session = session;
    this.half_range_deg = 60;
    this.pass = null;
    this.level = 1; // that the next pass begins with
    this.shown = null; // the last pass that was whole once
    this.lane = session.engine.lane({ next: () => this.next(), done: (job, data) => this.take(job, data) });
    for (const event of ["moving", "design"]) session.on(event, () => this.review());
  }

  /** Finer curves of what has changed since are left. */
  review() {
    if (this.lane.running === 0 || this.pass.level === this.pass.first || this.wanted().key === this.pass.key) return;
    this.session.engine.withdraw(this.lane);
    this.pass = null;
  }

  wanted() {
    const { base, direction, measure } = this.session;
    return new CurvePass(base, direction.azimuth_deg, this.half_range_deg, measure.drawn.point, this.level);
  }

  next() {
    const { base, isMoving } = this.session;
    if (!base || !base.traces) return null;
    if (!this.pass || this.pass.failed || this.pass.level > this.pass.first || this.pass.isWhole()) {
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
    if (this.pass.level === this.pass.first && this.pass.isWhole()) this.level = this.pass.firstLevel();
    if (this.pass.level === this.pass.first && !this.pass.isWhole() && performance.now() - this.pass.begun < PATIENCE_MS) return;
    this.shown = this.pass;
    this.session.tell("curve", this.pass);
  }
}
