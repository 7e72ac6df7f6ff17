layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 uv;
out vec3 world;
out vec3 world_normal;
out vec2 cloth_uv;   // m
out vec2 openness;   // of the sky: front, back

void main() {
    world = position;
    world_normal = normal;
    cloth_uv = uv;
    openness = sky_openness(position, normal);
    gl_Position = view_projection * vec4(position, 1.0);
}
