#version 150
#extension GL_ARB_shading_language_include : require
#include "light.glsl"
in vec3 normal;
uniform vec3 fog;
out vec4 color;
void main()
{
    color = vec4(lit_by_all(normalize(normal)), 1.0);
#ifdef FOG
    color.rgb = mix(color.rgb, fog, gl_FragCoord.z);
#endif
}
