// Key light with soft shadows, hemisphere of ambient light, tone curve.
uniform sampler2D shadow_depth;

// Share of the key light that reaches p, whose surface faces the light along n (dot(n, l) > 0).
// Percentage-closer soft shadows: the mean distance of blockers sets the width of the penumbra. [Fernando 2005]
float key_visibility(vec3 p, vec3 n) {
    float slope = 1.0 - dot(n, key_direction.xyz);
    vec3 at = (shadow_matrix * vec4(p + n * shadow.x * (0.8 + 2.0 * slope), 1.0)).xyz;
    bool inside = all(greaterThan(at, vec3(0.0))) && all(lessThan(at, vec3(1.0)));

    // Turn the disk by one of 16 angles of a 4 × 4 ordered pattern: neighbours see different rings.
    ivec2 cell = ivec2(gl_FragCoord.xy) & 3;
    float angle = float(((cell.x ^ cell.y) & 1) * 8 + (cell.y & 1) * 4 + (((cell.x ^ cell.y) >> 1) & 1) * 2 +
                        ((cell.y >> 1) & 1)) * (6.2831853 / 16.0);
    vec2 spoke = vec2(cos(angle), sin(angle));
    const mat2 golden = mat2(-0.7373688, 0.6754903, -0.6754903, -0.7373688);

    // Loops of a length known only here: rasterisers on the CPU run both sides of an if for every pixel, but leave a
    // loop that no pixel needs.
    float search = 0.35 * key_direction.w;  // blockers up to 0.35 of the map's extent away
    float sum = 0.0, count = 0.0;
    int taps = inside ? 6 : 0;
    for (int i = 0; i < taps; ++i) {
        float r = sqrt((float(i) + 0.5) / 6.0) * search;
        spoke = golden * spoke;
        float depth = texture(shadow_depth, at.xy + spoke * r).r;
        // The receiver's own plane is no blocker: allow for its slope within the disk.
        if (depth < at.z - 0.002 - 0.5 * r) {
            sum += depth;
            count += 1.0;
        }
    }
    float width = max(shadow.x / shadow.y, (at.z - sum / max(count, 1.0)) * key_direction.w);
    float lit = 0.0;
    taps = count > 0.0 ? 12 : 0;
    for (int i = 0; i < taps; ++i) {
        float r = sqrt((float(i) + 0.5) / 12.0) * width;
        spoke = golden * spoke;
        lit += step(at.z - 0.35 * r - 0.0004, texture(shadow_depth, at.xy + spoke * r).r);
    }
    return count > 0.0 ? lit / 12.0 : 1.0;
}

// Light from all around at normal n, as if nothing stood in the way.
vec3 ambient_light(vec3 n) { return mix(bounce_color.rgb, sky_color.rgb, 0.5 + 0.5 * n.y); }

// Identity up to a shoulder, then highlights are compressed towards 1 without turning hue.
// After the Khronos PBR neutral tone mapper (2024), less its toe.
vec3 tone(vec3 color) {
    const float shoulder = 0.72;
    float peak = max(color.r, max(color.g, color.b));
    if (peak <= shoulder) return color;
    float room = 1.0 - shoulder, pressed = 1.0 - room * room / (peak + room - shoulder);
    float white = 1.0 - 1.0 / (0.2 * (peak - pressed) + 1.0);
    return mix(color * (pressed / peak), vec3(pressed), white);
}
