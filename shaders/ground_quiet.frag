// Component view: no more of the ground than tells where it lies.
uniform vec3 albedo;
uniform vec2 fade;
in vec2 from_centre;
out vec4 color;

void main() {
    float away = smoothstep(fade.x, fade.y, length(from_centre) / ground.w);
    color = vec4(written(mix(albedo, background.rgb, away)), 1.0);
}
