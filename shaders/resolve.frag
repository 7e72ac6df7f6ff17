// The mean of a pixel's samples. The texture decodes sRGB, so the mean is of light.
uniform sampler2DMS picture;
out vec4 color;

void main() {
    vec4 sum = vec4(0.0);
    for (int i = 0; i < SAMPLES; ++i) sum += texelFetch(picture, ivec2(gl_FragCoord.xy), i);
    color = sum / float(SAMPLES);
}
