uniform vec4 tint;        // rgb: linear; w: 1 replaces the vertices' colour
uniform float strength;   // of the vertices' colour
uniform bool fades;
uniform vec3 fade_centre;
in vec3 world;
in vec3 world_normal;
in vec3 surface_color;
out vec4 color;

void main() {
    vec3 n = normalize(world_normal), v = normalize(eye.xyz - world);
    float facing = abs(dot(n, v)), above = 0.5 + 0.5 * n.y * (gl_FrontFacing ? 1.0 : -1.0);
    float shade = (0.35 + 0.65 * facing) * (0.7 + 0.3 * above);
    vec3 base = mix(surface_color * strength, tint.rgb, tint.w);
    float fade = fades ? smoothstep(0.1, 0.28, distance(world, fade_centre) / ground.w) : 0.0;
    color = vec4(base * shade, 1.0) * (1.0 - fade);
}
