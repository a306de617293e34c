// How long it takes from a change to what shows it, for tests and for who wants to know: window.retraceLive.measure.

export class Measure {
  constructor() {
    this.stamp = 0; // of the last change
    this.times = new Map();
    this.latencies_ms = { point: [], curve: [], map: [] };
    this.first_ms = null; // from the opening of the page to its first picture
    this.drawn = { point: 0, curve: 0, map: 0 }; // the stamp of what is shown
  }

  touched() {
    this.stamp += 1;
    this.times.set(this.stamp, performance.now());
    this.times.delete(this.stamp - 5000);
  }

  /** What the change of that stamp asked for is on the screen. */
  shown(what, stamp) {
    if (stamp <= this.drawn[what]) return;
    this.drawn[what] = stamp;
    if (what === "point") this.first_ms = this.first_ms ?? performance.now();
    this.latencies_ms[what].push(performance.now() - this.times.get(stamp));
  }
}
