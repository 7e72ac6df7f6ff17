// The ground as it is seen: key light, fill and sky, as far as its maps say that they reach it, faded into the
// background. All but the key light's shadow varies so slowly that a grid of vertices tells it, finer in the middle.
// GRID: its cells along a side.
uniform sampler2D open_map;
uniform sampler2D soft_map;
uniform float level;   // m
uniform vec4 region;   // of the maps: x, z of their corner; their size [m]
uniform float reach;   // m from the centre to the grid's sides
uniform vec2 fade;     // m from the centre: where it begins and ends
uniform vec3 albedo;
out vec2 at_map;
out vec3 lit;
out vec3 shadowed;

void main() {
    vec2 t = vec2(gl_VertexID % (GRID + 1), gl_VertexID / (GRID + 1)) * (2.0 / float(GRID)) - 1.0;
    vec2 from_centre = reach * t * (0.25 + 0.75 * t * t);
    vec3 place = vec3(ground.x + from_centre.x, level, ground.y + from_centre.y);
    at_map = (place.xz - region.xy) / region.zw;
    vec3 all_around = ambient_light(vec3(0.0, 1.0, 0.0)) + fill_color.rgb * max(0.0, 0.3 + 0.7 * fill_direction.y);
    vec3 dim = all_around * textureLod(open_map, at_map, 0.0).r;
    float away = smoothstep(fade.x, fade.y, length(from_centre));
    shadowed = mix(tone(albedo * dim), background.rgb, away);
    lit = mix(tone(albedo * (dim + key_color.rgb * max(key_direction.y, 0.0))), background.rgb, away);
    at_map -= 0.5 / vec2(textureSize(soft_map, 0));  // see ground_soft.frag
    gl_Position = view_projection * vec4(place, 1.0);
}
