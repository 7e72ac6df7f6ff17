// How much of the sky a vertex sees: depth maps from SKY_DIRECTIONS directions, looked up once a vertex.
// Needs light.glsl.

// Four lookups far apart: each direction stands for a broad cone of sky, so the edge of its shadow is to be soft. For
// the same reason, and because small maps hold coarse shapes, what lies but little above a place hides but little of it.
float sky_visibility(int k, vec3 p) {
    const float doubt = 0.03;  // m
    vec3 at = (sky_matrix[k] * vec4(p, 1.0)).xyz;
    ivec2 size = textureSize(sky_depth, 0) / ivec2(4, 2);
    ivec4 tile = ivec4(ivec2(k % 4, k / 4) * size, size);
    vec2 within = at.xy * vec2(4.0, 2.0) - vec2(k % 4, k / 4);
    // Beyond its tile nothing stands in the way.
    if (any(lessThan(within, vec2(0.02))) || any(greaterThan(within, vec2(0.98)))) return 1.0;
    vec2 a = vec2(1.9, 0.8) / vec2(size), b = vec2(-a.y, a.x);
    vec4 above = at.z - vec4(depth_at(sky_depth, within + a, tile), depth_at(sky_depth, within - a, tile),
                             depth_at(sky_depth, within + b, tile), depth_at(sky_depth, within - b, tile));
    return dot(clamp(1.0 - above * (shadow.y / doubt), 0.0, 1.0), vec4(0.25));
}

// Cosine-weighted open share of the sky above either side of a surface: x for the side n points to, y for the other.
#ifdef SHARP
vec2 sky_openness(vec3 p, vec3 n) { return vec2(0.8); }  // a draft does not look
#else
vec2 sky_openness(vec3 p, vec3 n) {
    vec2 open = vec2(0.04), all = vec2(0.04);
    for (int k = 0; k < SKY_DIRECTIONS; ++k) {
        float facing = dot(n, sky_direction[k].xyz);
        float visible = sky_visibility(k, p + n * (sign(facing) * 1.2 * shadow.z));
        vec2 weight = vec2(max(facing, 0.0), max(-facing, 0.0));
        open += weight * visible;
        all += weight;
    }
    return open / all;
}
#endif
