// Key light with soft shadows, hemisphere of ambient light, tone curve.
uniform sampler2D shadow_depth;  // from the key light
uniform sampler2D sky_depth;     // from the sky's directions, in tiles

// Depth in a tile of a map at [0, 1]². By texel: no filter and no level of detail to be worked out.
float depth_at(sampler2D depths, vec2 at, ivec4 tile) {
    return texelFetch(depths, tile.xy + clamp(ivec2(at * vec2(tile.zw)), ivec2(0), tile.zw - 1), 0).r;
}

// How depth rises across a map along a surface of normal n: per unit of x and y. Steeper than the limit a surface is
// hardly lit.
vec2 rise_of(mat4 matrix, vec3 n) {
    vec3 m = mat3(matrix) * n;
    vec2 rise = -m.xy * (abs(m.z) > 1e-12 ? 1.0 / m.z : 0.0);
    return rise * min(1.0, 4.0 / max(length(rise), 1e-6));
}

// Mean over the 2 × 2 pixels that are drawn together, QUADS; each looks up what the others leave out.
vec2 quad_mean(vec2 value) {
#ifdef QUADS
    vec2 odd = vec2(ivec2(gl_FragCoord.xy) & 1);
    value += dFdx(value) * (0.5 - odd.x);
    value += dFdy(value) * (0.5 - odd.y);
#endif
    return value;
}

// Which part of the lookups is a place's own, of `parts` that make up the whole.
struct Turn {
    float angle, part, parts;
};

// Share of a lamp that is seen from `at`, in the lamp's map: x, y in [0, 1] over its tile (corner and size in
// texels), z a depth.
// Percentage-closer soft shadows: the mean distance of blockers sets the width of the penumbra. [Fernando 2005] What a
// lookup finds is held against the receiver's own plane in the middle of that very texel, so that the plane does not
// shade itself, and blockers that nearly touch it are found. [Isidoro 2006, Shadow Mapping: GPU-based Tips and Techniques]
//   rise     of the receiver's plane
//   source   tangent of the lamp's radius
//   least    radius of the disk where the blockers are near: no sharper than the places that look are apart
// Returns that share and the disk's radius.
vec2 soft_visibility(sampler2D depths, vec3 at, vec2 rise, ivec4 tile, float source, float least, Turn turn, int searches,
                     int taps) {
    // Nothing casts from beyond the map's sides; beyond its far end there are only receivers.
    bool inside = all(greaterThan(at.xy, vec2(0.0))) && all(lessThan(at.xy, vec2(1.0)));
    // Loops that need no lookup get a length of none: llvmpipe spends on a branch that no pixel of a block takes as
    // much as on one that all take, but leaves a loop after its first round.
    if (!inside) searches = taps = 0;
    const mat2 golden = mat2(-0.7373688, 0.6754903, -0.6754903, -0.7373688);
    // Places and lengths across the map in its texels.
    vec2 spoke = vec2(cos(turn.angle), sin(turn.angle)), size = vec2(tile.zw), place = at.xy * size, last = size - 1.0;
    float texel = 1.0 / size.x;
    rise *= texel;
    // No blocker is nearer to the lamp than the map's near end.
    float search = max(min(at.z, 1.0) * source * size.x, 1.5), steepest = source * size.x / 0.7;
    vec2 found = vec2(0.0);  // sum of blockers' depths, their number
    for (int i = 0; i < searches; ++i) {
        vec2 offset = spoke * (sqrt((float(i) + turn.part / turn.parts) / float(searches)) * search);
        spoke = golden * spoke;
        ivec2 here = ivec2(clamp(place + offset, vec2(0.0), last));
        float depth = texelFetch(depths, tile.xy + here, 0).r;
        vec2 away = vec2(here) + 0.5 - place;
        // It hides some of the lamp from this place only where it stands high enough for how far away it is.
        if (depth < min(at.z + dot(rise, away) - 0.5 * texel, 1.0) && (at.z - depth + texel) * steepest > length(away) - 1.5)
            found += vec2(depth, 1.0);
    }
    found = quad_mean(found);
    // Few lookups fall so near that they find what nearly touches this place: that is looked for once more.
    if (found.y == 0.0) taps /= 2;
    float width = found.y == 0.0 ? least : max(least, (at.z - found.x / found.y) * source), lit = 0.0;
    float disk = width * size.x, doubt = size.x;
    for (int i = 0; i < taps; ++i) {
        vec2 offset = spoke * (sqrt((float(i) + (turn.part + 0.5) / turn.parts) / float(taps)) * disk);
        spoke = golden * spoke;
        ivec2 here = ivec2(clamp(place + offset, vec2(0.0), last));
        float plane = min(at.z + dot(rise, vec2(here) + 0.5 - place), 1.0);
        // Within a texel's depth of the plane a lookup is in doubt.
        lit += clamp(1.3 - (plane - texelFetch(depths, tile.xy + here, 0).r) * doubt, 0.0, 1.0);
    }
    return vec2(inside ? lit / float(taps) : 1.0, width);
}

