#version 150
#extension GL_ARB_shading_language_include : require
// The standard program: (101) at each fragment.
#include <glisten/standard.glsl>
#ifdef GLISTEN_NORMALS
#include <glisten/normal_map.glsl>
#endif

in vec3 world;
in vec3 direction;
in vec2 st;
#ifdef GLISTEN_NORMALS
in vec4 along;              // the tangent in world space, not of unit length, and its handedness
uniform sampler2D normal_map;
#endif
#ifdef GLISTEN_COLORS
in vec4 tint;
#endif
uniform vec3 eye;           // in world space
uniform sampler2D decal;    // colors the body, not the gloss
out vec4 color;

void main()
{
    vec3 N = safeNormalize(direction);
    vec3 V = safeNormalize(eye - world);
#ifdef GLISTEN_SURFACE
    vec4 base = texture(decal, st);
#ifdef GLISTEN_COLORS
    base *= tint;
#endif
    float alpha = finish.alpha < 0.0 ? 1.0 : safeUnit(finish.alpha * base.a);
    if (finish.alpha_cutoff > 0.0) {
        if (alpha < finish.alpha_cutoff)
            discard;
        alpha = 1.0;
    }
#ifdef GLISTEN_NORMALS
    vec3 texel = texture(normal_map, st).rgb;
    texel.rg = 0.5 + finish.normal_scale * (texel.rg - 0.5);
    N = normalMapped(N, safeNormalize(along.xyz - dot(along.xyz, N) * N), along.w, texel);
#endif
    if (finish.two_sided > 0.0 && !gl_FrontFacing)
        N = -N;
    standardSurface(st, base.rgb);
    color = vec4(standardColor(standardReflection(world, N, V), vec3(1.0)), alpha);
#else
    color = vec4(standardColor(standardReflection(world, N, V), texture(decal, st).rgb), 1.0);
#endif
}
