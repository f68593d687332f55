// One ShaderMaterial, drawn by three.js with WebGL, and with WebGPU from its GLSL as it is.

import * as THREE from "three";
import { init } from "glisten";
import { WebGpuMaterial } from "./webgpu-material.js";

const camera = new THREE.PerspectiveCamera(40, 1, 0.1, 20);
camera.position.set(0, 0, 5);
camera.updateMatrixWorld();
const geometry = new THREE.TorusKnotGeometry(0.8, 0.3, 160, 24);
const material = new THREE.ShaderMaterial({
  uniforms: { time: { value: 0 }, base: { value: new THREE.Color(0.1, 0.3, 0.8) }, stripes: { value: new THREE.Vector2(12, 3) } },
  vertexShader: `
    varying vec3 vNormal;
    varying vec2 vUv;
    uniform float time;
    void main() {
      vNormal = normalMatrix * normal;
      vUv = uv;
      vec3 moved = position + normal * 0.04 * sin(time + 10.0 * uv.x);
      gl_Position = projectionMatrix * modelViewMatrix * vec4(moved, 1.0);
    }`,
  fragmentShader: `
    varying vec3 vNormal;
    varying vec2 vUv;
    uniform vec3 base;
    uniform vec2 stripes;
    void main() {
      float light = 0.2 + 0.8 * max(dot(normalize(vNormal), normalize(vec3(1.0, 1.0, 2.0))), 0.0);
      float stripe = smoothstep(0.4, 0.6, abs(fract(vUv.x * stripes.x + vUv.y * stripes.y) - 0.5) * 2.0);
      gl_FragColor = vec4(mix(base, vec3(1.0, 0.7, 0.2), stripe) * light, 1.0);
    }`,
});
const mesh = new THREE.Mesh(geometry, material);
const scene = new THREE.Scene().add(mesh);

const renderer = new THREE.WebGLRenderer({ canvas: document.querySelector("#webgl"), antialias: false, preserveDrawingBuffer: true });
renderer.outputColorSpace = THREE.LinearSRGBColorSpace;

await init();
const device = await (await navigator.gpu?.requestAdapter())?.requestDevice();
const other = device ? new WebGpuMaterial(device, document.querySelector("#webgpu"), material, geometry) : null;
if (!other) document.querySelector("#said").textContent = "This browser has no WebGPU.";

const draw = (milliseconds) => {
  material.uniforms.time.value = milliseconds / 1000;
  mesh.rotation.y = milliseconds / 4000;
  mesh.updateMatrixWorld();
  renderer.render(scene, camera);
  other?.draw(mesh, camera);
};
// A picture of a given moment, for whoever compares both.
window.drawAt = draw;
if (location.hash !== "#still") renderer.setAnimationLoop(draw);
document.body.dataset.ready = other ? "webgpu" : "none";
