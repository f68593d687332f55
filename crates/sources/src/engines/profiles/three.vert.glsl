// What three.js declares for the vertex shader of a ShaderMaterial. One declaration a line; a line that the shader has itself is
// left out.
uniform mat4 modelMatrix;
uniform mat4 modelViewMatrix;
uniform mat4 projectionMatrix;
uniform mat4 viewMatrix;
uniform mat3 normalMatrix;
uniform vec3 cameraPosition;
uniform bool isOrthographic;
attribute vec3 position;
attribute vec3 normal;
attribute vec2 uv;
#ifdef USE_INSTANCING
attribute mat4 instanceMatrix;
#endif
#ifdef USE_INSTANCING_COLOR
attribute vec3 instanceColor;
#endif
#if defined(USE_UV1)
attribute vec2 uv1;
#endif
#ifdef USE_TANGENT
attribute vec4 tangent;
#endif
#if defined(USE_COLOR_ALPHA)
attribute vec4 color;
#elif defined(USE_COLOR)
attribute vec3 color;
#endif
#ifdef USE_SKINNING
attribute vec4 skinIndex;
attribute vec4 skinWeight;
#endif
