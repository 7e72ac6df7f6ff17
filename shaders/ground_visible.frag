// Share of the key light that reaches a place on the ground.
in vec3 place;
out vec4 color;

void main() {
    vec3 at = (shadow_matrix * vec4(place, 1.0)).xyz;
    float turn = pattern_turn();
    color = vec4(soft_visibility(shadow_depth, at, rise_of(shadow_matrix, vec3(0.0, 1.0, 0.0)),
                                 ivec4(ivec2(0), textureSize(shadow_depth, 0)), key_direction.w, 1.5 * shadow.x / shadow.y,
                                 Turn(turn, turn / 6.2831853, 1.0), 6, 8).x);
}
