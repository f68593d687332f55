# %% [markdown]
# # A shader, from GLSL to numbers
#
# Each `# %%` begins a cell: Jupyter (with jupytext), VS Code and PyCharm open this file as a notebook, and `python explore.py`
# runs it from top to bottom.

# %%
import numpy as np

import glisten

print("glisten", glisten.__version__)

# %% [markdown]
# A program of two texts. The macro and the included file come from here; `<glisten/...>` is the library that glisten brings.

# %%
VERTEX = """#version 150
out vec2 uv;
void main() {
    vec2 corner = vec2[](vec2(-1), vec2(3, -1), vec2(-1, 3))[gl_VertexID];
    uv = 0.5 * corner + 0.5;
    gl_Position = vec4(corner, 0.0, 1.0);
}
"""
FRAGMENT = """#version 150
#extension GL_ARB_shading_language_include : require
#include "wave.glsl"
uniform float time;
in vec2 uv;
out vec4 color;
void main() { color = vec4(vec3(wave(uv.x, time)), 1.0); }
"""
WAVE = "float wave(float x, float t) { return 0.5 + 0.5 * sin(FREQUENCY * x + t); }\n"

program = glisten.compile(
    {"wave.vert": VERTEX, "wave.frag": FRAGMENT}, defines={"FREQUENCY": "12.0"}, include={"wave.glsl": WAVE}
)
print(program.wgsl("fragment"))

# %% [markdown]
# What a host needs to know.

# %%
for uniform in program.reflection["uniforms"]:
    print(uniform["name"], uniform["type"], "at byte", uniform["offset"])

# %% [markdown]
# What is wrong with a shader is data.

# %%
for found in glisten.lint({"wrong.frag": "#version 150\nout vec4 c;\nvoid main() { c = vec4(colour, 1.0); }\n"}):
    print(found)
    assert found.severity == "error" and found.line == 3

# %% [markdown]
# A picture is an array: the scene is drawn in double precision, and compared with a closed form and with single precision.

# %%
SCENE = """
[framebuffer]
width = 64
height = 4
[[draw]]
vertex = "wave.vert"
fragment = "wave.frag"
vertex_count = 3
defines = { FREQUENCY = "12.0" }
[draw.uniforms]
time = 0.25
"""
scene = glisten.load(
    "wave.toml",
    files={"wave.toml": SCENE, "wave.vert": VERTEX, "wave.frag": FRAGMENT},
    include={"wave.glsl": WAVE},
)
exact, single = scene.render(), scene.render("f32")
x = (np.arange(64) + 0.5) / 64
expected = 0.5 + 0.5 * np.sin(12.0 * x + 0.25)
print("error of f64:", np.abs(exact.pixels[0, :, 0] - expected).max())
print("error of f32:", np.abs(single.pixels[0, :, 0] - expected).max())
assert exact.covered.all() and np.allclose(exact.pixels[..., 0], expected, atol=1e-6)

# %% [markdown]
# And where single precision hurts.

# %%
print("stability:", scene.stability()["verdict"])
print("all is well")
