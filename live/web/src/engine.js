// The engine's workers, and the order in which what the page wants is asked of them.
//
// A lane has at most one job under way; it goes to the worker that has the fewest. When it is done the lane is asked what it
// wants by then. A worker does jobs of many directions by turns, in pieces of some 10 ms, and goes on with them while the
// page draws; the direction that is pointed at comes before all of them. What takes seconds has a worker of its own, which
// is ended when its answer is no longer wanted.

function bytesOf(base64) {
  return Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
}

async function unpacked(bytes) {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Response(stream).arrayBuffer();
}

/* global WORKER_SCRIPT */
function startWorker(engineScript) {
  const url = URL.createObjectURL(new Blob([engineScript, "\n", WORKER_SCRIPT], { type: "text/javascript" }));
  const worker = new Worker(url);
  URL.revokeObjectURL(url);
  return worker;
}

/** How many workers for quick jobs the machine has room for beside the page itself. */
function countOfWorkers() {
  return Math.max(1, Math.min(3, (navigator.hardwareConcurrency || 2) - 1));
}

export class Engine {
  constructor() {
    this.workers = { quick: [], slow: [] }; // each with the number of its jobs: {worker, jobs}
    this.lanes = { quick: [], slow: [] };
    this.waiting = new Map(); // what is being worked on, by the job's number
    this.count = 0;
    this.failed = () => {};
  }

  /** Starts the workers; done when the first can be asked. */
  async start() {
    const text = (id) => document.getElementById(id).textContent;
    this.script = text("engine-js");
    this.wasm = await unpacked(bytesOf(text("engine-wasm").trim()));
    await this.add("quick");
    for (let k = 1; k < countOfWorkers(); ++k) this.add("quick").catch(this.failed);
  }

  /** A worker for slow jobs, if there is none yet: it is not to delay the first picture. */
  prepareSlow() {
    if (!this.hasSlow) this.add("slow").catch(this.failed);
    this.hasSlow = true;
  }

  add(speed) {
    const worker = startWorker(this.script);
    return new Promise((resolve, reject) => {
      worker.onerror = (event) => reject(new Error(event.message));
      worker.onmessage = ({ data }) => {
        if (data.id != null) this.take(data);
        else if (!data.ready) reject(new Error(data.fault));
        else {
          this.workers[speed].push({ worker, jobs: 0 });
          resolve();
        }
        this.pump();
      };
      worker.postMessage({ wasm: this.wasm });
    });
  }

  /** \param next gives the job that the lane wants now, or nothing \param done takes a job and its answer, or a piece of it */
  lane({ next, done, speed = "quick" }) {
    const lane = { next, done, speed, running: 0 };
    this.lanes[speed].push(lane);
    return lane;
  }

  /** One question that belongs to no lane. */
  ask(job) {
    return new Promise((resolve) => {
      let wanted = job;
      const next = () => {
        const now = wanted;
        wanted = null;
        return now;
      };
      const lane = this.lane({
        next,
        done: (_, data) => {
          this.lanes.quick = this.lanes.quick.filter((other) => other !== lane);
          resolve(data);
        },
      });
      this.pump();
    });
  }

  take(data) {
    const found = this.waiting.get(data.id);
    if (!found) return; // withdrawn
    if (!data.isMore) this.end(data.id);
    found.lane.done(found.job, data);
  }

  end(id) {
    const { lane, at } = this.waiting.get(id);
    this.waiting.delete(id);
    lane.running -= 1;
    at.jobs -= 1;
  }

  /** Gives workers what the lanes want; slow ones one thing at a time. */
  pump() {
    for (const speed of ["quick", "slow"])
      for (const lane of this.lanes[speed]) {
        if (lane.running > 0) continue;
        const [at] = [...this.workers[speed]].sort((a, b) => a.jobs - b.jobs);
        if (!at || (speed === "slow" && at.jobs > 0)) continue;
        const job = lane.next();
        if (job) this.send(lane, job, at);
      }
  }

  send(lane, job, at) {
    const id = (this.count += 1);
    this.waiting.set(id, { lane, job, at });
    lane.running += 1;
    at.jobs += 1;
    const { toml, source, changes, adapt, asks, long = false, urgent = false } = job;
    at.worker.postMessage({ id, toml, source, changes, adapt, asks, long, urgent });
  }

  /** What is under way for a lane is of no use any more. */
  withdraw(lane) {
    for (const [id, found] of this.waiting) {
      if (found.lane !== lane) continue;
      found.at.worker.postMessage({ withdrawn: id });
      this.end(id);
    }
  }

  /** Slow work that is under way is of no use any more: its worker is ended, and another started. */
  drop() {
    for (const [id, { lane, at }] of this.waiting) {
      if (lane.speed !== "slow") continue;
      at.worker.terminate();
      this.end(id);
      this.workers.slow = this.workers.slow.filter((other) => other !== at);
      this.add("slow").catch(this.failed);
    }
  }
}
