
// ---- Drawing by the browser's WebGPU: a plan of glisten, whose parts are the dictionaries of the specification.
const DEPTH_BY_DRAWING = `
@group(0) @binding(0) var source: texture_2d<f32>;
@vertex fn cover(@builtin(vertex_index) index: u32) -> @builtin(position) vec4<f32> {
    return vec4<f32>(vec2<f32>(f32(index & 1u), f32(index >> 1u)) * 4.0 - 1.0, 0.0, 1.0);
}
@fragment fn depth(@builtin(position) place: vec4<f32>) -> @builtin(frag_depth) f32 {
    return textureLoad(source, vec2<i32>(place.xy), 0).r;
}`;
// What scenes may need beyond what every WebGPU has.
const FEATURES = ["depth32float-stencil8", "float32-filterable", "float32-blendable"];
const LIMITS = ["maxSampledTexturesPerShaderStage", "maxSamplersPerShaderStage", "maxUniformBuffersPerShaderStage", "maxInterStageShaderVariables", "maxUniformBufferBindingSize", "maxBufferSize", "maxColorAttachmentBytesPerSample", "maxTextureDimension2D"];

// The browser's GPU; null if it has none.
const openGpu = async () => {
  const adapter = await navigator.gpu?.requestAdapter();
  if (!adapter) return null;
  const features = FEATURES.filter((feature) => adapter.features.has(feature));
  const limits = Object.fromEntries(LIMITS.filter((limit) => adapter.limits[limit] !== undefined).map((limit) => [limit, adapter.limits[limit]]));
  const device = await adapter.requestDevice({ requiredFeatures: features, requiredLimits: limits });
  const { vendor, architecture, device: model, description } = adapter.info ?? {};
  const gpu = { device, features: new Set(features), name: description || [vendor, architecture, model].filter(Boolean).join(" ") || "a GPU", isLost: false, pipelines: new Map() };
  device.lost.then(() => { gpu.isLost = true; });
  return gpu;
};

// The window positions between which a GPU interpolates, measured: each triangle's vertices have their own position as a varying, whose value
// at the center of a pixel is that center, but for what the positions lost. No limit of WebGPU tells it.
const PROBE = `
struct Out { @builtin(position) place: vec4<f32>, @location(0) at: vec2<f32> }
@vertex fn corner(@location(0) at: vec2<f32>) -> Out {
    return Out(vec4<f32>(at.x / 32.0 - 1.0, 1.0 - at.y / 32.0, 0.0, 1.0), at);
}
@fragment fn shift(in: Out) -> @location(0) vec4<f32> {
    return vec4<f32>(abs(in.at - in.place.xy), 1.0, 1.0);
}`;
const measurePositions = async (gpu) => {
  const { device } = gpu;
  const [side, cell] = [64, 8];
  // A sequence without a pattern at any power of two.
  let state = 1;
  const random = () => { state = (state * 48271) % 2147483647; return state / 2147483647; };
  const corners = [];
  for (let y = 0; y < side; y += cell) for (let x = 0; x < side; x += cell) for (const [u, v] of [[0, 0], [7, 0], [0, 7]]) corners.push(x + u + random(), y + v + random());
  const vertices = device.createBuffer({ size: corners.length * 4, usage: GPUBufferUsage.VERTEX | GPUBufferUsage.COPY_DST });
  device.queue.writeBuffer(vertices, 0, new Float32Array(corners));
  const module = device.createShaderModule({ code: PROBE });
  const pipeline = device.createRenderPipeline({
    layout: "auto", fragment: { module, targets: [{ format: "rgba32float" }] },
    vertex: { module, buffers: [{ arrayStride: 8, attributes: [{ format: "float32x2", offset: 0, shaderLocation: 0 }] }] },
  });
  const texture = device.createTexture({ format: "rgba32float", size: [side, side], usage: GPUTextureUsage.RENDER_ATTACHMENT | GPUTextureUsage.COPY_SRC });
  const reader = device.createBuffer({ size: side * side * 16, usage: GPUBufferUsage.MAP_READ | GPUBufferUsage.COPY_DST });
  const encoder = device.createCommandEncoder();
  const pass = encoder.beginRenderPass({ colorAttachments: [{ view: texture.createView(), clearValue: { r: 0, g: 0, b: 0, a: 0 }, loadOp: "clear", storeOp: "store" }] });
  pass.setPipeline(pipeline);
  pass.setVertexBuffer(0, vertices);
  pass.draw(corners.length / 2);
  pass.end();
  encoder.copyTextureToBuffer({ texture }, { buffer: reader, bytesPerRow: side * 16, rowsPerImage: side }, [side, side]);
  device.queue.submit([encoder.finish()]);
  await reader.mapAsync(GPUMapMode.READ);
  const found = new Float32Array(reader.getMappedRange());
  let most = 0;
  for (let at = 0; at < found.length; at += 4) if (found[at + 3] === 1) most = Math.max(most, found[at], found[at + 1]);
  reader.destroy();
  // Floats have no steps; what their edges have is not measured, and conforming ones have at least four bits.
  if (most < 2 ** -11) return { bits: 4, exact: true };
  // The nearest step is off by half of it.
  return { bits: Math.max(4, Math.min(8, Math.floor(-Math.log2(2 * most)))), exact: false };
};

