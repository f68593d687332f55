//# vertex
#version 120
void main() { gl_Position = ftransform(); gl_FrontColor = gl_Color; }
//# fragment
#version 120
uniform sampler2D image;
void main() { gl_FragColor = texture2D(image, gl_TexCoord[0].st) * gl_Color; }
