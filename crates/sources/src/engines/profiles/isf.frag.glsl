in vec2 isf_FragNormCoord;
