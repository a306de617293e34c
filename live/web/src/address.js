// Stores the complete state as packed JSON after the "#" of the address, so that a link contains the exact design.

const PACKED = "#z"; // prefix of compressed state
const PLAIN = "#j"; // prefix of uncompressed state, if the browser cannot compress

function toBase64(bytes) {
  let text = "";
  for (let k = 0; k < bytes.length; k += 0x8000) text += String.fromCharCode(...bytes.subarray(k, k + 0x8000));
  return btoa(text).replaceAll("+", "-").replaceAll("/", "_").replace(/=+$/, "");
}

function fromBase64(text) {
  return Uint8Array.from(atob(text.replaceAll("-", "+").replaceAll("_", "/")), (c) => c.charCodeAt(0));
}

async function through(bytes, stream) {
  return new Uint8Array(await new Response(new Blob([bytes]).stream().pipeThrough(stream)).arrayBuffer());
}

export async function packed(state) {
  const bytes = new TextEncoder().encode(JSON.stringify(state));
  if (!window.CompressionStream) return PLAIN + toBase64(bytes);
  return PACKED + toBase64(await through(bytes, new CompressionStream("deflate-raw")));
}

/** Returns the state in an address, or null if there is none or it cannot be read. */
export async function unpacked(hash) {
  try {
    const bytes = fromBase64(hash.slice(2));
    if (hash.startsWith(PLAIN)) return JSON.parse(new TextDecoder().decode(bytes));
    if (!hash.startsWith(PACKED)) return null;
    return JSON.parse(new TextDecoder().decode(await through(bytes, new DecompressionStream("deflate-raw"))));
  } catch (error) {
    return null;
  }
}
