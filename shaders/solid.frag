// Solids: matt, with a highlight. FADES: planes, which fade away with distance. POLISHED: with sharp highlights, and with
// what is around mirrored in them. PICTURE: a picture takes the colour's place.
#if PICTURE
uniform sampler2D picture;
uniform float per_picture;  // 1/m
in vec3 local;
in vec3 local_normal;
#else
uniform vec3 albedo;
#endif
#if POLISHED
uniform float metal;  // share of the light that the colour mirrors, not scatters
#endif
uniform float gloss;   // strength of the highlight
uniform vec3 fade_centre;
in vec3 world;
in vec3 world_normal;
#ifndef SAMPLED
in float openness;
#endif
out vec4 color;

#if PICTURE
// The picture laid on along each axis, by how much the surface faces it.
vec3 pictured() {
    vec3 share = abs(local_normal);
    share = max(share - 0.35 * max(share.x, max(share.y, share.z)), vec3(0.0));
    share /= share.x + share.y + share.z;
    vec3 p = local * per_picture;
    return texture(picture, vec2(p.z, -p.y)).rgb * share.x + texture(picture, vec2(p.x, p.z)).rgb * share.y +
           texture(picture, vec2(p.x, -p.y)).rgb * share.z;
}
#endif

void main() {
#if PICTURE
    vec3 albedo = pictured();
#endif
    vec3 n = normalize(world_normal), v = normalize(eye.xyz - world), l = key_direction.xyz;
    float nl = max(dot(n, l), 0.0), nh = clamp(dot(n, normalize(l + v)), 0.0, 1.0);
#ifdef SAMPLED
    float openness = sampled_openness(world, n);
#endif
    vec3 result = albedo * ambient_light(n) * openness;
    result += albedo * fill_color.rgb * (max(0.0, 0.3 + 0.7 * dot(n, fill_direction.xyz)) * openness);
    // Normalised Blinn–Phong of exponent 24, dimmed to a dielectric's 4% and rising at grazing angles.
    float away = 1.0 - clamp(dot(n, v), 0.0, 1.0), away2 = away * away, nh2 = nh * nh, nh8 = nh2 * nh2 * nh2 * nh2;
    float highlight = gloss * (0.04 + 0.5 * away2 * away2 * away) * (26.0 / 8.0) * (nh8 * nh8 * nh8);
    float key = nl * key_visibility(world, n, cross(dFdx(world), dFdy(world)), 0.0, nl > 0.0);
#if POLISHED
    // Blinn–Phong of a high exponent, and the surroundings as they are around the mirrored direction; both by Schlick's
    // share of what is mirrored.
    vec3 mirrored = mix(vec3(0.04), albedo, metal);
    mirrored += (1.0 - mirrored) * (away2 * away2 * away);
    float sharp = mix(180.0, 60.0, metal);
    vec3 glint = mirrored * ((sharp + 8.0) / 8.0 * pow(nh, sharp) * 0.3);
    result = (1.0 - metal) * (result + albedo * key_color.rgb * key) + glint * key_color.rgb * key;
    result += mirrored * ambient_light(reflect(-v, n)) * openness;
#else
    result += (albedo + highlight) * key_color.rgb * key;
#endif
#if FADES
    float fade = smoothstep(ground.z, ground.w, distance(world, fade_centre));
#else
    const float fade = 0.0;
#endif
    color = vec4(written(tone(result)), 1.0) * (1.0 - fade);
}
