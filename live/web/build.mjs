// Bundles src/ with the packages and the shared scripts of report/page/web into data/live_page/. tools/live_page runs it.
import { createHash } from "node:crypto";
import { mkdirSync, readFileSync, readdirSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { dirname, join, relative } from "node:path";
import { fileURLToPath } from "node:url";

const here = dirname(fileURLToPath(import.meta.url));
const root = join(here, "../..");
const report = join(root, "report/page/web");
const out = join(root, "data/live_page");
const { build } = createRequire(join(report, "package.json"))("esbuild");

function filesOf(folder) {
  return readdirSync(folder, { withFileTypes: true }).flatMap((entry) =>
    entry.isDirectory() ? filesOf(join(folder, entry.name)) : [join(folder, entry.name)],
  );
}

/** Returns a hash of the bundle's source files, sorted by name. A test computes the same hash. */
function sourceHash() {
  const shared = ["package.json", "package-lock.json"].map((name) => join(report, name));
  const files = [...filesOf(join(here, "src")), join(here, "build.mjs"), ...shared, ...filesOf(join(report, "src"))];
  const hash = createHash("sha256");
  for (const name of files.map((file) => relative(root, file)).sort())
    hash.update(`${name}\n`).update(readFileSync(join(root, name)));
  return hash.digest("hex");
}

const common = { nodePaths: [join(report, "node_modules")], bundle: true, minify: true, legalComments: "none", write: false, target: ["es2020"], charset: "ascii" };
const textOf = async (options) => (await build({ ...common, ...options })).outputFiles[0].text;
// The script of the worker is stored as a text in the script of the page.
const worker = await textOf({ entryPoints: [join(here, "src/worker.js")], format: "iife" });
const script = await textOf({ entryPoints: [join(here, "src/main.js")], format: "iife", define: { WORKER_SCRIPT: JSON.stringify(worker) } });
const style = await textOf({ entryPoints: [join(here, "src/live.css")] });

mkdirSync(out, { recursive: true });
const head = `/* sources ${sourceHash()} - made by tools/live_page; licences: LICENCES.txt */\n`;
// "</script" in a text of the bundle would end the HTML element that contains the bundle.
writeFileSync(join(out, "page.js"), head + script.replaceAll("</script", "<\\/script"));
writeFileSync(join(out, "page.css"), head + style);
writeFileSync(join(out, "page.html"), readFileSync(join(here, "src/page.html"), "utf8"));
writeFileSync(join(out, "LICENCES.txt"), readFileSync(join(root, "data/report_page/LICENCES.txt"), "utf8"));
