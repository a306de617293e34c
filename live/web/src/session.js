// State of the page: design, direction of light, optional spot on the plan, and the engine's answers. All changes go
// through this class. Panels listen to its events.
import { Curve } from "./curve_work.js";
import { DirectionMap } from "./map_work.js";
import { Measure } from "./measure.js";
import { Rest } from "./rest_work.js";
import { AT_ONCE, MOVING } from "./target_errors.js";

const REST_MS = 260; // time without changes after which the computations in rest_work.js begin
const MAX_SECONDS = 1.5; // maximum time for one direction during changes
const PACE_MS = 66; // minimum time between two directions during changes, so that the page has time to draw
const SOON_MS = 30; // time to wait after a change, because a drag often causes another change within this time
const FRESH_MS = 3; // a change younger than this time is traced immediately
const QUICK_MS = 45; // if a direction takes longer during changes, the next one is traced with the target error AT_ONCE
const RATIO = 4; // estimated time of tracing with the target error MOVING, divided by the time with AT_ONCE

export class Session {
  constructor(engine) {
    this.engine = engine;
    this.listeners = new Map();
    this.base = null; // the displayed design, as the engine opened it
    this.changes = {}; // changes of keys of `base` that have not been traced yet
    this.refused = {}; // changes that were rejected; they are tried again together with the next change
    this.adapt = false;
    this.wanted = null; // design text that will replace `base`
    this.direction = { incidence_deg: 0, azimuth_deg: 0 };
    this.spot = null;
    this.answer = null; // results for the current direction while the user makes changes
    this.part = null;
    this.isDue = false;
    this.isMoving = false;
    this.sent = -Infinity; // time of the last request for a direction
    this.touched = -Infinity; // time of the last change
    this.isSlow = false; // true if tracing with the target error MOVING is too slow to follow the pointer
    this.target_error = MOVING; // target error of the next direction
    this.revision = 0;
    this.measure = new Measure();
    this.point = engine.lane({ next: () => this.nextPoint(), done: (job, data) => this.takePoint(job, data) });
    this.curve = new Curve(this);
    this.map = new DirectionMap(this);
    this.rest = new Rest(this);
  }

  on(event, listener) {
    if (!this.listeners.has(event)) this.listeners.set(event, []);
    this.listeners.get(event).push(listener);
  }

  tell(event, value) {
    for (const listener of this.listeners.get(event) || []) listener(value);
  }

  /** Changes a key; null removes it. If `adapt` is true, keys that lose their effect are removed, too. */
  change(path, value, adapt = false) {
    Object.assign(this.changes, this.refused, { [path]: value });
    this.refused = {};
    this.adapt = this.adapt || adapt;
    this.touch();
  }

  /** Opens another design. `then` is called with the engine's answer. */
  open(toml, source, then = () => {}) {
    this.wanted = { toml, source, then };
    this.changes = {};
    this.refused = {};
    this.adapt = false;
    this.touch();
  }

  look(incidence_deg, azimuth_deg) {
    const turns = ((azimuth_deg % 360) + 360) % 360;
    this.direction = { incidence_deg: Math.max(-89, Math.min(89, incidence_deg)), azimuth_deg: turns };
    this.tell("direction", this.direction);
    this.touch();
  }

  pick(spot) {
    this.spot = spot;
    this.touch();
  }

