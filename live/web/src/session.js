// What the page is about: a design, a direction of the light, perhaps a spot of the plan - and what the engine has said of
// them. Everything that changes goes through here; what shows it listens.
import { Curve } from "./curve_work.js";
import { DirectionMap } from "./map_work.js";
import { Measure } from "./measure.js";
import { Rest } from "./rest_work.js";

// By how much RRE may be off: its standard error where weak beams are resampled, else what is left untraced.
export const MOVING = 1e-4; // while something moves
export const RESTING = 1e-6; // at rest
export const AT_ONCE = 1e-3; // of the many directions of curves and maps, at first
const REST_MS = 260; // without a change, until the picture is traced in full
const MOST_S = 1.5; // for one direction while moving
const PACE_MS = 66; // between two directions while something moves: the page needs the time in between to draw
const SOON_MS = 30; // a change that is this old is the last one for now: a drag would have brought the next
const FRESH_MS = 3; // a change that is no older has just been made
const QUICK_MS = 45; // that a direction may take while something moves; what takes longer is first traced to AT_ONCE,
const RATIO = 4; // which is so many times quicker

export class Session {
  constructor(engine) {
    this.engine = engine;
    this.listeners = new Map();
    this.base = null; // the design that is shown, as the engine opened it
    this.changes = {}; // keys that are to be other than in `base`, but have not been traced yet
    this.refused = {}; // keys whose values could not be: they are tried again together with the next that is changed
    this.adapt = false;
    this.wanted = null; // a text that is to take the place of `base`
    this.direction = { incidence_deg: 0, azimuth_deg: 0 };
    this.spot = null;
    this.answer = null; // of the direction, while moving
    this.part = null;
    this.isDue = false;
    this.isMoving = false;
    this.sent = -Infinity; // when the last direction was asked for
    this.touched = -Infinity; // when something moved last
    this.isSlow = false; // whether a direction to MOVING takes too long to follow the hand
    this.target_error = MOVING; // of the next direction
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

  /** A key of the form; nothing takes it back. `adapt`: what no longer means anything beside it goes too. */
  change(path, value, adapt = false) {
    Object.assign(this.changes, this.refused, { [path]: value });
    this.refused = {};
    this.adapt = this.adapt || adapt;
    this.touch();
  }

  /** Another design. `then` is called with the engine's answer. */
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

  /** Something has moved: a quick picture at once, a full one when all is at rest. */
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

  // --- the lane of the direction that is pointed at

  /** How long to wait before the next direction is asked for, in ms; 0 or less: not at all. First until PACE_MS have gone
   * since the last one, then for the next change of a drag, so that what is shown is as new as can be. */
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
      { ask: "direction", ...at, target_error: this.target_error, seconds: MOST_S },
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
    this.engine.pump(); // the next is worked on while this is drawn
    this.tell("answer", { isNewPart: Boolean(part && part.ok), stamp: job.stamp });
  }

  /** What was asked for cannot be: it is said, and the last picture stays. */
  refuse(job, error) {
    if (job.wanted && this.wanted === job.wanted) this.wanted = null;
    for (const [path, value] of Object.entries(job.changes || {})) {
      if (this.changes[path] !== value) continue;
      delete this.changes[path];
      this.refused[path] = value;
    }
    // Where the light comes from, or the spot, may have changed as well.
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
