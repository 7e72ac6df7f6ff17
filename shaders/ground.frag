// The ground: key light, fill and sky, as far as its maps say that they reach it. A draft looks for the key light itself.
// FADES: it is drawn over a background that is not one colour, and fades by its alpha.
#ifndef SHARP
uniform sampler2D open_map;
uniform sampler2D soft_map;
uniform vec4 region;       // of the key light's map: x, z of its corner; its size [m]
uniform vec4 open_region;  // of the sky's
#endif
#if PICTURE
uniform sampler2D picture;
uniform float per_picture;  // 1/m
#else
uniform vec3 albedo;
#endif
uniform float level;  // m
in vec2 ground_place;
in float away;
out vec4 color;

void main() {
#ifdef SHARP
    vec3 here = vec3(ground_place.x, level, ground_place.y), up = vec3(0.0, 1.0, 0.0);
    float open = 0.95, visible = key_visibility(here, up, up, 0.0, true);
#else
    // Beyond its map nothing is shaded.
    vec2 at_open = (ground_place - open_region.xy) / open_region.zw, from_middle = abs(2.0 * at_open - 1.0);
    float open = mix(texture(open_map, at_open - 0.5 / vec2(textureSize(open_map, 0))).r, 1.0, smoothstep(0.6, 1.0, max(from_middle.x, from_middle.y)));
    // The key light's has a lit rim, which goes on beyond it. Both lead by half a texel, see ground_soft.frag.
    float visible = texture(soft_map, (ground_place - region.xy) / region.zw - 0.5 / vec2(textureSize(soft_map, 0))).r;
#endif
#if PICTURE
    vec3 albedo = texture(picture, ground_place * per_picture).rgb;
#endif
    vec3 all_around = sky_color.rgb + fill_color.rgb * max(0.0, 0.3 + 0.7 * fill_direction.y);
    vec3 light = all_around * open + key_color.rgb * (max(key_direction.y, 0.0) * visible);
    float fade = smoothstep(ground.z, ground.w, away);
#if FADES
    color = vec4(written(tone(albedo * light)) * (1.0 - fade), 1.0 - fade);
#else
    color = vec4(written(mix(tone(albedo * light), background.rgb, fade)), 1.0);
#endif
}
