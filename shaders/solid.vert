layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
uniform mat4 model;
out vec3 world;
out vec3 world_normal;
out float openness;
#if PICTURE
out vec3 local;
out vec3 local_normal;
#endif

void main() {
    world = (model * vec4(position, 1.0)).xyz;
    world_normal = normalize(mat3(model) * normal);
    openness = sky_openness(world, world_normal).x;
#if PICTURE
    local = position;
    local_normal = normal;
#endif
    gl_Position = yielding(world);
}
