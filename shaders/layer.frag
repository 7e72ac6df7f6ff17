// The mean of a pixel's samples, in linear light and premultiplied by coverage.
#if SAMPLES > 1
uniform sampler2DMS layer;
#else
uniform sampler2D layer;
#endif
uniform ivec2 corner;  // of the layer in the picture
out vec4 color;

// Linear light of a sample.
vec4 light(vec4 stored) {
#if ROOTS
    stored.rgb *= stored.rgb;
#endif
    return stored;
}

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy) - corner;
#if SAMPLES > 1
    vec4 sum = vec4(0.0);
    for (int i = 0; i < SAMPLES; ++i) sum += light(texelFetch(layer, at, i));
    color = sum / float(SAMPLES);
#else
    color = light(texelFetch(layer, at, 0));
#endif
}
