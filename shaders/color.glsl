// sRGB to linear light by a cubic, within 1/500 of the curve.
vec3 linear(vec3 s) { return s * (s * (s * 0.305306011 + 0.682171111) + 0.012522878); }

// Linear light in [0, 1] to sRGB, within a tenth of one of 255 steps of the curve.
vec3 encoded(vec3 light) {
    vec3 root = sqrt(light);
    vec3 curve = 0.29810549 * sqrt(root) + 0.83375517 * root - 0.05531682 * light - 0.07690285;
    return mix(curve, 12.92 * light, lessThan(light, vec3(0.0031308)));
}
