// Share of the key light that reaches a place on the ground.
in vec3 place;
out vec4 color;

void main() {
    vec3 at = (shadow_matrix * vec4(place, 1.0)).xyz;
    color = vec4(soft_visibility(shadow_depth, at, ivec4(ivec2(0), textureSize(shadow_depth, 0)), key_direction.w, 0.0,
                                 shadow.x / shadow.y, pattern_turn(), 6, 8));
}
