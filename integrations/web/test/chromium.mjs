// Chromium's WebGPU as a judge of programs: each becomes a pipeline by what its reflection says, and draws once.

import { createServer } from "node:http";
import { existsSync } from "node:fs";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { root } from "./package.mjs";

/** What runs in the page: the adapter's name, or null; later, the complaint about a program, or null. */
const inPage = () => {
  const VISIBLE = { vertex: 1, fragment: 2 };
  let device = null;
  window.begin = async () => {
    const adapter = await navigator.gpu?.requestAdapter();
    if (!adapter) return null;
    device = await adapter.requestDevice({ requiredLimits: { maxSampledTexturesPerShaderStage: adapter.limits.maxSampledTexturesPerShaderStage } });
    const { vendor, architecture, description } = adapter.info;
    return description || `${vendor} ${architecture}`.trim() || "a GPU";
  };
  // The layout of the bind groups, and resources that fit it.
  const groupsOf = (reflection) => {
    const groups = [];
    const add = (at, entry, resource) => {
      while (groups.length <= at.group) groups.push([]);
      groups[at.group].push({ entry: { binding: at.binding, ...entry }, resource });
    };
    const seen = (one) => one.visibility.reduce((sum, stage) => sum | VISIBLE[stage], 0);
    for (const block of [reflection.loose_block, ...reflection.blocks].filter(Boolean)) {
      const buffer = device.createBuffer({ size: Math.ceil(block.size / 16) * 16, usage: GPUBufferUsage.UNIFORM });
      const elements = block.array_size ?? 1;
      for (let index = 0; index < elements; index += 1) add({ group: block.group, binding: block.binding + index }, { visibility: seen(block), buffer: { type: "uniform", minBindingSize: block.size } }, { buffer });
    }
    for (const one of reflection.samplers) {
      const depth = one.sample_type === "depth";
      const format = { sint: "rgba32sint", uint: "rgba32uint", depth: "depth32float" }[one.sample_type] ?? "rgba8unorm";
      const dimension = one.view_dimension === "1d" || one.view_dimension === "3d" ? one.view_dimension : "2d";
      const layers = one.view_dimension.startsWith("cube") ? 6 : 1;
      const usage = GPUTextureUsage.TEXTURE_BINDING | (one.multisampled ? GPUTextureUsage.RENDER_ATTACHMENT : 0);
      const texture = device.createTexture({ format, dimension, size: [4, dimension === "1d" ? 1 : 4, layers], usage, sampleCount: one.multisampled ? 4 : 1 });
      const view = texture.createView({ dimension: one.view_dimension, aspect: depth ? "depth-only" : "all" });
      if (one.texture) add(one.texture, { visibility: seen(one), texture: { sampleType: one.sample_type, viewDimension: one.view_dimension, multisampled: one.multisampled } }, view);
      if (one.sampler) add(one.sampler, { visibility: seen(one), sampler: { type: one.sampler_type } }, device.createSampler(one.sampler_type === "comparison" ? { compare: "less" } : {}));
    }
    const layouts = groups.map((of) => device.createBindGroupLayout({ entries: of.map(({ entry }) => entry) }));
    const groupOf = (of, index) => device.createBindGroup({ layout: layouts[index], entries: of.map(({ entry, resource }) => ({ binding: entry.binding, resource })) });
    return { layouts, groups: groups.map(groupOf) };
  };
  window.complaintAbout = async ({ vertex, fragment, reflection }) => {
    device.pushErrorScope("validation");
    const modules = [vertex, fragment].filter(Boolean).map((code) => device.createShaderModule({ code }));
    for (const module of modules) {
      const error = (await module.getCompilationInfo()).messages.find((one) => one.type === "error");
      if (error) { await device.popErrorScope(); return error.message; }
    }
    let drawn = false;
    if (vertex && fragment) {
      const { layouts, groups } = groupsOf(reflection);
      const attributes = reflection.attributes.flatMap((one) => Array.from({ length: one.columns }, (_, column) => ({ format: one.format, shaderLocation: one.location + column, offset: 0 })));
      // A pipeline has no target for an output that no line writes: the code has none then.
      const outputs = /\bfn main\([^]*?\)\s*->/.test(fragment) ? reflection.outputs.filter((one) => one.index === 0) : [];
      const kind = (type) => (type.startsWith("i") ? "rgba32sint" : type.startsWith("u") ? "rgba32uint" : "rgba8unorm");
      const targets = Array.from({ length: Math.max(0, ...outputs.map((one) => one.location + 1)) }, (_, location) => {
        const own = outputs.find((one) => one.location === location);
        return own ? { format: kind(own.type) } : null;
      });
      const pipeline = device.createRenderPipeline({
        layout: device.createPipelineLayout({ bindGroupLayouts: layouts }),
        vertex: { module: modules[0], buffers: attributes.map((one) => ({ arrayStride: 16, attributes: [one] })) },
        fragment: { module: modules[1], targets },
        depthStencil: { format: "depth32float", depthWriteEnabled: true, depthCompare: "always" },
      });
      const depth = device.createTexture({ format: "depth32float", size: [8, 8], usage: GPUTextureUsage.RENDER_ATTACHMENT }).createView();
      const views = targets.map((target) => target && device.createTexture({ format: target.format, size: [8, 8], usage: GPUTextureUsage.RENDER_ATTACHMENT }).createView());
      const encoder = device.createCommandEncoder();
      const pass = encoder.beginRenderPass({
        colorAttachments: views.map((view) => view && { view, loadOp: "clear", storeOp: "store" }),
        depthStencilAttachment: { view: depth, depthLoadOp: "clear", depthClearValue: 1, depthStoreOp: "store" },
      });
      pass.setPipeline(pipeline);
      groups.forEach((group, index) => pass.setBindGroup(index, group));
      const vertices = device.createBuffer({ size: 64, usage: GPUBufferUsage.VERTEX });
      attributes.forEach((_, index) => pass.setVertexBuffer(index, vertices));
      pass.draw(3);
      pass.end();
      device.queue.submit([encoder.finish()]);
      drawn = true;
    }
    const error = await device.popErrorScope();
    return error ? error.message : drawn ? "" : null;
  };
};

/**
 * A browser that judges programs; null where there is none, or none with WebGPU. `complaint` gives what it complains about, an empty text for what
 * it has drawn, and null for a lone stage that it accepts.
 */
export async function opened() {
  const executablePath = "/usr/bin/chromium";
  const module = join(root, "target/browser/node_modules/playwright-core/index.mjs");
  if (!existsSync(executablePath) || !existsSync(module)) return null;
  const { chromium } = await import(pathToFileURL(module).href);
  // Only pages of a server have WebGPU.
  const server = createServer((_, response) => { response.writeHead(200, { "Content-Type": "text/html" }).end("<!doctype html><title>judge</title>"); });
  await new Promise((listening) => { server.listen(0, "127.0.0.1", listening); });
  // SwiftShader draws by WebGPU without a GPU.
  const browser = await chromium.launch({ executablePath, args: ["--no-sandbox", "--enable-unsafe-webgpu", "--use-webgpu-adapter=swiftshader"] });
  const close = async () => { await browser.close(); server.close(); };
  const page = await browser.newPage();
  await page.addInitScript(inPage);
  await page.goto(`http://127.0.0.1:${server.address().port}/`);
  const adapter = await page.evaluate(() => window.begin());
  if (adapter === null) { await close(); return null; }
  return { name: `Chromium ${browser.version()}, ${adapter}`, close, complaint: (program) => page.evaluate((program) => window.complaintAbout(program), program) };
}
