// Runs in the folder of a program: the connection of VS Code's client library goes through requests of `glisten lsp`, and the panel's
// page is made.
import assert from "node:assert";
import { spawn } from "node:child_process";
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { pathToFileURL } from "node:url";

const require = createRequire(import.meta.url);
const rpc = require("vscode-jsonrpc/node");
const protocol = require("vscode-languageserver-protocol");
const { page } = require("./page");

const server = spawn("glisten", ["lsp", "--stdio"], { stdio: ["pipe", "pipe", "inherit"] });
const connection = rpc.createMessageConnection(
  new rpc.StreamMessageReader(server.stdout),
  new rpc.StreamMessageWriter(server.stdin)
);
const told = new Map();
let wake = () => {};
connection.onNotification(protocol.PublishDiagnosticsNotification.type, (params) => {
  told.set(params.uri, params.diagnostics);
  wake();
});
connection.onRequest("client/registerCapability", () => null);
connection.listen();

const uri = (name) => pathToFileURL(name).href;
const text = (name) => readFileSync(name, "utf8");
const capabilities = { workspace: { didChangeWatchedFiles: { dynamicRegistration: true } } };
const answer = await connection.sendRequest(protocol.InitializeRequest.type, {
  processId: process.pid,
  rootUri: uri("."),
  capabilities,
});
await connection.sendNotification(protocol.InitializedNotification.type, {});
for (const name of ["a.vert", "a.frag"]) {
  const textDocument = { uri: uri(name), languageId: "glsl", version: 1, text: text(name) };
  await connection.sendNotification(protocol.DidOpenTextDocumentNotification.type, { textDocument });
}
while (!(told.get(uri("a.frag")) || []).some((one) => one.code === "E0703")) {
  await new Promise((resolve, reject) => {
    wake = resolve;
    setTimeout(() => reject(new Error("no finding over both stages")), 20000).unref();
  });
}
const vertex = text("a.vert");
const before = vertex.slice(0, vertex.indexOf("shade ="));
const position = { line: before.split("\n").length - 1, character: before.split("\n").pop().length };
const textDocument = { uri: uri("a.vert") };
const hover = await connection.sendRequest(protocol.HoverRequest.type, { textDocument, position });
assert(hover.contents.value.includes("vec3 shade"), JSON.stringify(hover));
const renamed = await connection.sendRequest(protocol.RenameRequest.type, { textDocument, position, newName: "tint" });
assert.equal(Object.keys(renamed.changes || {}).length, 2);
assert(answer.capabilities.executeCommandProvider.commands.includes("glisten.picture"));
const refused = connection.sendRequest("workspace/executeCommand", { command: "glisten.translation", arguments: [uri("a.frag"), "wgsl"] });
await assert.rejects(refused, /errors/);
// With stages that agree there is WGSL.
const change = { textDocument: { uri: uri("a.frag"), version: 2 }, contentChanges: [{ text: text("a.frag").replace("in vec4 shade", "in vec3 shade").replace("= shade", "= vec4(shade, 1.0)") }] };
await connection.sendNotification(protocol.DidChangeTextDocumentNotification.type, change);
const stages = await connection.sendRequest("workspace/executeCommand", { command: "glisten.translation", arguments: [uri("a.frag"), "wgsl"] });
assert(stages.some((one) => one.text.includes("@fragment")));
const html = page({ uri: uri("a.frag"), picture: {}, stages: { result: stages }, findings: told.get(uri("a.frag")) });
assert(html.includes("@fragment") && !html.includes("<script"));
await connection.sendRequest(protocol.ShutdownRequest.type);
await connection.sendNotification(protocol.ExitNotification.type);
const code = await new Promise((resolve) => server.on("exit", resolve));
assert.equal(code, 0);
console.log("VS Code's client library: all done");
