// Solids: matt, with a broad highlight. FADES: planes, which fade away with distance.
uniform vec3 albedo;
uniform float gloss;   // strength of the highlight
uniform vec3 fade_centre;
in vec3 world;
in vec3 world_normal;
in float openness;
out vec4 color;

void main() {
    vec3 n = normalize(world_normal), v = normalize(eye.xyz - world), l = key_direction.xyz;
    float nl = max(dot(n, l), 0.0), nh = clamp(dot(n, normalize(l + v)), 0.0, 1.0);
    vec3 result = albedo * ambient_light(n) * openness;
    result += albedo * fill_color.rgb * (max(0.0, 0.3 + 0.7 * dot(n, fill_direction.xyz)) * openness);
    // Normalised Blinn–Phong of exponent 24, dimmed to a dielectric's 4% and rising at grazing angles.
    float away = 1.0 - clamp(dot(n, v), 0.0, 1.0), away2 = away * away, nh2 = nh * nh, nh8 = nh2 * nh2 * nh2 * nh2;
    float highlight = gloss * (0.04 + 0.5 * away2 * away2 * away) * (26.0 / 8.0) * (nh8 * nh8 * nh8);
    float key = nl * key_visibility(world, n, cross(dFdx(world), dFdy(world)), 0.0, nl > 0.0);
    result += (albedo + highlight) * key_color.rgb * key;
#if FADES
    float fade = smoothstep(ground.z, ground.w, distance(world, fade_centre));
#else
    const float fade = 0.0;
#endif
    color = vec4(written(tone(result)), 1.0) * (1.0 - fade);
}
