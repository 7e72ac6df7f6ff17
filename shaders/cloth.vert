layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 uv;
out vec2 cloth_uv;  // m
#if LIGHT_AT_VERTICES
out vec3 diffuse;
out vec3 sheen;
#else
out vec3 world;
out vec3 world_normal;
out vec2 openness;  // of the sky: front, back
#endif

void main() {
    cloth_uv = uv;
    vec2 open = sky_openness(position, normal);
#if LIGHT_AT_VERTICES
    vec3 v = normalize(eye.xyz - position);
    bool front = dot(normal, v) >= 0.0;
    vec3 n = seen_normal(front ? normal : -normal, v);
    FabricLight light = fabric_light(position, n, n, v, mean_albedo[front ? 0 : 1], front ? open.x : open.y, 0.0);
    diffuse = light.diffuse;
    sheen = light.sheen;
#else
    world = position;
    world_normal = normal;
    openness = open;
#endif
    gl_Position = view_projection * vec4(position, 1.0);
}
