// Computes RRE over all directions on rings of constant incidence, from coarse to fine. The number of points increases
// with the radius of the ring. If directions are equivalent by symmetry, only one of them is traced.
import { directionOf, nameOf } from "./directions.js";
import { AT_ONCE } from "./target_errors.js";

const PIECE_S = 0.004;
const RING_STEPS_DEG = [20, 10, 5, 2.5];
// During changes, a map is completed up to this index in RING_STEPS_DEG before the next map begins.
const WHILE_MOVING = 1;
const PATIENCE_MS = 700; // time after which any complete ring step is sufficient
const PLACES = 6; // number of points of the first ring; ring k has k times this number

export class MapPass {
  constructor(design, most_deg, stamp) {
    Object.assign(this, { design, most_deg, stamp });
    this.key = `${design.source}\n${design.toml}\n${most_deg}`;
    this.values = new Map(); // RRE of each traced direction, by the name of the direction
    this.level = -1;
    this.begun = performance.now();
    this.rings = null; // rings of the finest complete level: [{incidence_deg, values}]
    this.advance();
  }

  places(level) {
    const step = RING_STEPS_DEG[level];
    const rings = [];
    for (let k = 0; k * step <= this.most_deg + 1e-9; ++k) {
      const count = k === 0 ? 1 : PLACES * k;
      rings.push({ incidence_deg: k * step, names: Array.from({ length: count }, (_, i) => nameOf(k * step, (360 * i) / count, this.design.azimuth_symmetry)) });
    }
    return rings;
  }

  isWhole() {
    return this.queue.length === 0;
  }

  /** Returns true if the map is fine enough to be abandoned for another design. */
  isEnough() {
    return this.level > WHILE_MOVING || (this.isWhole() && (this.level === WHILE_MOVING || performance.now() - this.begun > PATIENCE_MS));
  }

  advance() {
    if (this.level + 1 >= RING_STEPS_DEG.length) return false;
    this.level += 1;
    const names = new Set(this.places(this.level).flatMap((ring) => ring.names));
    this.queue = [...names].filter((name) => !this.values.has(name));
    return true;
  }

  job() {
    const asked = this.queue;
    const directions = asked.map(directionOf);
    const { toml, source } = this.design;
    return { toml, source, pass: this, long: true, asks: [{ ask: "rre", directions, target_error: AT_ONCE, seconds: PIECE_S }] };
  }

  take(answer) {
    answer.points.forEach(([rre], k) => this.values.set(this.queue[k], rre));
    this.queue = this.queue.slice(answer.points.length);
    if (this.isWhole())
      this.rings = this.places(this.level).map(({ incidence_deg, names }) => ({
        incidence_deg,
        values: names.map((name) => this.values.get(name)),
      }));
  }
}

export class DirectionMap {
  constructor(session) {
    this.session = session;
    this.most_deg = 60;
    this.pass = null;
    this.shown = null;
    this.lane = session.engine.lane({ next: () => this.next(), done: (job, data) => this.take(job, data) });
    for (const event of ["moving", "design"]) session.on(event, () => this.review());
  }

  wanted() {
    const { base, measure } = this.session;
    return new MapPass(base, this.most_deg, measure.drawn.point);
  }

  /** Stops the map if the design has changed, unless it is still too coarse. */
  review() {
    if (this.lane.running === 0 || !this.pass.isEnough() || this.wanted().key === this.pass.key) return;
    this.session.engine.withdraw(this.lane);
    this.pass = null;
  }

  next() {
    const { base, isMoving } = this.session;
    if (!base || !base.traces) return null;
    if (!this.pass || this.pass.isEnough() || this.pass.failed) {
      const wanted = this.wanted();
      if (!this.pass || wanted.key !== this.pass.key) this.pass = wanted;
    }
    const { pass } = this;
    if (pass.failed || (pass.isWhole() && ((isMoving && pass.isEnough()) || !pass.advance()))) return null;
    return pass.job();
  }

  take(job, data) {
    const { pass } = job;
    const answer = data.answers && data.answers[0];
    if (pass !== this.pass) return;
    if (!answer || !answer.ok) {
      pass.failed = true; // if one direction fails, all others fail, too
      return;
    }
    pass.take(answer);
    // During changes, a coarse map does not replace a finer one.
    const isShown = pass.isWhole() && (!this.shown || !this.session.isMoving || pass.isEnough());
    if (isShown) this.shown = pass;
    this.session.tell(isShown ? "map" : "map_progress", pass);
  }
}
