// Interface of the bundle for the page. `retraceEngine(wasm)` takes the bytes of engine.wasm. It returns a promise of a
// function that maps requests to answers; both are JSON texts.
function retraceEngine(wasm) {
  return makeRetrace({ wasmBinary: wasm, print() {}, printErr() {} }).then((engine) => {
    const call = engine.cwrap("retrace_call", "string", ["string"]);
    return call;
  });
}
if (typeof module !== "undefined") module.exports = { retraceEngine };
