// sRGB to linear light by a cubic, within 1/500 of the curve.
vec3 linear(vec3 s) { return s * (s * (s * 0.305306011 + 0.682171111) + 0.012522878); }
