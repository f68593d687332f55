// name: photometry
// kind: light
// equation: I = Phi / (4 pi), Phi / (2 pi (1 - cos)), L = Phi / (pi A), E = I cos / r^2, L = 2^(EV - 3), exposure = 1 / (1.2 2^EV)
// source: Lagarde and de Rousiers, Moving Frostbite to Physically Based Rendering, SIGGRAPH course 2014, tables 6 to 14; ISO 2720
// stability: the cone by 1 - cos, so narrow beams do not divide by a difference; profiles by the chord of an angle, not by an arc cosine
//
// The units of lamps' data sheets: lumen (all light), candela (into a direction), lux (onto a surface), nits (from a surface, cd/m^2),
// and exposure values at ISO 100. Pass the results as the intensity of a light, and photometryExposure() as the exposure.
#ifndef GLISTEN_PHOTOMETRY
#define GLISTEN_PHOTOMETRY
#include "lut.glsl"

// Candela of a point of light.
//   lumen  >= 0
// bound: 3e-7 rel
float photometryPoint(float lumen)
{
    return safePositive(lumen) / radians(720.0);
}

// Candela of a cone that is filled evenly.
//   lumen  >= 0    spread  1 - cos of half of its angle, limited to [2^-20, 2]
// bound: 3e-7 rel
float photometrySpot(float lumen, float spread)
{
    return safeFinite(safePositive(lumen) / (radians(360.0) * clamp(spread, exp2(-20.0), 2.0)));
}

// Nits of a surface that shines evenly to one side.
//   lumen  >= 0    area  m^2, limited to >= 2^-60
// bound: 3e-7 rel
float photometryArea(float lumen, float area)
{
    return safeFinite(safePositive(lumen) / radians(180.0) / max(area, exp2(-60.0)));
}

// Lux on a surface.
//   candela  >= 0    cosine  N.L, limited to [0, 1]    r  distance in m, limited to >= 2^-60
// bound: 6e-7 rel
float photometryLux(float candela, float cosine, float r)
{
    float d = max(r, exp2(-60.0));
    return safeFinite(safePositive(candela) / d * safeUnit(cosine) / d);
}

// Nits that a light meter takes for an exposure value at ISO 100, with K = 12.5.
//   ev  limited to [-64, 64]
// bound: 1e-6 rel
float photometryNits(float ev)
{
    return exp2(clamp(ev, -64.0, 64.0) - 3.0);
}

// The factor that brings nits to a screen: the brightest nits of an exposure value become 1.
//   ev  limited to [-64, 64]
// bound: 1e-6 rel
float photometryExposure(float ev)
{
    return exp2(-clamp(ev, -64.0, 64.0)) * 5.0 / 6.0;
}

// How far from the lamp's axis a direction is, as profiles of lamps (IES LM-63) have it: 0 along the axis, 1 opposite.
//   L  unit vector towards the light    Ldir  unit vector along the lamp's axis
// bound: 3e-7 abs
float photometryAngle(vec3 L, vec3 Ldir)
{
    vec3 d = L + Ldir;
    vec3 s = Ldir - L;
    float away = sqrt(dot(d, d));
    float along = sqrt(dot(s, s));
    return away > 0.0 || along > 0.0 ? safeUnit(atan(away, along) / radians(90.0)) : 0.0;
}

// The profile of a lamp that is round: a table of candela over that angle.
//   table  n by 1 texels, clamped    L, Ldir  unit vectors
// bound: 2e-6 abs, the steep parts of the table
vec3 photometryProfile(sampler2D table, vec3 L, vec3 Ldir)
{
    return lutColor(table, photometryAngle(L, Ldir));
}

#endif
