// Validates WGSL files with Tint, through Dawn's null backend (the npm package `webgpu`).
// Usage: node tint.mjs FOLDER_OF_THE_PACKAGE FILE...
// Prints one line of JSON for each file that is refused: {"file", "messages"}; exits 1 if there is one.
import { readFileSync } from 'node:fs';
import { pathToFileURL } from 'node:url';
import { join } from 'node:path';

const [folder, ...files] = process.argv.slice(2);
const { create } = await import(pathToFileURL(join(folder, 'index.js')).href);
const gpu = create(['backend=null']);
const adapter = await gpu.requestAdapter();
const wanted = ['shader-f16', 'clip-distances', 'dual-source-blending', 'primitive-index', 'float32-filterable'];
const requiredFeatures = wanted.filter((feature) => adapter.features.has(feature));
const device = await adapter.requestDevice({ requiredFeatures });

let refused = 0;
for (const file of files) {
  device.pushErrorScope('validation');
  const module = device.createShaderModule({ code: readFileSync(file, 'utf8') });
  const { messages } = await module.getCompilationInfo();
  const error = await device.popErrorScope();
  const errors = messages.filter((message) => message.type === 'error')
    .map((message) => `${message.lineNum}:${message.linePos} ${message.message}`);
  if (error && errors.length === 0) errors.push(error.message);
  if (errors.length > 0) {
    refused += 1;
    console.log(JSON.stringify({ file, messages: errors }));
  }
}
console.log(JSON.stringify({ checked: files.length, refused }));
device.destroy();
process.exit(refused > 0 ? 1 : 0);
