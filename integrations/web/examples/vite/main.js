// Draws with WebGPU what two GLSL sources say.

import program from "./triangle.frag?glisten";

const adapter = await navigator.gpu?.requestAdapter();
if (!adapter) {
  document.body.append("This browser has no WebGPU.");
} else {
  const device = await adapter.requestDevice();
  const context = document.querySelector("canvas").getContext("webgpu");
  const format = navigator.gpu.getPreferredCanvasFormat();
  context.configure({ device, format });
  const module = (code) => device.createShaderModule({ code });
  const pipeline = device.createRenderPipeline({
    layout: "auto",
    vertex: { module: module(program.vertex) },
    fragment: { module: module(program.fragment), targets: [{ format }] },
  });
  const { loose_block: block, uniforms } = program.reflection;
  const buffer = device.createBuffer({ size: block.size, usage: GPUBufferUsage.UNIFORM | GPUBufferUsage.COPY_DST });
  const tint = uniforms.find(({ name }) => name === "tint");
  device.queue.writeBuffer(buffer, tint.offset, new Float32Array([1, 0.5, 0.1, 1]));
  const group = device.createBindGroup({
    layout: pipeline.getBindGroupLayout(block.group),
    entries: [{ binding: block.binding, resource: { buffer } }],
  });
  const encoder = device.createCommandEncoder();
  const pass = encoder.beginRenderPass({
    colorAttachments: [{ view: context.getCurrentTexture().createView(), loadOp: "clear", storeOp: "store" }],
  });
  pass.setPipeline(pipeline);
  pass.setBindGroup(block.group, group);
  pass.draw(3);
  pass.end();
  device.queue.submit([encoder.finish()]);
}
