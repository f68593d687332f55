// Starts `glisten lsp` for GLSL, and for the shaders in the strings of other languages.
const vscode = require("vscode");
const { LanguageClient, TransportKind } = require("vscode-languageclient/node");
const { Panel } = require("./panel");

const HOSTS = ["javascript", "javascriptreact", "typescript", "typescriptreact", "vue", "svelte", "rust", "python", "c", "cpp"];

let client;

function settings() {
  return vscode.workspace.getConfiguration("glisten");
}

async function start() {
  const command = settings().get("path") || "glisten";
  const args = ["lsp", ...(settings().get("arguments") || [])];
  const server = { command, args, transport: TransportKind.stdio };
  const languages = ["glsl", ...(settings().get("strings") ? HOSTS : [])];
  const options = { documentSelector: languages.map((language) => ({ language })) };
  client = new LanguageClient("glisten", "glisten", { run: server, debug: server }, options);
  await client.start();
}

async function restart() {
  if (client) {
    await client.stop();
  }
  await start();
}

// Carries out a command of the server.
function request(command, ...args) {
  return client.sendRequest("workspace/executeCommand", { command, arguments: args });
}

// The same; what the server refuses is told.
async function execute(command, ...args) {
  try {
    return await request(command, ...args);
  } catch (error) {
    vscode.window.showInformationMessage(error.message);
    return undefined;
  }
}

function activeUri() {
  const editor = vscode.window.activeTextEditor;
  return editor && editor.document.uri.toString();
}

// Chooses a macro that conditions ask for, and its value.
async function chooseConfiguration() {
  const uri = activeUri();
  const macros = (uri && (await execute("glisten.configurations", uri))) || [];
  if (macros.length === 0) {
    vscode.window.showInformationMessage("No condition of this program asks for a macro that comes from outside.");
    return;
  }
  const told = (value) => (value === null || value === undefined ? "not defined" : `= ${value}`);
  const macro = await vscode.window.showQuickPick(
    macros.map((macro) => ({ label: macro.name, description: told(macro.chosen), macro })),
    { placeHolder: "Macro" }
  );
  const items = macro && macro.macro.values.map((value) => ({ label: told(value), value }));
  const chosen = items && (await vscode.window.showQuickPick(items, { placeHolder: macro.label }));
  if (chosen) {
    await execute("glisten.define", macro.macro.name, chosen.value);
  }
}

// Chooses the file as whose part a header is seen.
async function chooseContext() {
  const uri = activeUri();
  const files = (uri && (await execute("glisten.contexts", uri))) || [];
  const items = files.map((file) => ({ label: vscode.workspace.asRelativePath(vscode.Uri.parse(file)), file }));
  items.unshift({ label: "in all files that include it", file: null });
  const chosen = await vscode.window.showQuickPick(items, { placeHolder: "Show the header as it is in" });
  if (chosen) {
    await execute("glisten.context", uri, chosen.file);
  }
}

function activate(context) {
  const command = (name, run) => context.subscriptions.push(vscode.commands.registerCommand(name, run));
  command("glisten.restart", restart);
  command("glisten.chooseConfiguration", chooseConfiguration);
  command("glisten.chooseContext", chooseContext);
  const panel = new Panel(context, request);
  command("glisten.panel", () => panel.show());
  context.subscriptions.push(
    vscode.workspace.onDidChangeConfiguration((event) => event.affectsConfiguration("glisten") && restart())
  );
  return start();
}

function deactivate() {
  return client ? client.stop() : undefined;
}

module.exports = { activate, deactivate };
