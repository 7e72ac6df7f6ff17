// The ground as it is seen: key light, fill and sky, as far as its maps say that they reach it, faded into the
// background.
uniform sampler2D open_map;
uniform sampler2D soft_map;
uniform vec3 albedo;
uniform vec2 fade;  // m from the centre: where it begins and ends
in vec2 at_map;
in vec2 from_centre;
out vec4 color;

void main() {
    vec3 all_around = ambient_light(vec3(0.0, 1.0, 0.0)) + fill_color.rgb * max(0.0, 0.3 + 0.7 * fill_direction.y);
    vec3 light = all_around * texture(open_map, at_map).r;
    light += key_color.rgb * (max(key_direction.y, 0.0) * texture(soft_map, at_map).r);
    color = vec4(mix(tone(albedo * light), background.rgb, smoothstep(fade.x, fade.y, length(from_centre))), 1.0);
}
