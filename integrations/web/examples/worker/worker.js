// The worker: it draws a scene by the CPU reference. A worker has no import map, so that the path says where the package is.

import { init, render } from "/target/web/package/reference.js";

const scene = (shininess) => `[framebuffer]
width = 256
height = 256
[camera]
eye = [0.0, 0.0, 4.0]
fovy = 32.0
[[draw]]
vertex = "ball.vert"
fragment = "ball.frag"
cull = "back"
depth_test = true
[draw.mesh]
shape = "sphere"
[draw.matrices]
view = "model_view"
clip = "model_view_projection"
[draw.uniforms]
shininess = ${shininess.toFixed(1)}
`;
const vertex = `#version 150
in vec3 position;
in vec3 normal;
uniform mat4 view;
uniform mat4 clip;
out vec3 p;
out vec3 n;
void main() {
    p = (view * vec4(position, 1.0)).xyz;
    n = mat3(view) * normal;
    gl_Position = clip * vec4(position, 1.0);
}
`;
const fragment = `#version 150
#extension GL_ARB_shading_language_include : require
#include <glisten/blinn_phong.glsl>
in vec3 p;
in vec3 n;
uniform float shininess;
out vec4 color;
void main() {
    vec3 N = normalize(n), L = normalize(vec3(1.0, 1.0, 2.0)), V = normalize(-p);
    vec3 light = vec3(0.05) + max(dot(N, L), 0.0) * vec3(0.7, 0.3, 0.1);
    color = vec4(light + blinnPhong(N, L, V, shininess, vec3(0.6), vec3(1.0)), 1.0);
}
`;

const loaded = init();
onmessage = async ({ data: { shininess } }) => {
  try {
    await loaded;
    const from = performance.now();
    const picture = render("ball.toml", { "ball.toml": scene(shininess), "ball.vert": vertex, "ball.frag": fragment });
    postMessage({ picture: { width: picture.width, height: picture.height, data: picture.data }, milliseconds: performance.now() - from });
  } catch (error) {
    postMessage({ error: error.message });
  }
};
