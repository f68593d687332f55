// The worker of a page that has glisten as a module: it answers jobs, one after the other. The first message is
// { compiled, files, request }: the module, the files of the page by name, and what every request says. Others are { number, job, planes }.

import { Module } from "../package/module.js";

let module = null, request = null, blob = null;

// Bytes one behind the other, and their places from `first` on.
const joined = (parts, first = 0) => {
  const places = parts.map((bytes) => { const place = [first, bytes.length]; first += bytes.length; return place; });
  return { places, length: first };
};
const put = (into, parts, places) => { parts.forEach((bytes, index) => into.set(bytes, places[index][0])); return into; };

const begin = ({ compiled, files, request: given }) => {
  module = new Module(compiled);
  const parts = Object.values(files);
  const { places, length } = joined(parts);
  blob = put(new Uint8Array(length), parts, places);
  request = { ...given, call: "play", files: Object.fromEntries(Object.keys(files).map((name, index) => [name, places[index]])) };
};

// A request with what the browser drew.
const withPlanes = (job, parts) => {
  if (!parts.length) return [{ ...request, job }, blob];
  const { places, length } = joined(parts, blob.length);
  const whole = new Uint8Array(length);
  whole.set(blob);
  return [{ ...request, job, planes: places }, put(whole, parts, places)];
};

onmessage = ({ data }) => {
  if (data.compiled) { begin(data); return; }
  const { number, job, planes } = data;
  const from = performance.now();
  try {
    const reply = module.call(...withPlanes(job, planes));
    const ok = reply.answer, bytes = reply.bytes_of_answer && reply.bytes(reply.bytes_of_answer);
    if (job.ask === "draw") ok.milliseconds = performance.now() - from;
    postMessage({ number, ok, bytes });
  } catch (error) {
    postMessage({ number, error: error.message });
  }
};
