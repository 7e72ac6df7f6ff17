// How much of the sky a vertex sees: depth maps from SKY_DIRECTIONS directions, looked up once a vertex.
uniform sampler2DShadow sky_maps;

float sky_visibility(int k, vec3 p) {
    vec3 at = (sky_matrix[k] * vec4(p, 1.0)).xyz;
    vec2 tile = vec2(k % 4, k / 4);
    // Beyond its tile nothing stands in the way.
    vec2 inside = at.xy * vec2(4.0, 2.0) - tile;
    if (any(lessThan(inside, vec2(0.02))) || any(greaterThan(inside, vec2(0.98)))) return 1.0;
    // Far apart: each direction stands for a broad cone of sky, so its edge is to be soft.
    vec2 a = vec2(1.4, k % 2 == 0 ? 1.4 : -1.4) / vec2(textureSize(sky_maps, 0));
    return 0.5 * (texture(sky_maps, vec3(at.xy + a, at.z)) + texture(sky_maps, vec3(at.xy - a, at.z)));
}

// Cosine-weighted open share of the sky above either side of a surface: x for the side n points to, y for the other.
vec2 sky_openness(vec3 p, vec3 n) {
    vec2 open = vec2(0.04), all = vec2(0.04);
    for (int k = 0; k < SKY_DIRECTIONS; ++k) {
        float facing = dot(n, sky_direction[k].xyz);
        float visible = sky_visibility(k, p + n * (sign(facing) * 1.6 * shadow.z));
        vec2 weight = vec2(max(facing, 0.0), max(-facing, 0.0));
        open += weight * visible;
        all += weight;
    }
    return open / all;
}
