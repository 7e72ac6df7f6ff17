layout(location = 0) in vec3 position;
uniform float extent;  // share of the square to be drawn
out vec2 from_centre;  // m

void main() {
    vec3 place = vec3(ground.x, position.y, ground.y);
    place.xz += (position.xz - ground.xy) * extent;
    from_centre = place.xz - ground.xy;
    gl_Position = view_projection * vec4(place, 1.0);
}
