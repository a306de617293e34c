// What the bundle offers to the page: `retraceEngine(wasm)` takes the bytes of engine.wasm and returns a promise of a
// function from requests to answers, both JSON texts.
function retraceEngine(wasm) {
  return makeRetrace({ wasmBinary: wasm, print() {}, printErr() {} }).then((engine) => {
    const call = engine.cwrap("retrace_call", "string", ["string"]);
    return call;
  });
}
if (typeof module !== "undefined") module.exports = { retraceEngine };
