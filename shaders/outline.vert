// One edge of an outline as a quad around it: four vertices an edge, found by their number.
uniform samplerBuffer ends;  // place [m]; 1: of a solid
flat out vec4 line;          // both ends [px]
flat out vec2 line_depth;    // at both ends

void main() {
    int edge = gl_VertexID >> 2;
    float end = float(gl_VertexID & 1), side = float(gl_VertexID & 2) - 1.0;
    vec4 a = texelFetch(ends, 2 * edge), b = texelFetch(ends, 2 * edge + 1);
    vec4 ca = view_projection * vec4(a.xyz, 1.0), cb = view_projection * vec4(b.xyz, 1.0);
    gl_Position = vec4(0.0, 0.0, 2.0, 1.0);  // outside the picture
    line = vec4(0.0);
    line_depth = vec2(0.0);
    if (min(ca.w, cb.w) < 1e-3) return;
    vec2 pa = (ca.xy / ca.w * 0.5 + 0.5) * viewport.xy, pb = (cb.xy / cb.w * 0.5 + 0.5) * viewport.xy;
    // An outline lies on what it bounds: it is taken to be a little nearer; a solid's is where the solid yields to.
    vec3 la = a.xyz + normalize(eye.xyz - a.xyz) * (viewport.w - a.w * shadow.w);
    vec3 lb = b.xyz + normalize(eye.xyz - b.xyz) * (viewport.w - b.w * shadow.w);
    vec4 da = view_projection * vec4(la, 1.0), db = view_projection * vec4(lb, 1.0);
    line = vec4(pa, pb);
    line_depth = vec2(da.z / da.w, db.z / db.w) * 0.5 + 0.5;
    vec2 run = pb - pa;
    float length_px = length(run);
    vec2 forward = length_px > 1e-4 ? run / length_px : vec2(1.0, 0.0);
    vec2 at = (end < 0.5 ? pa - forward * 0.75 : pb + forward * 0.75) + vec2(-forward.y, forward.x) * (0.8 * side);
    gl_Position = vec4(at / viewport.xy * 2.0 - 1.0, 0.0, 1.0);
}
