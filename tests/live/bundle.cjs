// Runs the checked-in engine of the live page under Node.js. Like the native program retrace_live, it reads one request
// per line from standard input and writes one answer per line to standard output.
//     node bundle.cjs FOLDER
const { readFileSync } = require("node:fs");
const { join, resolve } = require("node:path");
const { createInterface } = require("node:readline");
const { gunzipSync } = require("node:zlib");

const folder = resolve(process.argv[2]);
const { retraceEngine } = require(join(folder, "engine.js"));

retraceEngine(gunzipSync(readFileSync(join(folder, "engine.wasm.gz")))).then((call) => {
  createInterface({ input: process.stdin, terminal: false }).on("line", (request) => {
    process.stdout.write(`${call(request)}\n`);
  });
});
