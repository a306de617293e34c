// Runs in the worker: the engine and its open designs. A job contains a design (a text and changed keys) and requests.
// Each answer is returned with its computing time. `long` jobs are done in steps, each with an answer, so that other
// jobs can run in between. `urgent` jobs run before all waiting jobs.
import { edited } from "./toml_edit.js";

const MAX_OPEN = 40;
let call = null;
const opened = new Map(); // open designs by source and text; the most recently used design is the last

function ask(request) {
  const begin = performance.now();
  const response = JSON.parse(call(JSON.stringify(request)));
  response.ms = performance.now() - begin;
  return response;
}

function keep(key, response) {
  opened.delete(key);
  opened.set(key, response);
  if (opened.size <= MAX_OPEN) return;
  const [oldest, { design }] = opened.entries().next().value;
  opened.delete(oldest);
  ask({ ask: "close", design });
}

function open({ toml, source }) {
  const key = `${source}\n${toml}`;
  const response = opened.get(key) || ask({ ask: "open", toml, source });
  if (response.ok) keep(key, response);
  return response;
}

/** Compares two values. A number equals a list that contains only this number. */
function sameValue(a, b) {
  return JSON.stringify([].concat(a)) === JSON.stringify([].concat(b));
}

/** Returns the design with new values in its text, or nothing if the text cannot be changed line by line. */
function rewritten(job) {
  const toml = job.adapt ? null : edited(job.toml, job.changes);
  if (toml == null) return null;
  const response = open({ toml, source: job.source });
  if (!response.ok) return null;
  const values = new Map(response.keys.map(({ path, value, given }) => [path, given ? value : null]));
  return Object.entries(job.changes).every(([path, value]) => sameValue(values.get(path) ?? null, value)) ? response : null;
}

/** Returns the opened design of a job, or the error. */
function designOf(job) {
  const base = open(job);
  if (!base.ok || !job.changes) return base;
  const inPlace = rewritten(job);
  if (inPlace) return inPlace;
  const changed = ask({ ask: "set", design: base.design, changes: job.changes, adapt: Boolean(job.adapt) });
  if (changed.ok) keep(`${job.source}\n${changed.toml}`, changed);
  return changed;
}

function run(job) {
  if (job.toml == null) return { answers: job.asks.map(ask) };
  const design = designOf(job);
  if (!design.ok) return { error: design };
  return { design, answers: job.asks.map((request) => ask({ ...request, design: design.design })) };
}

const waiting = [];
let isAtWork = false;

/** Lets the worker receive messages that arrived in the meantime. */
function breath() {
  const { port1, port2 } = new MessageChannel();
  return new Promise((resolve) => {
    port1.onmessage = () => (port1.close(), resolve());
    port2.postMessage(null);
  });
}

/**
 * Does one step of a job.
 * \return true if further steps remain
 */
function work(job) {
  const result = run(job);
  const answer = job.long && !result.error ? result.answers[0] : null;
  const isMore = Boolean(answer && answer.ok && !answer.complete);
  if (isMore) job.asks[0].directions = job.asks[0].directions.slice(answer.points.length);
  self.postMessage({ id: job.id, ...result, isMore });
  return isMore;
}

async function workOn() {
  if (isAtWork) return;
  isAtWork = true;
  for (; waiting.length > 0; await breath()) {
    const job = waiting.shift();
    try {
      if (work(job)) waiting.push(job);
    } catch (fault) {
      self.postMessage({ id: job.id, fault: String(fault && fault.message ? fault.message : fault) });
    }
  }
  isAtWork = false;
}

async function start(wasm) {
  try {
    call = await self.retraceEngine(wasm);
    self.postMessage({ ready: true });
  } catch (fault) {
    self.postMessage({ fault: String(fault && fault.message ? fault.message : fault) });
  }
}

self.onmessage = ({ data }) => {
  const isOther = (job) => job.id !== data.withdrawn;
  if (data.wasm) start(data.wasm);
  else if (data.withdrawn != null) waiting.splice(0, waiting.length, ...waiting.filter(isOther));
  else {
    if (data.urgent) waiting.unshift(data);
    else waiting.push(data);
    workOn();
  }
};
