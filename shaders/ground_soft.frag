// The visible share without the pattern of its lookups: four linear ones at corners of texels, the mean of the 4 × 4
// texels over which the pattern repeats. Its window leads by half a texel; ground.frag takes that back.
uniform sampler2D visible_map;
in vec2 at_map;
out vec4 color;

void main() {
    vec2 texel = 1.0 / vec2(textureSize(visible_map, 0));
    color = 0.25 * (texture(visible_map, at_map + texel * vec2(-0.5, -0.5)) +
                    texture(visible_map, at_map + texel * vec2(1.5, -0.5)) +
                    texture(visible_map, at_map + texel * vec2(-0.5, 1.5)) +
                    texture(visible_map, at_map + texel * vec2(1.5, 1.5)));
}
