// Measures the time from a change to its display, for tests and for users: window.retraceLive.measure.

export class Measure {
  constructor() {
    this.stamp = 0; // number of the last change
    this.times = new Map();
    this.latencies_ms = { point: [], curve: [], map: [] };
    this.first_ms = null; // time from opening the page to the first picture
    this.drawn = { point: 0, curve: 0, map: 0 }; // number of the change that is displayed
  }

  touched() {
    this.stamp += 1;
    this.times.set(this.stamp, performance.now());
    this.times.delete(this.stamp - 5000);
  }

  /** Records that the result of change `stamp` is displayed. */
  shown(what, stamp) {
    if (stamp <= this.drawn[what]) return;
    this.drawn[what] = stamp;
    if (what === "point") this.first_ms = this.first_ms ?? performance.now();
    this.latencies_ms[what].push(performance.now() - this.times.get(stamp));
  }
}