#ifdef SHARP
// Whether a lamp without extent is seen from `at`, in the lamp's map, held against the receiver's own plane in the middle
// of the texel there. The mean of many pictures smooths what a single one has of steps.
float sharp_visibility(sampler2D depths, vec3 at, vec2 rise, ivec4 tile) {
    vec2 size = vec2(tile.zw), place = at.xy * size, texel = floor(clamp(place, vec2(0.0), size - 1.0));
    // Beyond the map's far end there are only receivers.
    float plane = min(at.z + dot(rise, (texel + 0.5 - place) / size), 1.0);
    float seen = clamp(1.3 - (plane - texelFetch(depths, tile.xy + ivec2(texel), 0).r) * size.x, 0.0, 1.0);
    bool inside = all(greaterThan(at.xy, vec2(0.0))) && all(lessThan(at.xy, vec2(1.0)));
    return inside ? seen : 1.0;
}
#endif

#if defined(SAMPLED) && defined(SHARP)
// What the sky of this one direction gives to the side of a surface that n points to: over many pictures its mean is the
// cosine-weighted open share of the sky, as sky_openness() has it.
float sampled_openness(vec3 p, vec3 n) {
    float facing = dot(n, sky_direction[0].xyz), visible = 0.0;
    if (facing > 0.0) {
        vec3 at = (sky_matrix[0] * vec4(p + n * (shadow.z * (0.5 + 2.0 * (1.0 - facing))), 1.0)).xyz;
        visible = sharp_visibility(sky_depth, at, rise_of(sky_matrix[0], n), ivec4(ivec2(0), textureSize(sky_depth, 0)));
    }
    // Directions are spread evenly over the half sphere, over which facing's mean is (1 + n.y)/4.
    return (0.04 + 8.0 * facing * visible) / (0.04 + 2.0 * (1.0 + n.y));
}
#endif

// Share of the key light that reaches p, whose surface faces the light along n (dot(n, l) > 0), on a plane of normal
// `flat_n`. Where it is not `needed` the answer costs less and means nothing. `apart`: metres to the next place that is
// asked about.
float key_visibility(vec3 p, vec3 n, vec3 flat_n, float apart, bool needed) {
#ifdef SHARP
    float lean = 1.0 - dot(n, key_direction.xyz);
    vec3 where = (shadow_matrix * vec4(p + n * shadow.x * (0.5 + 2.0 * lean), 1.0)).xyz;
    ivec4 all = ivec4(ivec2(0), textureSize(shadow_depth, 0));
    return needed ? sharp_visibility(shadow_depth, where, rise_of(shadow_matrix, flat_n), all) : 1.0;
#else
#ifdef QUADS
    ivec2 odd = ivec2(gl_FragCoord.xy) & 1;
    float part = float(odd.x + 2 * odd.y);
    Turn turn = Turn(part * 1.5707963, part, 4.0);
#else
    Turn turn = Turn(0.0, 0.0, 1.0);
#endif
    float away = 1.0 - dot(n, key_direction.xyz);
    vec3 at = (shadow_matrix * vec4(p + n * shadow.x * (0.5 + 2.0 * away), 1.0)).xyz;
    vec2 seen = soft_visibility(shadow_depth, at, rise_of(shadow_matrix, flat_n), ivec4(ivec2(0), textureSize(shadow_depth, 0)),
                                key_direction.w, max(2.0 * shadow.x, 0.75 * apart) / shadow.y, turn, needed ? 4 : 0, 8);
#ifdef QUADS
    // Edges that are sharper than two pixels stay so, and those where the four see all and nothing.
    vec2 across = abs(dFdx(at.xy)) + abs(dFdy(at.xy));
    float blur = clamp(1.5 * seen.y / max(max(across.x, across.y), 1e-9) - 0.75, 0.0, 1.0);
    float mean = quad_mean(seen).x;
    return mix(seen.x, mean, blur * (1.0 - smoothstep(0.2, 0.5, abs(seen.x - mean))));
#else
    return seen.x;
#endif
#endif
}

// Light from all around at normal n, as if nothing stood in the way.
#ifdef SKY_IMAGE
// From the image's harmonics. [Ramamoorthi & Hanrahan 2001, An Efficient Representation for Irradiance Environment Maps]
vec3 ambient_light(vec3 n) {
    vec3 light = sky_harmonics[0].rgb + sky_harmonics[1].rgb * n.y + sky_harmonics[2].rgb * n.z + sky_harmonics[3].rgb * n.x;
    light += sky_harmonics[4].rgb * (n.x * n.y) + sky_harmonics[5].rgb * (n.y * n.z) + sky_harmonics[7].rgb * (n.x * n.z);
    light += sky_harmonics[6].rgb * (3.0 * n.z * n.z - 1.0) + sky_harmonics[8].rgb * (n.x * n.x - n.y * n.y);
    return max(light, vec3(0.0));
}
#else
vec3 ambient_light(vec3 n) { return mix(bounce_color.rgb, sky_color.rgb, 0.5 + 0.5 * n.y); }
#endif
