// The vertex stage of ISF: a quad that covers the picture.
in vec2 isf_position;
out vec2 isf_FragNormCoord;
#define isf_vertShaderInit() (gl_Position = vec4(isf_position, 0.0, 1.0), isf_FragNormCoord = 0.5 * isf_position + 0.5)
