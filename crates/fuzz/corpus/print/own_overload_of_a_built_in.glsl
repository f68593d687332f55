#version 100
#pragma STDGL invariant(all)
precision mediump float;
// A built-in function may be overloaded, not redefined (ES 1.00 section 8), and each parameter hides a global.
varying vec2 at;
float length(bool a) { return a ? 1.0 : 0.0; }
float twice(float a);
float twice(float a) { float a = a * 2.0; return a; }
void main() {
    float exp = 1.0;
    gl_FragColor = vec4(length(at), length(true), twice(exp), 1.0);
}
