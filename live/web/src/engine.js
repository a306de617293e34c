// Manages the engine's workers and the order of their jobs.
//
// A lane is a source of jobs, such as the curve or the map. A lane has at most one running job, which is sent to the
// worker with the fewest jobs. When the job is done, the next job is requested from the lane. A worker alternates
// between jobs with many directions, in steps of about 10 ms, and continues with them while the page draws. The job for
// the current direction runs before all others. Jobs that take seconds have a separate worker, which is terminated when
// its answer is not needed.

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

/** Returns the number of workers for quick jobs. One processor core is left for the page itself. */
function countOfWorkers() {
  return Math.max(1, Math.min(3, (navigator.hardwareConcurrency || 2) - 1));
}

export class Engine {
  constructor() {
    this.workers = { quick: [], slow: [] }; // workers with their numbers of jobs: {worker, jobs}
    this.lanes = { quick: [], slow: [] };
    this.waiting = new Map(); // running jobs; the key is the number of the job
    this.count = 0;
    this.failed = () => {};
  }

  /** Starts the workers. Returns when the first worker is ready. */
  async start() {
    const text = (id) => document.getElementById(id).textContent;
    this.script = text("engine-js");
    this.wasm = await unpacked(bytesOf(text("engine-wasm").trim()));
    await this.add("quick");
    for (let k = 1; k < countOfWorkers(); ++k) this.add("quick").catch(this.failed);
  }

  /** Starts the worker for slow jobs if there is none. It starts late, so that the first picture is not delayed. */
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

  /**
   * Adds a lane.
   * \param next function that returns the lane's next job, or nothing
   * \param done function that is called with a job and its answer, or with the answer to a part of the job
   */
  lane({ next, done, speed = "quick" }) {
    const lane = { next, done, speed, running: 0 };
    this.lanes[speed].push(lane);
    return lane;
  }

  /** Runs a single job that belongs to no lane, and returns its answer. */
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
    if (!found) return; // the job was withdrawn
    if (!data.isMore) this.end(data.id);
    found.lane.done(found.job, data);
  }

  end(id) {
    const { lane, at } = this.waiting.get(id);
    this.waiting.delete(id);
    lane.running -= 1;
    at.jobs -= 1;
  }

  /** Sends the next jobs of the lanes to the workers. A worker for slow jobs gets only one job at a time. */
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

  /** Cancels the running job of a lane, because its answer is not needed. */
  withdraw(lane) {
    for (const [id, found] of this.waiting) {
      if (found.lane !== lane) continue;
      found.at.worker.postMessage({ withdrawn: id });
      this.end(id);
    }
  }

  /** Cancels all slow jobs. Their workers are terminated, and new workers are started. */
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
