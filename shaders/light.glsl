// Key light with soft shadows, hemisphere of ambient light, tone curve.
uniform sampler2D shadow_depth;  // from the key light
uniform sampler2D sky_depth;     // from the sky's directions, in tiles

// Depth in a tile of a map at [0, 1]². By texel: no filter and no level of detail to be worked out.
float depth_at(sampler2D depths, vec2 at, ivec4 tile) {
    return texelFetch(depths, tile.xy + clamp(ivec2(at * vec2(tile.zw)), ivec2(0), tile.zw - 1), 0).r;
}

// Share of a lamp that is seen from `at`, in the lamp's map: x, y in [0, 1] over its tile (corner and size in
// texels), z a depth.
// Percentage-closer soft shadows: the mean distance of blockers sets the width of the penumbra. [Fernando 2005]
//   source   tangent of the lamp's radius
//   slope    how steeply the receiver's own surface may rise within the disk, so as not to block itself
//   least    radius of the disk where the blockers are near: no sharper than the places that look are apart
//   turn     angle by which the disk of lookups is turned
float soft_visibility(sampler2D depths, vec3 at, ivec4 tile, float source, float slope, float least, float turn,
                      int searches, int taps) {
    // Nothing casts from beyond the map's sides; beyond its far end there are only receivers.
    bool inside = all(greaterThan(at.xy, vec2(0.0))) && all(lessThan(at.xy, vec2(1.0)));
    // Loops that need no lookup get a length of none: llvmpipe spends on a branch that no pixel of a block takes as
    // much as on one that all take, but leaves a loop after its first round.
    if (!inside) searches = 0;
    const mat2 golden = mat2(-0.7373688, 0.6754903, -0.6754903, -0.7373688);
    vec2 spoke = vec2(cos(turn), sin(turn));
    float search = 0.35 * source;  // blockers up to 0.35 of the map's extent away
    float sum = 0.0, count = 0.0;
    for (int i = 0; i < searches; ++i) {
        float r = sqrt((float(i) + 0.5) / float(searches)) * search;
        spoke = golden * spoke;
        float depth = depth_at(depths, at.xy + spoke * r, tile);
        if (depth < min(at.z - 0.002 - slope * r, 1.0)) {
            sum += depth;
            count += 1.0;
        }
    }
    // None or all in the way: full light or none.
    bool rim = count > 0.0 && count < float(searches);
    if (!rim) taps = 0;
    float width = max(least, (at.z - sum / max(count, 1.0)) * source);
    float lit = 0.0;
    for (int i = 0; i < taps; ++i) {
        float r = sqrt((float(i) + 0.5) / float(taps)) * width;
        spoke = golden * spoke;
        lit += step(min(at.z - 0.0004 - 0.7 * slope * r, 1.0),
                    depth_at(depths, at.xy + spoke * r, tile));
    }
    return rim ? lit / float(taps) : count == 0.0 ? 1.0 : 0.0;
}

// Share of the key light that reaches p, whose surface faces the light along n (dot(n, l) > 0). Where it is not
// `needed` the answer costs less and means nothing. `apart`: metres to the next place that is asked about.
float key_visibility(vec3 p, vec3 n, float apart, float turn, bool needed) {
    float away = 1.0 - dot(n, key_direction.xyz);
    vec3 at = (shadow_matrix * vec4(p + n * shadow.x * (0.8 + 2.0 * away), 1.0)).xyz;
    return soft_visibility(shadow_depth, at, ivec4(ivec2(0), textureSize(shadow_depth, 0)), key_direction.w, 0.5,
                           max(shadow.x, 0.75 * apart) / shadow.y, turn, needed ? 6 : 0, 12);
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
