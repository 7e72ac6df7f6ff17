uniform float radius;
in vec2 within;
flat in vec3 dot_color;
out vec4 color;

void main() { color = vec4(dot_color, 1.0) * clamp(radius + 0.5 - length(within), 0.0, 1.0); }
