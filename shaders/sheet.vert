// Component view: the cloth's surface, which hides wires behind it and carries some of their colour.
layout(location = 0) in vec3 position;
layout(location = 3) in vec4 component;  // sRGB
uniform float strength;                  // share of the colour
out vec3 surface_color;

void main() {
    surface_color = linear(component.rgb) * strength;
    gl_Position = view_projection * vec4(position, 1.0);
}
