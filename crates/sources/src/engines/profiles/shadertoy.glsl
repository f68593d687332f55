// What Shadertoy puts around a picture. One declaration a line; a line that the shader has itself is left out.
// A channel that is no 2D texture: -D SHADERTOY_CHANNEL1=samplerCube.
#ifdef GL_ES
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp sampler3D;
#endif
#ifndef SHADERTOY_CHANNEL0
#define SHADERTOY_CHANNEL0 sampler2D
#endif
#ifndef SHADERTOY_CHANNEL1
#define SHADERTOY_CHANNEL1 sampler2D
#endif
#ifndef SHADERTOY_CHANNEL2
#define SHADERTOY_CHANNEL2 sampler2D
#endif
#ifndef SHADERTOY_CHANNEL3
#define SHADERTOY_CHANNEL3 sampler2D
#endif
uniform vec3 iResolution;
uniform float iTime;
uniform float iTimeDelta;
uniform float iFrameRate;
uniform int iFrame;
uniform float iChannelTime[4];
uniform vec3 iChannelResolution[4];
uniform vec4 iMouse;
uniform SHADERTOY_CHANNEL0 iChannel0;
uniform SHADERTOY_CHANNEL1 iChannel1;
uniform SHADERTOY_CHANNEL2 iChannel2;
uniform SHADERTOY_CHANNEL3 iChannel3;
uniform vec4 iDate;
uniform float iSampleRate;
#define iGlobalTime iTime
out vec4 shadertoyColor;
void mainImage(out vec4 fragColor, in vec2 fragCoord); // with mainImage
void main() { mainImage(shadertoyColor, gl_FragCoord.xy); } // with mainImage
