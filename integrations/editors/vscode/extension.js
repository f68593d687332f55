// Starts `glisten lsp` for GLSL documents.
const vscode = require("vscode");
const { LanguageClient, TransportKind } = require("vscode-languageclient/node");

let client;

async function start() {
  const settings = vscode.workspace.getConfiguration("glisten");
  const command = settings.get("path") || "glisten";
  const args = ["lsp", ...(settings.get("arguments") || [])];
  const server = { command, args, transport: TransportKind.stdio };
  const options = { documentSelector: [{ language: "glsl" }] };
  client = new LanguageClient("glisten", "glisten", { run: server, debug: server }, options);
  await client.start();
}

async function restart() {
  if (client) {
    await client.stop();
  }
  await start();
}

function activate(context) {
  context.subscriptions.push(vscode.commands.registerCommand("glisten.restart", restart));
  context.subscriptions.push(
    vscode.workspace.onDidChangeConfiguration((event) => event.affectsConfiguration("glisten") && restart())
  );
  return start();
}

function deactivate() {
  return client ? client.stop() : undefined;
}

module.exports = { activate, deactivate };