// Copies bytes of rows that need not be at multiples of 256, and reads them back so.
const ROW = 256;
const padded = (length) => Math.ceil(length / ROW) * ROW;

const drawByWebGpu = async (gpu, calls, bytes) => {
  const { device, features } = gpu;
  const part = ([offset, length]) => bytes.subarray(offset, offset + length);
  const depthFormat = features.has("depth32float-stencil8") ? "depth32float-stencil8" : "depth24plus-stencil8";
  // What this picture alone needs is given back when it is read.
  const owned = [];
  const own = (resource) => { owned.push(resource); return resource; };
  const buffer = (content, usage) => {
    const size = Math.max(16, Math.ceil(content.length / 4) * 4);
    const made = own(device.createBuffer({ size, usage: usage | GPUBufferUsage.COPY_DST }));
    const whole = new Uint8Array(size);
    whole.set(content);
    device.queue.writeBuffer(made, 0, whole);
    return made;
  };
  const textures = new Map();  // the levels of a texture are uploaded once
  const uploaded = (bound) => {
    const key = JSON.stringify([bound.format, bound.viewDimension, bound.levels.map((level) => level.bytes)]);
    if (!textures.has(key)) textures.set(key, own(bound.isDepth ? depthTexture(bound) : colorTexture(bound)));
    return textures.get(key);
  };
  const colorTexture = ({ format, dimension, size, levels }) => {
    const texture = device.createTexture({ format, dimension, size, mipLevelCount: Math.max(1, levels.length), usage: GPUTextureUsage.TEXTURE_BINDING | GPUTextureUsage.COPY_DST });
    levels.forEach(({ size, bytes }, mipLevel) => device.queue.writeTexture({ texture, mipLevel }, part(bytes), { bytesPerRow: size[0] * 16, rowsPerImage: size[1] }, size));
    return texture;
  };
  const depthTexture = ({ format, size, levels }) => {
    const texture = device.createTexture({ format, size, mipLevelCount: Math.max(1, levels.length), usage: GPUTextureUsage.TEXTURE_BINDING | GPUTextureUsage.RENDER_ATTACHMENT });
    const module = device.createShaderModule({ code: DEPTH_BY_DRAWING });
    const pipeline = device.createRenderPipeline({
      layout: "auto", vertex: { module }, fragment: { module, targets: [] },
      depthStencil: { format, depthWriteEnabled: true, depthCompare: "always" },
    });
    const encoder = device.createCommandEncoder();
    levels.forEach(({ size: [width, height, layers], bytes }, baseMipLevel) => {
      const all = part(bytes);
      for (let layer = 0; layer < layers; layer += 1) {
        const source = device.createTexture({ format: "r32float", size: [width, height], usage: GPUTextureUsage.TEXTURE_BINDING | GPUTextureUsage.COPY_DST });
        const length = width * height * 4;
        device.queue.writeTexture({ texture: source }, all.subarray(layer * length, (layer + 1) * length), { bytesPerRow: width * 4, rowsPerImage: height }, [width, height]);
        const view = texture.createView({ dimension: "2d", baseMipLevel, mipLevelCount: 1, baseArrayLayer: layer, arrayLayerCount: 1 });
        const pass = encoder.beginRenderPass({ colorAttachments: [], depthStencilAttachment: { view, depthClearValue: 0, depthLoadOp: "clear", depthStoreOp: "store" } });
        pass.setPipeline(pipeline);
        pass.setBindGroup(0, device.createBindGroup({ layout: pipeline.getBindGroupLayout(0), entries: [{ binding: 0, resource: source.createView() }] }));
        pass.draw(3);
        pass.end();
      }
    });
    device.queue.submit([encoder.finish()]);
    return texture;
  };
  const resource = (entry) => {
    if (entry.buffer) return { buffer: buffer(part(entry.bound), GPUBufferUsage.UNIFORM) };
    if (entry.sampler) return device.createSampler(entry.bound);
    return uploaded(entry.bound).createView({ dimension: entry.bound.viewDimension });
  };
  // While numbers of a scene change, its programs stay: pipelines are kept by all that they are made of.
  const built = new Map();
  const pipelineOf = (draw) => {
    const entries = draw.groups.map((group) => group.map(({ bound, ...entry }) => entry));
    const buffers = draw.buffers.map(({ bytes, ...layout }) => layout);
    const key = JSON.stringify([draw.vertex, draw.fragment, entries, buffers, draw.primitive, draw.depthStencil, draw.targets]);
    const kept = gpu.pipelines.get(key) ?? built.get(key);
    if (kept) return kept;
    const layouts = entries.map((entries) => device.createBindGroupLayout({ entries }));
    const { cullMode, ...primitive } = draw.primitive;
    const pipeline = device.createRenderPipeline({
      layout: device.createPipelineLayout({ bindGroupLayouts: layouts }),
      vertex: { module: device.createShaderModule({ code: draw.vertex }), buffers },
      primitive: { ...primitive, cullMode },
      depthStencil: { ...draw.depthStencil, format: depthFormat },
      fragment: { module: device.createShaderModule({ code: draw.fragment }), targets: draw.targets },
    });
    built.set(key, { layouts, pipeline });
    return { layouts, pipeline };
  };
  const prepared = (draw) => {
    const { layouts, pipeline } = pipelineOf(draw);
    const groups = draw.groups.map((entries, index) => device.createBindGroup({ layout: layouts[index], entries: entries.map((entry) => ({ binding: entry.binding, resource: resource(entry) })) }));
    return {
      ...draw, pipeline, groups,
      vertices: draw.buffers.map(({ bytes }) => buffer(part(bytes), GPUBufferUsage.VERTEX)),
      order: draw.indices ? buffer(part(draw.indices), GPUBufferUsage.INDEX) : null,
    };
  };

  const scopes = ["validation", "out-of-memory", "internal"];
  scopes.forEach((scope) => device.pushErrorScope(scope));
  const failures = [];
  const readers = [];
  try {
    const { width, height, format, clear: [r, g, b, a] } = calls;
    const attachment = (format) => own(device.createTexture({ format, size: [width, height], usage: GPUTextureUsage.RENDER_ATTACHMENT | GPUTextureUsage.COPY_SRC }));
    const colors = Array.from({ length: calls.attachments }, () => attachment(format));
    const depth = attachment(depthFormat);
    const draws = calls.draws.map(prepared);
    const encoder = device.createCommandEncoder();
    const pass = encoder.beginRenderPass({
      colorAttachments: colors.map((texture) => ({ view: texture.createView(), clearValue: { r, g, b, a }, loadOp: "clear", storeOp: "store" })),
      depthStencilAttachment: { view: depth.createView(), depthClearValue: 1, depthLoadOp: "clear", depthStoreOp: "store", stencilClearValue: 0, stencilLoadOp: "clear", stencilStoreOp: "store" },
    });
    pass.setStencilReference(1);
    for (const draw of draws) {
      pass.setPipeline(draw.pipeline);
      if (draw.blendConstant) pass.setBlendConstant(draw.blendConstant);
      draw.groups.forEach((group, index) => pass.setBindGroup(index, group));
      draw.vertices.forEach((vertices, index) => pass.setVertexBuffer(index, vertices));
      if (draw.order) {
        pass.setIndexBuffer(draw.order, "uint32");
        pass.drawIndexed(draw.count, draw.instances);
      } else pass.draw(draw.count, draw.instances);
    }
    pass.end();
    const planes = [...colors.map((texture) => [{ texture }, calls.pixelSize]), [{ texture: depth, aspect: "stencil-only" }, 1]];
    for (const [source, pixel] of planes) {
      const bytesPerRow = padded(width * pixel);
      const reader = device.createBuffer({ size: bytesPerRow * height, usage: GPUBufferUsage.MAP_READ | GPUBufferUsage.COPY_DST });
      encoder.copyTextureToBuffer(source, { buffer: reader, bytesPerRow, rowsPerImage: height }, [width, height]);
      readers.push({ reader, bytesPerRow, used: width * pixel });
    }
    device.queue.submit([encoder.finish()]);
  } catch (error) {
    failures.push(error.message);
  }
  for (const _ of scopes) {
    const error = await device.popErrorScope();
    if (error) failures.push(error.message);
  }
  if (failures.length) throw new Error(`the browser's WebGPU refuses it: ${failures[0]}`);
  // Those of this picture, and of the scenes before it as long as they are few.
  if (gpu.pipelines.size + built.size > 64) gpu.pipelines.clear();
  built.forEach((pipeline, key) => gpu.pipelines.set(key, pipeline));
  const planes = await Promise.all(readers.map(async ({ reader, bytesPerRow, used }) => {
    await reader.mapAsync(GPUMapMode.READ);
    const all = new Uint8Array(reader.getMappedRange());
    const plane = new Uint8Array(used * calls.height);
    for (let row = 0; row < calls.height; row += 1) plane.set(all.subarray(row * bytesPerRow, row * bytesPerRow + used), row * used);
    reader.destroy();
    return plane;
  }));
  owned.forEach((resource) => resource.destroy());
  return planes;
};
