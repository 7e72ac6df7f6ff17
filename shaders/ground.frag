// The ground as it is seen: looked up, and faded into the background.
uniform sampler2D map;
uniform vec2 fade;  // m from the centre: where it begins and ends
in vec2 at_map;
in vec2 from_centre;
out vec4 color;

void main() {
    color = vec4(mix(texture(map, at_map).rgb, background.rgb, smoothstep(fade.x, fade.y, length(from_centre))), 1.0);
}
