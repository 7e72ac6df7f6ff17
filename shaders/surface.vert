// Component view: surfaces that carry the wires.
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 3) in vec4 component;  // sRGB
uniform mat4 model;
out vec3 world;
out vec3 world_normal;
out vec3 surface_color;

void main() {
    world = (model * vec4(position, 1.0)).xyz;
    world_normal = mat3(model) * normal;
    surface_color = pow(component.rgb, vec3(2.2));
    gl_Position = view_projection * vec4(world, 1.0);
}
