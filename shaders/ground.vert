layout(location = 0) in vec3 position;
uniform vec4 region;
out vec2 at_map;
out vec2 from_centre;  // m

void main() {
    at_map = (position.xz - region.xy) / region.zw;
    from_centre = position.xz - ground.xy;
    gl_Position = view_projection * vec4(position, 1.0);
}
