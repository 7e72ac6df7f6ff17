// One spring as a quad on the screen: four vertices an edge, found by their number. Wide GL lines are missing on many
// GPUs, and their width does not follow the picture's size.
uniform samplerBuffer points;    // particles' positions [m]
uniform samplerBuffer colors;    // particles' colours, sRGB
uniform usamplerBuffer edges;    // particle pairs
uniform samplerBuffer strengths; // 1 solid … 0 not drawn
uniform samplerBuffer edge_colors; // sRGB
uniform bool own_colors;         // edges have colours of their own
uniform float width;             // px
uniform float spacing;           // m, typical length of an edge at rest
noperspective out float across;  // px from the line's middle
noperspective out float along;   // 0 … 1
flat out vec3 color_a;
flat out vec3 color_b;
flat out vec2 pen;               // half width [px], opacity

void main() {
    int edge = gl_VertexID >> 2;
    float end = float(gl_VertexID & 1), side = float(gl_VertexID & 2) - 1.0;
    uvec2 ends = texelFetch(edges, edge).xy;
    float strength = texelFetch(strengths, edge).r;
    vec3 a = texelFetch(points, int(ends.x)).xyz, b = texelFetch(points, int(ends.y)).xyz;
    // Lift wires off the surface that hides those behind it.
    a += normalize(eye.xyz - a) * viewport.w;
    b += normalize(eye.xyz - b) * viewport.w;
    vec4 ca = view_projection * vec4(a, 1.0), cb = view_projection * vec4(b, 1.0);
    gl_Position = vec4(0.0, 0.0, 2.0, 1.0);  // outside the picture
    across = along = 0.0;
    color_a = color_b = vec3(0.0);
    pen = vec2(0.0);
    if (strength <= 0.0 || min(ca.w, cb.w) < 1e-3) return;

    vec2 pa = ca.xy / ca.w * 0.5 * viewport.xy, pb = cb.xy / cb.w * 0.5 * viewport.xy;
    vec2 run = pb - pa;
    float length_px = length(run);
    vec2 forward = length_px > 1e-4 ? run / length_px : vec2(1.0, 0.0);
    // Where springs stand closer than the pen is wide, a finer pen keeps them apart; below a pixel it pales instead.
    float gap = spacing * viewport.z / max(0.5 * (ca.w + cb.w), 1e-3);
    float fine = min(width, max(0.2 * gap, 0.25)), half_width = 0.5 * max(fine, 1.0);
    // Wires too dense to be told apart leave the field to the surface.
    pen = vec2(half_width, strength * min(fine, 1.0) * smoothstep(1.2, 4.0, gap));

    float reach = half_width + 0.5;
    vec4 clip = end < 0.5 ? ca : cb;
    vec2 offset = vec2(-forward.y, forward.x) * (side * reach);
    clip.xy += offset / (0.5 * viewport.xy) * clip.w;
    gl_Position = clip;
    across = side * reach;
    along = end;
    if (own_colors) {
        color_a = color_b = linear(texelFetch(edge_colors, edge).rgb);
    } else {
        color_a = linear(texelFetch(colors, int(ends.x)).rgb);
        color_b = linear(texelFetch(colors, int(ends.y)).rgb);
    }
}
