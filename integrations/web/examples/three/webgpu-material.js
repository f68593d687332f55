// A ShaderMaterial of three.js drawn by WebGPU: its GLSL is compiled in the page, and the reflection says where its values go.

import * as THREE from "three";
import { compile } from "glisten";

// The words that three.js puts before each stage of a ShaderMaterial, as far as they are declarations.
const VERTEX = `#version 300 es
#define attribute in
#define varying out
uniform mat4 modelMatrix, modelViewMatrix, projectionMatrix, viewMatrix;
uniform mat3 normalMatrix;
uniform vec3 cameraPosition;
in vec3 position;
in vec3 normal;
in vec2 uv;
`;
const FRAGMENT = `#version 300 es
#define varying in
#define texture2D texture
#define gl_FragColor pc_fragColor
precision highp float;
uniform mat4 viewMatrix;
uniform vec3 cameraPosition;
out vec4 pc_fragColor;
`;
const FLOATS = { float: 1, vec2: 2, vec3: 3, vec4: 4 };

export class WebGpuMaterial {
  constructor(device, canvas, material, geometry) {
    Object.assign(this, { device, material, geometry });
    this.context = canvas.getContext("webgpu");
    const format = navigator.gpu.getPreferredCanvasFormat();
    this.context.configure({ device, format, alphaMode: "opaque" });
    const { stages, reflection } = compile([
      { name: "material.vert", text: VERTEX + material.vertexShader },
      { name: "material.frag", text: FRAGMENT + material.fragmentShader },
    ]);
    this.reflection = reflection;
    // A geometry has a buffer for each attribute.
    this.attributes = reflection.attributes.filter((one) => one.active).map((one) => ({ ...one, data: geometry.getAttribute(one.name) }));
    const missing = this.attributes.find((one) => !one.data);
    if (missing) throw new Error(`the geometry has no attribute ${missing.name}`);
    this.pipeline = device.createRenderPipeline({
      layout: "auto",
      vertex: {
        module: device.createShaderModule({ code: stages.vertex.wgsl }),
        buffers: this.attributes.map(({ data, location }) => ({
          arrayStride: data.itemSize * 4,
          attributes: [{ shaderLocation: location, offset: 0, format: data.itemSize === 1 ? "float32" : `float32x${data.itemSize}` }],
        })),
      },
      fragment: { module: device.createShaderModule({ code: stages.fragment.wgsl }), targets: [{ format }] },
      primitive: { topology: "triangle-list", cullMode: "back" },
      depthStencil: { format: "depth24plus", depthCompare: "less-equal", depthWriteEnabled: true },
    });
    const filled = (array, usage) => {
      const buffer = device.createBuffer({ size: Math.ceil(array.byteLength / 4) * 4, usage, mappedAtCreation: true });
      new array.constructor(buffer.getMappedRange()).set(array);
      buffer.unmap();
      return buffer;
    };
    this.vertices = this.attributes.map(({ data }) => filled(new Float32Array(data.array), GPUBufferUsage.VERTEX));
    this.indices = filled(new Uint32Array(geometry.index.array), GPUBufferUsage.INDEX);
    const block = reflection.loose_block;
    this.values = new ArrayBuffer(block.size);
    this.uniforms = device.createBuffer({ size: block.size, usage: GPUBufferUsage.UNIFORM | GPUBufferUsage.COPY_DST });
    this.group = device.createBindGroup({
      layout: this.pipeline.getBindGroupLayout(block.group),
      entries: [{ binding: block.binding, resource: { buffer: this.uniforms } }],
    });
    this.depth = device.createTexture({ size: [canvas.width, canvas.height], format: "depth24plus", usage: GPUTextureUsage.RENDER_ATTACHMENT });
  }

  // Writes a uniform where the reflection says: columns of a matrix are apart by its stride.
  set(name, value) {
    const uniform = this.reflection.uniforms.find((one) => one.name === name);
    if (!uniform) return;
    const numbers = typeof value === "number" ? [value] : value.toArray();
    const rows = FLOATS[uniform.type] ?? Math.sqrt(numbers.length);
    for (let column = 0; column * rows < numbers.length; column += 1) {
      const at = uniform.offset + column * (uniform.matrix_stride ?? 0);
      new Float32Array(this.values, at, rows).set(numbers.slice(column * rows, (column + 1) * rows));
    }
  }

  draw(mesh, camera) {
    const view = camera.matrixWorldInverse;
    const modelView = new THREE.Matrix4().multiplyMatrices(view, mesh.matrixWorld);
    this.set("modelMatrix", mesh.matrixWorld);
    this.set("viewMatrix", view);
    this.set("modelViewMatrix", modelView);
    this.set("projectionMatrix", camera.projectionMatrix);
    this.set("normalMatrix", new THREE.Matrix3().getNormalMatrix(modelView));
    this.set("cameraPosition", new THREE.Vector3().setFromMatrixPosition(camera.matrixWorld));
    for (const [name, { value }] of Object.entries(this.material.uniforms)) this.set(name, value);
    this.device.queue.writeBuffer(this.uniforms, 0, this.values);
    const encoder = this.device.createCommandEncoder();
    const pass = encoder.beginRenderPass({
      colorAttachments: [{ view: this.context.getCurrentTexture().createView(), loadOp: "clear", clearValue: [0, 0, 0, 1], storeOp: "store" }],
      depthStencilAttachment: { view: this.depth.createView(), depthLoadOp: "clear", depthClearValue: 1, depthStoreOp: "discard" },
    });
    pass.setPipeline(this.pipeline);
    pass.setBindGroup(this.reflection.loose_block.group, this.group);
    this.vertices.forEach((buffer, index) => pass.setVertexBuffer(index, buffer));
    pass.setIndexBuffer(this.indices, "uint32");
    pass.drawIndexed(this.geometry.index.count);
    pass.end();
    this.device.queue.submit([encoder.finish()]);
  }
}
