// The ground between its light and its shadow.
uniform sampler2D soft_map;
in vec2 at_map;
in vec3 lit;
in vec3 shadowed;
out vec4 color;

void main() { color = vec4(written(mix(shadowed, lit, texture(soft_map, at_map).r)), 1.0); }
