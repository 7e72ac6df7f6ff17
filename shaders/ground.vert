// The ground as it is seen, faded into the background with distance. A grid of vertices, finer in the middle, tells the
// fade. GRID: its cells along a side.
uniform float level;  // m
out vec2 ground_place;  // x, z [m]
out float away;

void main() {
    vec2 t = vec2(gl_VertexID % (GRID + 1), gl_VertexID / (GRID + 1)) * (2.0 / float(GRID)) - 1.0;
    vec2 from_centre = ground.w * t * (0.25 + 0.75 * t * t);
    ground_place = ground.xy + from_centre;
    away = length(from_centre);
    gl_Position = view_projection * vec4(ground_place.x, level, ground_place.y, 1.0);
}
