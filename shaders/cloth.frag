// Cloth: the weave under its light.
// LIGHT_AT_VERTICES: the mesh is so fine that its triangles are a few pixels large; light then varies no faster than
// vertices tell, and is worked out there.
#if PICTURE
uniform sampler2D picture;
uniform vec2 picture_scale;  // 1/m
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
// The normal of threads that are tilted along u and v. Directions of u and v on the surface come from how place and
// cloth change across the pixel.
vec3 tilted(vec3 n, vec2 tilt) {
    vec3 px = dFdx(world), py = dFdy(world);
    vec2 ux = dFdx(cloth_uv), uy = dFdy(cloth_uv);
    float area = ux.x * uy.y - ux.y * uy.x;
    if (tilt == vec2(0.0) || abs(area) < 1e-20) return n;
    vec3 along_u = normalize((px * uy.y - py * ux.y) * sign(area));
    vec3 along_v = normalize((py * ux.x - px * uy.x) * sign(area));
    return normalize(n + 0.8 * (along_u * tilt.x + along_v * tilt.y));
}
#endif

void main() {
    Woven cloth = woven(cloth_uv, gl_FrontFacing);
#if PICTURE
    if (gl_FrontFacing) cloth.albedo = texture(picture, cloth_uv * picture_scale).rgb;
#endif
#if LIGHT_AT_VERTICES
    FabricLight light =
        gl_FrontFacing ? FabricLight(diffuse_front, sheen_front) : FabricLight(diffuse_back, sheen_back);
#else
    vec3 v = normalize(eye.xyz - world);
    vec3 n = seen_normal(normalize(world_normal) * (gl_FrontFacing ? 1.0 : -1.0), v);
    float visible =
        key_visibility(world, dot(n, key_direction.xyz) >= 0.0 ? n : -n, 0.0, pattern_turn(), true);
    FabricLight light = fabric_light(n, tilted(n, cloth.tilt), v, mean_albedo[gl_FrontFacing ? 0 : 1],
                                     gl_FrontFacing ? openness.x : openness.y, visible);
#endif
    color = vec4(written(tone(cloth.albedo * light.diffuse + light.sheen)), 1.0);
}
