// Place of a solid's point in the picture, with the depth of one a little further away.
vec4 yielding(vec3 p) {
    vec4 at = view_projection * vec4(p, 1.0), behind = view_projection * vec4(p + normalize(p - eye.xyz) * shadow.w, 1.0);
    return vec4(at.xy, behind.z / behind.w * at.w, at.w);
}