  /** Registers a change: a quick picture is computed immediately, and an accurate picture when changes stop. */
  touch() {
    this.isDue = true;
    this.isMoving = true;
    this.target_error = this.isSlow ? AT_ONCE : MOVING;
    this.touched = performance.now();
    this.measure.touched();
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.settle(), REST_MS);
    this.tell("moving", true);
    this.engine.pump();
  }

  settle() {
    const canGo = this.base || this.wanted;
    if ((this.isDue && canGo) || this.point.running > 0) {
      this.timer = setTimeout(() => this.settle(), REST_MS);
      return;
    }
    if (this.answer && this.answer.target_error > MOVING) {
      this.target_error = MOVING;
      this.isDue = true;
      this.timer = setTimeout(() => this.settle(), REST_MS);
      this.engine.pump();
      return;
    }
    this.isMoving = false;
    this.tell("moving", false);
    this.tell("rest");
    this.engine.pump();
  }

  // --- jobs that trace the current direction

  /**
   * Returns the time in ms before the next direction is requested; 0 or less means immediately. At least PACE_MS must
   * pass after the last request. Then the next change of a drag is awaited, so that the displayed result is as recent
   * as possible.
   */
  pace() {
    const now = performance.now();
    const early_ms = this.sent + PACE_MS - now;
    const age_ms = now - this.touched;
    if (early_ms > 0) return early_ms + SOON_MS;
    return age_ms < FRESH_MS ? 0 : SOON_MS - age_ms;
  }

  nextPoint() {
    if (!this.isDue || (!this.base && !this.wanted)) return null;
    const wait_ms = this.pace();
    if (wait_ms > 0) {
      clearTimeout(this.later);
      this.later = setTimeout(() => this.engine.pump(), wait_ms);
      return null;
    }
    this.sent = performance.now();
    this.isDue = false;
    const job = this.wanted
      ? { ...this.wanted, wanted: this.wanted }
      : { toml: this.base.toml, source: this.base.source };
    if (Object.keys(this.changes).length > 0) Object.assign(job, { changes: { ...this.changes }, adapt: this.adapt });
    const at = { ...this.direction };
    job.asks = [
      { ask: "direction", ...at, target_error: this.target_error, seconds: MAX_SECONDS },
      this.spot ? { ask: "path", ...at, at_mm: this.spot } : { ask: "stories", ...at },
    ];
    if (job.changes || job.wanted || !this.part) job.asks.push({ ask: "part" });
    return Object.assign(job, { urgent: true, at, spot: this.spot, stamp: this.measure.stamp, target_error: this.target_error });
  }

  takePoint(job, data) {
    if (data.fault || data.error) {
      this.refuse(job, data.error || { kind: "fault", text: data.fault });
      return;
    }
    this.accept(job, data.design);
    this.shownOf = JSON.stringify([job.at, job.spot]);
    const [direction, paths, part] = data.answers;
    if (part && part.ok) this.part = part;
    this.answer = direction.ok ? { ...direction, ...job.at, target_error: job.target_error } : null;
    this.isSlow = direction.ms > (job.target_error > MOVING ? QUICK_MS / RATIO : QUICK_MS);
    this.why = direction.ok ? null : direction;
    this.paths = !paths.ok ? [] : job.spot ? [{ ...paths, spot: job.spot }] : paths.paths;
    this.engine.pump(); // the next direction is computed while this one is drawn
    this.tell("answer", { isNewPart: Boolean(part && part.ok), stamp: job.stamp });
  }

  /** Reports that a request failed. The last picture stays visible. */
  refuse(job, error) {
    if (job.wanted && this.wanted === job.wanted) this.wanted = null;
    for (const [path, value] of Object.entries(job.changes || {})) {
      if (this.changes[path] !== value) continue;
      delete this.changes[path];
      this.refused[path] = value;
    }
    // The direction of light or the spot may have changed, too.
    if (this.base && this.shownOf !== JSON.stringify([job.at, job.spot])) this.isDue = true;
    this.tell("refused", { error, changes: job.changes || null, text: job.wanted ? job.wanted.toml : null });
    if (job.wanted) job.wanted.then(error);
  }

  accept(job, design) {
    const isNew = !this.base || this.base.toml !== design.toml || this.base.source !== design.source;
    if (job.wanted && this.wanted === job.wanted) this.wanted = null;
    for (const [path, value] of Object.entries(job.changes || {}))
      if (this.changes[path] === value) delete this.changes[path];
    if (Object.keys(this.changes).length === 0) this.adapt = false;
    if (job.changes || job.wanted) this.tell("accepted");
    this.base = design;
    if (isNew) this.revision += 1;
    this.tell("design", { design, isNew, isOpened: Boolean(job.wanted) });
    if (job.wanted) job.wanted.then(design);
  }
}
