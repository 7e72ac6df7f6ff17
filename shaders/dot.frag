uniform float radius;
uniform float strength;
in vec2 within;
flat in vec3 dot_color;
uniform bool encodes;
out vec4 color;

void main() { color = vec4(encodes ? encoded(dot_color) : dot_color, 1.0) * (strength * clamp(radius + 0.5 - length(within), 0.0, 1.0)); }
