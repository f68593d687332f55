// Validates SARIF against the schema of OASIS: `node sarif.mjs NODE_MODULES FILE...`, a line of JSON for each file.
import { createRequire } from "node:module";
import { readFileSync, readdirSync } from "node:fs";
import { join } from "node:path";

const [modules, ...files] = process.argv.slice(2);
const require = createRequire(join(modules, "none.js"));
const Ajv = require(join(modules, "ajv"));
const folder = join(modules, "@microsoft/jest-sarif/lib/schemas");
const name = readdirSync(folder).find((name) => name.startsWith("sarif-2.1.0"));
const schema = JSON.parse(readFileSync(join(folder, name), "utf8"));
const ajv = new (Ajv.default ?? Ajv)({ allErrors: true, schemaId: "auto", meta: false, unknownFormats: "ignore" });
ajv.addMetaSchema(require(join(modules, "ajv/lib/refs/json-schema-draft-07.json")));
if (String(schema.$schema).includes("draft-04")) {
  ajv.addMetaSchema(require(join(modules, "ajv/lib/refs/json-schema-draft-04.json")));
}
const validate = ajv.compile(schema);
for (const file of files) {
  const valid = validate(JSON.parse(readFileSync(file, "utf8")));
  console.log(JSON.stringify({ file, valid, errors: (validate.errors ?? []).slice(0, 5) }));
}
