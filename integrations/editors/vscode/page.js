// The page of the panel. It has no script, and shows nothing but what it is given.
const escapes = { "&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;" };

function escaped(text) {
  return String(text).replace(/[&<>"]/g, (letter) => escapes[letter]);
}

function name(uri) {
  return escaped(decodeURIComponent(String(uri).split("/").pop()));
}

// `severity` counts from 0: errors, warnings, notes, hints.
function finding(one) {
  const place = `${one.range.start.line + 1}:${one.range.start.character + 1}`;
  const kind = ["error", "warning", "note"][one.severity];
  return kind ? `<li class="${kind}">${place} ${escaped(one.message)}</li>` : "";
}

function page({ uri, scene, image, picture, stages, findings }) {
  const drawn = image
    ? `<h2>${name(scene)}</h2><img alt="" src="data:image/png;base64,${image}">`
    : `<p>${escaped(picture.error || "no scene draws this program")}</p>`;
  const texts = (stages.result || []).map((one) => `<h2>${escaped(one.stage)} stage</h2><pre>${escaped(one.text)}</pre>`);
  const wgsl = texts.length > 0 ? texts.join("") : `<p>${escaped(stages.error || "nothing to translate")}</p>`;
  const list = findings.map(finding).join("");
  return `<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; img-src data:; style-src 'unsafe-inline'">
<title>glisten</title>
<style>
img { max-width: 100%; image-rendering: pixelated; }
pre { overflow-x: auto; font-family: var(--vscode-editor-font-family); font-size: var(--vscode-editor-font-size); }
li { white-space: pre-wrap; }
.error { color: var(--vscode-editorError-foreground); }
.warning { color: var(--vscode-editorWarning-foreground); }
</style>
</head>
<body>
<h1>${name(uri)}</h1>
${list ? `<ul>${list}</ul>` : "<p>nothing found</p>"}
${drawn}
${wgsl}
</body>
</html>`;
}

module.exports = { page };
