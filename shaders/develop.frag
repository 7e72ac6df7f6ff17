// A picture from the mean light of many: its tones, over what lies behind.
uniform sampler2D picture;  // premultiplied by the share of each pixel that shapes cover
uniform bool straight;      // divide by alpha: what image files hold
out vec4 color;

void main() {
    vec4 mean = texelFetch(picture, ivec2(gl_FragCoord.xy), 0);
    vec3 shown = toned(mean.rgb / max(mean.a, 1e-6));
    color = straight ? vec4(written(shown), mean.a) : vec4(written(shown) * mean.a, mean.a);
}
