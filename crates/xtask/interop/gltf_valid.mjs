// Holds copies of models against the official validator, the npm package `gltf-validator`.
//
//     node crates/xtask/interop/gltf_valid.mjs FOLDER_OF_PACKAGES ORIGINAL=COPY...
//
// A copy must have no issue that its original did not have, and nothing about tangent spaces. Prints a sentence for each fault,
// and ends with 1 if there is any.

import fs from "node:fs";
import { createRequire } from "node:module";
import path from "node:path";

const [packages, ...pairs] = process.argv.slice(2);
const validator = createRequire(path.join(path.resolve(packages), "package.json"))("gltf-validator");

/** Codes of the issues of a file, without remarks on what nothing uses. */
async function codes(file) {
  const external = (uri) => fs.promises.readFile(path.join(path.dirname(file), decodeURIComponent(uri)));
  const report = await validator.validateBytes(new Uint8Array(fs.readFileSync(file)), {
    uri: path.basename(file),
    maxIssues: 0,
    externalResourceFunction: async (uri) => new Uint8Array(await external(uri)),
  });
  return new Map(report.issues.messages.filter((issue) => issue.severity <= 1).map((issue) => [issue.code, issue.message]));
}

let faults = 0;
for (const pair of pairs) {
  const [original, copy] = pair.split("=");
  const [before, now] = [await codes(original), await codes(copy)];
  for (const [code, message] of now) {
    if (!before.has(code) || code.includes("TANGENT_SPACE")) {
      faults += 1;
      console.log(`${copy}: ${code}: ${message}`);
    }
  }
}
console.log(`${pairs.length} copies of models: ${faults === 0 ? "good" : `${faults} faults`}`);
process.exit(faults === 0 ? 0 : 1);
