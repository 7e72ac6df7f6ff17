// All of a map that lies on the ground.
uniform float level;  // m, of the ground
uniform vec4 region;  // x, z of the map's corner; its size [m]
out vec3 place;
out vec2 at_map;

void main() {
    vec2 corner = vec2(gl_VertexID == 1 ? 2.0 : 0.0, gl_VertexID == 2 ? 2.0 : 0.0);
    at_map = corner;
    vec2 xz = region.xy + corner * region.zw;
    place = vec3(xz.x, level, xz.y);
    gl_Position = vec4(2.0 * corner - 1.0, 0.0, 1.0);
}
