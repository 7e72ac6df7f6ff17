noperspective in float across;
noperspective in float along;
flat in vec3 color_a;
flat in vec3 color_b;
flat in vec2 pen;
uniform bool encodes;
out vec4 color;

void main() {
    float cover = clamp(pen.x + 0.5 - abs(across), 0.0, 1.0);
    vec3 ink = mix(color_a, color_b, smoothstep(0.42, 0.58, along));
    color = vec4(encodes ? encoded(ink) : ink, 1.0) * (cover * pen.y);
}
