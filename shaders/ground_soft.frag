// The visible share without the pattern of its lookups: four linear ones, the mean of the 4 × 4 texels over which the
// pattern repeats.
uniform sampler2D visible_map;
in vec2 at_map;
out vec4 color;

void main() {
    vec2 step = 1.0 / vec2(textureSize(visible_map, 0));
    color = 0.25 * (texture(visible_map, at_map + step * vec2(-1.0, -1.0)) +
                    texture(visible_map, at_map + step * vec2(1.0, -1.0)) +
                    texture(visible_map, at_map + step * vec2(-1.0, 1.0)) +
                    texture(visible_map, at_map + step * vec2(1.0, 1.0)));
}
