// Supersampling and exposures: the mean of factor × factor texels, times a frame's share of the exposure. The texture
// decodes sRGB, so the mean is of light.
uniform sampler2D picture;  // premultiplied by alpha
uniform int factor;
uniform float share;
uniform bool straight;  // divide by alpha: what image files hold
out vec4 color;

void main() {
    ivec2 corner = ivec2(gl_FragCoord.xy) * factor;
    vec4 sum = vec4(0.0);
    for (int y = 0; y < factor; ++y)
        for (int x = 0; x < factor; ++x) sum += texelFetch(picture, corner + ivec2(x, y), 0);
    color = sum * (share / float(factor * factor));
    if (straight) color.rgb /= max(color.a, 1e-6);
}
