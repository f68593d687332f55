// A panel beside the editor: the picture of a scene that draws the program, its WGSL, and what is found in it.
const vscode = require("vscode");
const { page } = require("./page");

// How long the panel waits after a change.
const WAIT = 300;

class Panel {
  // `request` carries out a command of the server.
  constructor(context, request) {
    this.send = request;
    this.uri = undefined;
    this.turn = 0;
    const changed = (uri) => this.panel && uri && uri.toString() === this.uri && this.later();
    context.subscriptions.push(
      vscode.languages.onDidChangeDiagnostics((event) => event.uris.forEach(changed)),
      vscode.workspace.onDidSaveTextDocument((document) => this.panel && this.later(document)),
      vscode.window.onDidChangeActiveTextEditor((editor) => this.panel && this.follow(editor))
    );
  }

  show() {
    if (!this.panel) {
      const options = { enableScripts: false, localResourceRoots: [] };
      this.panel = vscode.window.createWebviewPanel("glisten", "glisten", vscode.ViewColumn.Beside, options);
      this.panel.onDidDispose(() => (this.panel = undefined));
    }
    this.follow(vscode.window.activeTextEditor);
    this.panel.reveal(undefined, true);
  }

  follow(editor) {
    if (editor && editor.document.uri.scheme === "file") {
      this.uri = editor.document.uri.toString();
      this.later();
    }
  }

  later() {
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.update(), WAIT);
  }

  async update() {
    const turn = ++this.turn;
    const uri = this.uri;
    if (!this.panel || !uri) {
      return;
    }
    const ask = (command, ...args) => this.request(command, args);
    const scenes = (await ask("glisten.scenes", uri)).result || [];
    const stages = await ask("glisten.translation", uri, "wgsl");
    const picture = scenes.length > 0 ? await ask("glisten.picture", scenes[0], false) : {};
    const findings = vscode.languages.getDiagnostics(vscode.Uri.parse(uri)).filter((one) => one.source === "glisten");
    let image;
    if (picture.result) {
      const bytes = await vscode.workspace.fs.readFile(vscode.Uri.parse(picture.result.uri));
      image = Buffer.from(bytes).toString("base64");
    }
    // A later change has its own answer.
    if (this.panel && turn === this.turn) {
      this.panel.webview.html = page({ uri, scene: scenes[0], image, picture, stages, findings });
    }
  }

  async request(command, args) {
    try {
      return { result: await this.send(command, ...args) };
    } catch (error) {
      return { error: error.message };
    }
  }
}

module.exports = { Panel };
