// Cloth: the weave under its light.
// LIGHT_AT_VERTICES: the mesh is so fine that its triangles are a few pixels large; light then varies no faster than
// vertices tell, and is worked out there.
#if PICTURE
uniform sampler2D picture;
uniform vec2 picture_scale;  // 1/m; v points up, rows of the picture go down
#endif
in vec2 cloth_uv;
#if LIGHT_AT_VERTICES
in vec3 diffuse_front;
in vec3 sheen_front;
in vec3 diffuse_back;
in vec3 sheen_back;
#else
in vec3 world;
in vec3 world_normal;
in vec2 openness;
#endif
out vec4 color;

#if !LIGHT_AT_VERTICES
vec3 face_normal() { return cross(dFdx(world), dFdy(world)); }

// Directions of u and v on the surface, from how place and cloth change across the pixel: m along the surface for each
// m of cloth. Zero where they can't be told.
mat2x3 along_cloth() {
    vec3 px = dFdx(world), py = dFdy(world);
    vec2 ux = dFdx(cloth_uv), uy = dFdy(cloth_uv);
    float area = ux.x * uy.y - ux.y * uy.x;
    if (abs(area) < 1e-20) return mat2x3(0.0);
    return mat2x3((px * uy.y - py * ux.y) / area, (py * ux.x - px * uy.x) / area);
}

// The normal of threads that are tilted along u and v.
vec3 tilted(vec3 n, vec2 tilt, mat2x3 along) {
    if (tilt == vec2(0.0) || along == mat2x3(0.0)) return n;
    return normalize(n + 0.8 * (normalize(along[0]) * tilt.x + normalize(along[1]) * tilt.y));
}

// What a finished pixel covers of the cloth, as two vectors of (u, v) [m]: across the line of sight, and along the way
// that the surface leans, where it is longer. By the smooth normal: windows that follow triangles show them.
mat2 pixel_on_cloth(vec3 n, vec3 v, mat2x3 along) {
    float far = distance(eye.xyz, world) * float(SUPERSAMPLE) / viewport.z, facing = max(dot(n, v), 0.05);
    vec3 leaning = v - n * dot(v, n);
    leaning = dot(leaning, leaning) > 1e-8 ? normalize(leaning) : normalize(along[0]);
    vec3 side = cross(n, leaning);
    vec2 length2 = max(vec2(dot(along[0], along[0]), dot(along[1], along[1])), vec2(1e-8));
    return mat2(vec2(dot(side, along[0]), dot(side, along[1])) / length2 * far,
                vec2(dot(leaning, along[0]), dot(leaning, along[1])) / length2 * (far / facing));
}
#endif

void main() {
#if LIGHT_AT_VERTICES
    vec2 ux = dFdx(cloth_uv) * float(SUPERSAMPLE), uy = dFdy(cloth_uv) * float(SUPERSAMPLE);
    Woven cloth = woven(cloth_uv, mat2(ux, uy), gl_FrontFacing);
    FabricLight light =
        gl_FrontFacing ? FabricLight(diffuse_front, sheen_front) : FabricLight(diffuse_back, sheen_back);
#else
    vec3 v = normalize(eye.xyz - world);
    vec3 n = seen_normal(normalize(world_normal) * (gl_FrontFacing ? 1.0 : -1.0), v);
    mat2x3 along = along_cloth();
    Woven cloth = woven(cloth_uv, pixel_on_cloth(n, v, along), gl_FrontFacing);
#ifdef SAMPLED
    float open = sampled_openness(world, n);
#else
    float open = gl_FrontFacing ? openness.x : openness.y;
#endif
    float visible = key_visibility(world, dot(n, key_direction.xyz) >= 0.0 ? n : -n, face_normal(), 0.0, true);
    FabricLight light = fabric_light(n, tilted(n, cloth.tilt, along), v, mean_albedo[gl_FrontFacing ? 0 : 1],
                                     open, visible);
#endif
#if PICTURE
    if (gl_FrontFacing) cloth.albedo = texture(picture, vec2(0.0, 1.0) + cloth_uv * picture_scale * vec2(1.0, -1.0)).rgb;
#endif
    color = vec4(written(tone(cloth.albedo * light.diffuse + light.sheen)), 1.0);
}
