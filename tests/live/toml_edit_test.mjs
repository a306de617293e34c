// Tests of changes in the text of a design. A text with former names of tables or keys is not changed here, because the
// engine must convert it.
//
//     node toml_edit_test.mjs SOURCE

import assert from "node:assert/strict";
import { readFileSync, readdirSync } from "node:fs";
import { join } from "node:path";

const SOURCE = process.argv[2];

function textOf(...path) {
  return readFileSync(join(SOURCE, ...path), "utf8");
}

const code = textOf("live", "web", "src", "toml_edit.js");
const { edited } = await import(`data:text/javascript,${encodeURIComponent(code)}`);

const current = "[substrate]\nkind = \"plane\"  # inclined\nincline_deg = 5\n";
assert.equal(edited(current, { "substrate.incline_deg": 7 }), current.replace("5", "7"));
assert.equal(edited("# [base] and front.mesh are former names\n" + current, {}), "# [base] and front.mesh are former names\n" + current);

// The former names of designs are those in the rows and tables of the format.
const rows = readdirSync(join(SOURCE, "design", "io"))
  .filter((name) => /_(rows|format)\.cpp$/.test(name))
  .map((name) => textOf("design", "io", name))
  .concat(textOf("geometry", "io", "substrate_rows.cpp"))
  .join("\n");
const keys = [...rows.matchAll(/renamed\(\s*"(\w+)"/g)].map(([, name]) => name);
const tables = [...rows.matchAll(/\.former = "(\w+)"/g)].map(([, name]) => name);
assert.ok(keys.length > 5 && tables.length > 1);
for (const key of keys)
  for (const text of [`[some]\n${key} = 1\n`, `some.${key} = 1\n`, `[some]\n  "${key}"=1\r\n`]) assert.equal(edited(text, { title: "a" }), null, text);
for (const table of tables)
  for (const text of [`[${table}]\nkind = "plane"\n`, `${table}.kind = "plane"\n`, `title = "b"\n${table} = { kind = "plane" }\n`, `[ ${table} ]\n`])
    assert.equal(edited(text, { title: "a" }), null, text);
