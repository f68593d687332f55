// The worker of a page that has glisten as a module: it answers jobs, one after the other. The first message is
// { compiled, files, request }: the module, the files of the page by name, and what every request says. Others are { number, job }.

import { Module } from "../package/module.js";

let module = null, request = null, blob = null;

const begin = ({ compiled, files, request: given }) => {
  module = new Module(compiled);
  const places = {}, parts = Object.values(files);
  let length = 0;
  for (const [name, bytes] of Object.entries(files)) {
    places[name] = [length, bytes.length];
    length += bytes.length;
  }
  blob = new Uint8Array(length);
  parts.reduce((at, bytes) => { blob.set(bytes, at); return at + bytes.length; }, 0);
  request = { ...given, call: "play", files: places };
};

onmessage = ({ data }) => {
  if (data.compiled) { begin(data); return; }
  const { number, job } = data;
  const from = performance.now();
  try {
    const ok = module.call({ ...request, job }, blob).answer;
    if (job.ask === "draw") ok.milliseconds = performance.now() - from;
    postMessage({ number, ok });
  } catch (error) {
    postMessage({ number, error: error.message });
  }
};
