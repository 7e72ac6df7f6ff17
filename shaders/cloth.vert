layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 uv;
out vec2 cloth_uv;  // m
#if LIGHT_AT_VERTICES
uniform float vertex_gap;  // m, between neighbouring vertices
// Light on either side. A vertex on a ridge is seen through triangles of both.
out vec3 diffuse_front;
out vec3 sheen_front;
out vec3 diffuse_back;
out vec3 sheen_back;
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
    float visible =
        key_visibility(position, dot(normal, key_direction.xyz) >= 0.0 ? normal : -normal, normal, vertex_gap, true);
    vec3 front = seen_normal(normal, v), back = seen_normal(-normal, v);
    FabricLight light = fabric_light(front, front, v, mean_albedo[0], open.x, visible);
    diffuse_front = light.diffuse;
    sheen_front = light.sheen;
    light = fabric_light(back, back, v, mean_albedo[1], open.y, visible);
    diffuse_back = light.diffuse;
    sheen_back = light.sheen;
#else
    world = position;
    world_normal = normal;
    openness = open;
#endif
    gl_Position = view_projection * vec4(position, 1.0);
}
