// The checked-in engine of the live page under Node.js: a request a line of standard input, an answer a line of standard
// output, as the native program retrace_live.
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
