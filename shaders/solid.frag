// Solids: matt, with a broad highlight; planes fade away with distance.
uniform vec3 albedo;
uniform float gloss;   // strength of the highlight
uniform bool fades;
uniform vec3 fade_centre;
in vec3 world;
in vec3 world_normal;
in float openness;
out vec4 color;

void main() {
    float fade = fades ? smoothstep(ground.z, ground.w, distance(world, fade_centre)) : 0.0;
    vec3 n = normalize(world_normal), v = normalize(eye.xyz - world), l = key_direction.xyz;
    float nl = dot(n, l);
    vec3 result = albedo * ambient_light(n) * openness;
    result += albedo * fill_color.rgb * (max(0.0, 0.3 + 0.7 * dot(n, fill_direction.xyz)) * openness);
    if (nl > 0.0) {
        float nh = clamp(dot(n, normalize(l + v)), 0.0, 1.0);
        // Normalised Blinn–Phong of exponent 24, dimmed to a dielectric's 4% and rising at grazing angles.
        float grazing = pow(1.0 - clamp(dot(n, v), 0.0, 1.0), 5.0);
        float highlight = gloss * (0.04 + 0.5 * grazing) * (26.0 / 8.0) * pow(nh, 24.0);
        result += (albedo + highlight) * key_color.rgb * (nl * key_visibility(world, n, pattern_turn()));
    }
    color = vec4(sqrt(tone(result) * (1.0 - fade)), 1.0 - fade);  // the layer holds roots
}
