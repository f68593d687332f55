#version 150
#extension GL_ARB_shading_language_include : require
// The standard program: (101) at each fragment.
#include <glisten/standard.glsl>
#if defined(GLISTEN_NORMALS) || defined(GLISTEN_COAT_NORMALS)
#include <glisten/normal_map.glsl>
#endif

in vec3 world;
in vec3 direction;
in vec2 st;
#if defined(GLISTEN_NORMALS) || defined(GLISTEN_BRUSHED) || defined(GLISTEN_COAT_NORMALS)
#define STANDARD_TANGENTS
in vec4 along;              // the tangent in world space, not of unit length, and its handedness
#endif
#ifdef GLISTEN_NORMALS
uniform sampler2D normal_map;
#endif
#ifdef GLISTEN_COAT_NORMALS
uniform sampler2D clearcoat_normal_map;
#endif
#ifdef GLISTEN_TWO_SETS
in vec2 st2;
#endif
#ifdef GLISTEN_COLORS
in vec4 tint;
#endif
#ifdef GLISTEN_BALL
uniform mat4 view;          // from world space to eye space
#endif
uniform vec3 eye;           // in world space
uniform sampler2D decal;    // colors the body, not the gloss
out vec4 color;

void main()
{
    vec3 N = safeNormalize(direction);
    vec3 V = safeNormalize(eye - world);
#ifdef GLISTEN_SURFACE
#ifdef GLISTEN_TWO_SETS
    surface_second = st2;
#endif
    vec4 base = texture(decal, STANDARD_PLACE(decal));
#ifdef GLISTEN_COLORS
    base *= tint;
#endif
    float alpha = finish.alpha < 0.0 ? 1.0 : safeUnit(finish.alpha * base.a);
    if (finish.alpha_cutoff > 0.0) {
        if (alpha < finish.alpha_cutoff)
            discard;
        alpha = 1.0;
    }
#ifdef STANDARD_TANGENTS
    vec3 T = safeNormalize(along.xyz - dot(along.xyz, N) * N);
#endif
#ifdef GLISTEN_BRUSHED
    float handedness = along.w;
#endif
    vec3 smooth_normal = N;
#ifdef GLISTEN_COAT_NORMALS
    vec3 bump = texture(clearcoat_normal_map, STANDARD_PLACE(clearcoat_normal_map)).rgb;
    bump.rg = 0.5 + finish.clearcoat_normal_scale * (bump.rg - 0.5);
    smooth_normal = normalMapped(N, T, along.w, bump);
#endif
#ifdef GLISTEN_NORMALS
    vec3 texel = texture(normal_map, STANDARD_PLACE(normal_map)).rgb;
    texel.rg = 0.5 + finish.normal_scale * (texel.rg - 0.5);
    N = normalMapped(N, T, along.w, texel);
#endif
    if (finish.two_sided > 0.0 && !gl_FrontFacing) {
        N = -N;
        smooth_normal = -smooth_normal;
#ifdef GLISTEN_BRUSHED
        // The scratches are lines on the surface, the same from both sides.
        handedness = -handedness;
#endif
    }
#if defined(GLISTEN_NORMALS) || defined(GLISTEN_COAT_NORMALS)
    surface_coat_normal = smooth_normal;
#endif
    standardSurface(st, base.rgb);
#ifdef GLISTEN_BRUSHED
    standardBrush(st, N, T, handedness);
#endif
#ifdef GLISTEN_FIBERS
    standardFibers(st, N, V);
#endif
#ifdef GLISTEN_GLASS
    // Two draws: the first one multiplies what is behind, and the second one is added to it.
    if (finish.transmission_pass == GLASS_THROUGH) {
        color = vec4(standardGlass(N, V), 1.0);
        return;
    }
    if (finish.transmission_pass == GLASS_SURFACE)
        alpha = 0.0;
#endif
#ifdef GLISTEN_BALL
    Reflection ball = standardBall(mat3(view) * N, mat3(view) * V);
    color = vec4(standardColor(ball, STANDARD_MATERIAL.emission, vec3(1.0)), alpha);
#else
    color = vec4(standardColor(standardReflection(world, N, V), standardEmission(N, V), vec3(1.0)), alpha);
#endif
#else
    vec3 emission = standardEmission(N, V);
    color = vec4(standardColor(standardReflection(world, N, V), emission, texture(decal, st).rgb), 1.0);
#endif
}
