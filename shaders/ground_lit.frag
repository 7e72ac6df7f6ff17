// The ground's colour under key light, fill and sky.
uniform sampler2D open_map;
uniform sampler2D visible_map;
uniform vec3 albedo;
uniform bool shadowed;  // false where no shadow of the key light falls
in vec2 at_map;
out vec4 color;

void main() {
    float open = texture(open_map, at_map).r, seen = 1.0;
    if (shadowed) {
        // Four linear lookups: the mean of 4 × 4 texels, over which the shadow's sampling pattern repeats.
        vec2 step = 1.0 / vec2(textureSize(visible_map, 0));
        seen = 0.25 * (texture(visible_map, at_map + step * vec2(-1.0, -1.0)).r +
                       texture(visible_map, at_map + step * vec2(1.0, -1.0)).r +
                       texture(visible_map, at_map + step * vec2(-1.0, 1.0)).r +
                       texture(visible_map, at_map + step * vec2(1.0, 1.0)).r);
    }
    vec3 up = vec3(0.0, 1.0, 0.0);
    vec3 light = (ambient_light(up) + fill_color.rgb * max(0.0, 0.3 + 0.7 * fill_direction.y)) * open;
    light += key_color.rgb * (max(key_direction.y, 0.0) * seen);
    color = vec4(tone(albedo * light), 1.0);
}
