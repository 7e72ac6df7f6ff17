// A particle as a disc on the screen: four vertices a particle.
uniform samplerBuffer points;
uniform samplerBuffer colors;
uniform float radius;  // px
out vec2 within;       // px from the disc's middle
flat out vec3 dot_color;

void main() {
    int particle = gl_VertexID >> 2;
    vec2 corner = vec2(float(gl_VertexID & 1), float((gl_VertexID >> 1) & 1)) * 2.0 - 1.0;
    vec3 p = texelFetch(points, particle).xyz;
    p += normalize(eye.xyz - p) * (1.5 * viewport.w);
    vec4 clip = view_projection * vec4(p, 1.0);
    within = corner * (radius + 0.5);
    clip.xy += within / (0.5 * viewport.xy) * clip.w;
    gl_Position = clip;
    dot_color = linear(texelFetch(colors, particle).rgb);
}
