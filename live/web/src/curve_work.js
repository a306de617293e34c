// Computes RRE against incidence at the current azimuth. A coarse curve is computed first, and is finished even while
// the design changes. Finer curves follow. If the user makes no changes, all points are then computed again with higher
// accuracy.
import { directionOf, nameOf } from "./directions.js";
import { AT_ONCE, MOVING } from "./target_errors.js";

const PIECE_S = 0.012;
const PATIENCE_MS = 700; // time after which an incomplete coarse curve is shown
const QUICK_MS = 60; // engine time in ms; if a curve takes longer, the next curve begins with larger steps
export const CURVE_STEPS_DEG = [10, 5, 2.5, 1];

/**
 * Returns the multiples of `step` from -`to` to `to`. Widely spaced values come first, so that the first few cover the
 * whole range.
 */
function range(to, step) {
  const most = Math.floor(to / step + 1e-9);
  const all = Array.from({ length: 2 * most + 1 }, (_, k) => k - most);
  const rank = (k) => (k % 6 === 0 ? 0 : k % 3 === 0 ? 1 : 2);
  return all.sort((a, b) => rank(a) - rank(b)).map((k) => k * step);
}

/**
 * Curve of one design that is computed from coarse to fine steps.
 * \param level index of the first step size in CURVE_STEPS_DEG
 */
export class CurvePass {
  constructor(design, azimuth_deg, half_range_deg, stamp, level = 1) {
    Object.assign(this, { design, azimuth_deg, half_range_deg, stamp });
    this.key = `${design.source}\n${design.toml}\n${azimuth_deg}\n${half_range_deg}`;
    this.points = new Map(); // by the name of the traced direction: [rre, truncated, std_error]
    this.incidences = new Set();
    this.first = level;
    this.level = level - 1;
    this.target_error = AT_ONCE;
    this.begun = performance.now();
    this.queue = []; // names of directions
    this.ms = 0; // total engine time in ms for points with the target error AT_ONCE
    this.advance();
  }

  nameOf(incidence) {
    return nameOf(incidence, this.azimuth_deg, this.design.azimuth_symmetry);
  }

  isWhole() {
    return this.queue.length === 0;
  }

  /**
   * Adds the points of the next finer step.
   * \return false if there is no finer step
   */
  advance() {
    if (this.level + 1 >= CURVE_STEPS_DEG.length) return false;
    this.level += 1;
    const incidences = range(this.half_range_deg, CURVE_STEPS_DEG[this.level]);
    incidences.forEach((incidence) => this.incidences.add(incidence));
    this.queue = [...new Set(incidences.map((incidence) => this.nameOf(incidence)))].filter((name) => !this.points.has(name));
    return true;
  }

  /** Queues all points again with higher accuracy. */
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

  /** Returns the level at which the next curve begins, from the computing time of this curve. */
  firstLevel() {
    const directions = 2 * Math.floor(this.half_range_deg / CURVE_STEPS_DEG[1]) + 1;
    return (this.ms / this.incidences.size) * directions > QUICK_MS ? 0 : 1;
  }

  /** Returns the points in order of incidence. */
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
    this.level = 1; // index in CURVE_STEPS_DEG of the first step size of the next curve
    this.shown = null; // displayed curve: its first step size is complete, or PATIENCE_MS have passed
    this.lane = session.engine.lane({ next: () => this.next(), done: (job, data) => this.take(job, data) });
    for (const event of ["moving", "design"]) session.on(event, () => this.review());
  }

  /** Stops a finer curve if the design has changed. */
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
      this.pass.failed = true; // if one direction fails, all others fail, too
      return;
    }
    this.pass.take(answer);
    if (this.pass.level === this.pass.first && this.pass.isWhole()) this.level = this.pass.firstLevel();
    if (this.pass.level === this.pass.first && !this.pass.isWhole() && performance.now() - this.pass.begun < PATIENCE_MS) return;
    this.shown = this.pass;
    this.session.tell("curve", this.pass);
  }
}
