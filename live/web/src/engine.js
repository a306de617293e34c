// The engine's workers, and the order in which what the page wants is asked of them.
//
// A lane has at most one thing that it wants: a later wish takes the place of an earlier one that has not begun. Lanes
// are served by their rank; one that has just been served lets the others go first once, so that a drag, which wants a new
// picture all the time, does not keep the curve from ever being finished. Their jobs take some 10 ms, so none waits long.
// What takes seconds has a worker of its own, which is ended where its answer is no longer wanted.

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
    this.idle = { quick: [], slow: [] };
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
          this.idle[speed].push(worker);
          resolve();
        }
        this.pump();
      };
      worker.postMessage({ wasm: this.wasm });
    });
  }

  /** \param next gives the job that the lane wants now, or nothing \param done takes a job and its answer */
  lane({ next, done, speed = "quick" }) {
    const lane = { next, done, speed, running: 0, served: false };
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
    const { lane, job, worker } = this.waiting.get(data.id);
    this.waiting.delete(data.id);
    lane.running -= 1;
    this.idle[lane.speed].push(worker);
    lane.done(job, data);
  }

  /** Gives idle workers what the lanes want. */
  pump() {
    for (const speed of ["quick", "slow"])
      while (this.idle[speed].length > 0) {
        const found = this.choose(speed, false) || this.choose(speed, true);
        if (!found) break;
        this.send(...found);
      }
  }

  choose(speed, again) {
    for (const lane of this.lanes[speed]) {
      if (lane.running > 0 || (lane.served && !again)) continue;
      const job = lane.next();
      if (!job) continue;
      if (again) this.lanes[speed].forEach((other) => (other.served = false));
      lane.served = true;
      return [lane, job];
    }
    return null;
  }

  send(lane, job) {
    const id = (this.count += 1);
    const worker = this.idle[lane.speed].pop();
    this.waiting.set(id, { lane, job, worker });
    lane.running += 1;
    const { toml, source, changes, adapt, asks } = job;
    worker.postMessage({ id, toml, source, changes, adapt, asks });
  }

  /** Slow work that is under way is of no use any more: its worker is ended, and another started. */
  drop() {
    for (const [id, { lane, worker }] of this.waiting) {
      if (lane.speed !== "slow") continue;
      worker.terminate();
      this.waiting.delete(id);
      lane.running -= 1;
      this.add("slow").catch(this.failed);
    }
  }
}
