// What three.js declares for the fragment shader of a ShaderMaterial. One declaration a line; a line that the shader has itself
// is left out.
uniform mat4 viewMatrix;
uniform vec3 cameraPosition;
uniform bool isOrthographic;
vec4 linearToOutputTexel(vec4 value) { return value; }
vec3 toneMapping(vec3 color) { return color; }
