// Component view: no more of the ground than tells where it lies.
uniform vec3 albedo;
uniform vec2 fade;
in vec2 from_centre;
out vec4 color;

void main() { color = vec4(mix(albedo, background.rgb, smoothstep(fade.x, fade.y, length(from_centre))), 1.0); }
