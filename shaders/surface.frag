uniform vec3 tint;  // linear
uniform bool fades;
uniform vec3 fade_centre;
in vec3 world;
in vec3 world_normal;
out vec4 color;

void main() {
    vec3 n = normalize(world_normal), v = normalize(eye.xyz - world);
    float facing = abs(dot(n, v)), above = 0.5 + 0.5 * n.y * (gl_FrontFacing ? 1.0 : -1.0);
    float shade = (0.35 + 0.65 * facing) * (0.7 + 0.3 * above);
    float fade = fades ? smoothstep(0.1, 0.28, distance(world, fade_centre) / ground.w) : 0.0;
    color = vec4(tint * shade, 1.0) * (1.0 - fade);
}
