// Bundles src/ with uPlot and three.js into data/report_page/. tools/report_page runs it.
import { createHash } from "node:crypto";
import { mkdirSync, readFileSync, readdirSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { build } from "esbuild";

const here = dirname(fileURLToPath(import.meta.url));
const out = join(here, "../../../data/report_page");

/** Returns a hash of the bundle's source files, sorted by name. A test computes the same hash. */
function sourceHash() {
  const files = ["build.mjs", "package.json", "package-lock.json", ...readdirSync(join(here, "src")).map((f) => `src/${f}`)];
  const hash = createHash("sha256");
  for (const file of files.sort()) hash.update(`${file}\n`).update(readFileSync(join(here, file)));
  return hash.digest("hex");
}

function licence(name) {
  const folder = join(here, "node_modules", name);
  const { version, license } = JSON.parse(readFileSync(join(folder, "package.json"), "utf8"));
  const text = readFileSync(join(folder, "LICENSE"), "utf8").trim();
  return `${name} ${version} (${license})\n\n${text}\n`;
}

mkdirSync(out, { recursive: true });
const common = { bundle: true, minify: true, legalComments: "none", write: false, target: ["es2020"], charset: "ascii" };
const script = await build({ ...common, entryPoints: [join(here, "src/main.js")], format: "iife" });
const style = await build({ ...common, entryPoints: [join(here, "src/page.css")] });
const head = `/* sources ${sourceHash()} - made by tools/report_page; licences: LICENCES.txt */\n`;
// "</script" in a text of the bundle would end the HTML element that contains the bundle.
writeFileSync(join(out, "page.js"), head + script.outputFiles[0].text.replaceAll("</script", "<\\/script"));
writeFileSync(join(out, "page.css"), head + style.outputFiles[0].text);
writeFileSync(join(out, "LICENCES.txt"),
  "page.js and page.css contain code of these projects.\n\n" + ["three", "uplot"].map(licence).join("\n" + "-".repeat(78) + "\n\n"));
