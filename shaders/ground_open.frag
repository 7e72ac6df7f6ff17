// How much of the sky a place on the ground sees. Each map stands for a broad cone of sky: its shadow is as soft as
// that of a lamp that wide.
in vec3 place;
out vec4 color;

void main() {
    float turn = pattern_turn();
    float open = 0.0, all = 0.0;
    for (int k = 0; k < SKY_DIRECTIONS; ++k) {
        vec3 at = (sky_matrix[k] * vec4(place, 1.0)).xyz;
        ivec2 size = textureSize(sky_depth, 0) / ivec2(4, 2);
        ivec4 tile = ivec4(ivec2(k % 4, k / 4) * size, size);
        at.xy = at.xy * vec2(4.0, 2.0) - vec2(k % 4, k / 4);
        float weight = sky_direction[k].y;
        open += weight * soft_visibility(sky_depth, at, vec2(0.0), tile, 0.5, shadow.x / shadow.y, Turn(turn, turn / 6.2831853, 1.0), 5, 8).x;
        all += weight;
    }
    color = vec4(open / all);
}
