layout(location = 0) in vec3 position;
uniform vec2 fade;     // shares of the ground's reach
out vec2 from_centre;  // m

void main() {
    from_centre = position.xz * (fade.y * ground.w);
    gl_Position = view_projection * vec4(ground.x + from_centre.x, position.y, ground.y + from_centre.y, 1.0);
}
