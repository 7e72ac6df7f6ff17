// What is written of linear light. ENCODED: the target takes colours as they are; else it encodes them by itself.
// Light is dithered over half a step of 255 either way, so that slow gradients show no bands.
#ifdef SAMPLED
vec3 written(vec3 light) { return light; }
#else
vec3 written(vec3 light) {
    // Interleaved gradient noise. [Jimenez 2014, Next Generation Post Processing in Call of Duty]
    float noise = fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715)))) - 0.5;
#if ENCODED
    return encoded(light) + noise * (0.9 / 255.0);
#else
    return light + noise * (2.0 / 255.0) * sqrt(light);  // by the encoding's slope, roughly
#endif
}
#endif
