// GLSL that is typed in the page, compiled in the page, and drawn by WebGPU: no server, no bundler.

import { compile, GlistenError, init } from "glisten";

const VERTEX = `#version 150
void main() {
    gl_Position = vec4(vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0), 0.0, 1.0);
}
`;
const source = document.querySelector("#source");
const canvas = document.querySelector("canvas");
const say = (text) => { document.querySelector("#said").textContent = text; };

await init();
const adapter = await navigator.gpu?.requestAdapter();
const device = await adapter?.requestDevice();
const context = device && canvas.getContext("webgpu");
const format = device && navigator.gpu.getPreferredCanvasFormat();
context?.configure({ device, format });

// The pipeline of the text, with what its reflection says of its uniforms.
const build = (text) => {
  const { stages, reflection, diagnostics } = compile([{ name: "screen.vert", text: VERTEX }, { name: "screen.frag", text }]);
  say(diagnostics.map((one) => `${one.line}:${one.column}: ${one.message}`).join("\n"));
  if (!device) return null;
  const module = (code) => device.createShaderModule({ code });
  const pipeline = device.createRenderPipeline({
    layout: "auto",
    vertex: { module: module(stages.vertex.wgsl) },
    fragment: { module: module(stages.fragment.wgsl), targets: [{ format }] },
  });
  // Uniforms outside of blocks are in one block; the height of the framebuffer is in it if `gl_FragCoord` is read.
  const block = reflection.loose_block;
  const buffer = block && device.createBuffer({ size: block.size, usage: GPUBufferUsage.UNIFORM | GPUBufferUsage.COPY_DST });
  const group = block && device.createBindGroup({
    layout: pipeline.getBindGroupLayout(block.group),
    entries: [{ binding: block.binding, resource: { buffer } }],
  });
  const height = reflection.conventions.framebuffer_height;
  const set = (name, values) => {
    const at = reflection.uniforms.find((one) => one.name === name)?.offset;
    if (at !== undefined) device.queue.writeBuffer(buffer, at, new Float32Array(values));
  };
  return { pipeline, block, group, set, setHeight: (value) => { if (height) device.queue.writeBuffer(buffer, height.offset, new Float32Array([value])); } };
};

let now = null;
const rebuild = () => {
  try {
    now = build(source.value);
  } catch (error) {
    // The last picture stays.
    if (!(error instanceof GlistenError)) throw error;
    say(error.diagnostics.map((one) => `${one.line}:${one.column}: ${one.message}${one.help ? `\n  help: ${one.help}` : ""}`).join("\n"));
  }
  if (!device) say("This browser has no WebGPU; errors of the text are told all the same.");
};
const frame = (milliseconds) => {
  if (now) {
    now.set("time", [milliseconds / 1000]);
    now.set("size", [canvas.width, canvas.height]);
    now.setHeight(canvas.height);
    const encoder = device.createCommandEncoder();
    const pass = encoder.beginRenderPass({ colorAttachments: [{ view: context.getCurrentTexture().createView(), loadOp: "clear", storeOp: "store" }] });
    pass.setPipeline(now.pipeline);
    if (now.block) pass.setBindGroup(now.block.group, now.group);
    pass.draw(3);
    pass.end();
    device.queue.submit([encoder.finish()]);
  }
  requestAnimationFrame(frame);
};
source.addEventListener("input", rebuild);
rebuild();
requestAnimationFrame(frame);
document.body.dataset.ready = device ? "webgpu" : "none";
