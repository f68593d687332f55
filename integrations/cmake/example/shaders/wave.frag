#version 150

uniform vec3 low;
uniform vec3 top;
in float high;
out vec4 color;

void main() {
#ifdef BANDS
    float share = floor(high * 8.0) / 8.0;
#else
    float share = high;
#endif
    color = vec4(mix(low, top, clamp(share, 0.0, 1.0)), 1.0);
}
