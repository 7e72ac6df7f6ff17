// Cloth: wrapped diffuse with a sheen of fibres standing off the surface, light through the cloth, two sides.
// Sheen: "Charlie" distribution [Estevez & Kulla 2017, Production Friendly Microfacet Sheen BRDF], with the visibility
// term of Neubelt & Pettineo 2013; energy-conserving wrap as in Filament's cloth model.
#if PICTURE
uniform sampler2D picture;
uniform vec2 picture_scale;  // 1/m
#endif
in vec3 world;
in vec3 world_normal;
in vec2 cloth_uv;
in vec2 openness;
out vec4 color;

const float roughness = 0.42;
const float wrap = 0.25;

float charlie(float nh) {
    float inverse = 1.0 / roughness, sine2 = max(1.0 - nh * nh, 0.008);
    return (2.0 + inverse) * pow(sine2, 0.5 * inverse) * (0.5 / 3.14159265);
}

void main() {
    vec3 v = normalize(eye.xyz - world);
    float side = gl_FrontFacing ? 1.0 : -1.0;
    vec3 smooth_n = normalize(world_normal) * side;
    // Near a silhouette the smooth normal may look away from the viewer, which the surface itself does not.
    smooth_n = normalize(smooth_n + v * max(0.0, 0.04 - dot(smooth_n, v)));
    float open = gl_FrontFacing ? openness.x : openness.y;

    Woven cloth = woven(cloth_uv, gl_FrontFacing);
#if PICTURE
    if (gl_FrontFacing) cloth.albedo = texture(picture, cloth_uv * picture_scale).rgb;
#endif
    vec3 n = smooth_n;
#if WEAVE != 4
    // Directions of u and v on the surface, from how both change across the pixel.
    vec3 px = dFdx(world), py = dFdy(world);
    vec2 ux = dFdx(cloth_uv), uy = dFdy(cloth_uv);
    float area = ux.x * uy.y - ux.y * uy.x;
    for (int near = cloth.tilt != vec2(0.0) && abs(area) > 1e-20 ? 1 : 0; near > 0; --near) {
        vec3 along_u = normalize((px * uy.y - py * ux.y) * sign(area));
        vec3 along_v = normalize((py * ux.x - px * uy.x) * sign(area));
        n = normalize(n + 0.8 * (along_u * cloth.tilt.x + along_v * cloth.tilt.y));
    }
#endif

    vec3 l = key_direction.xyz;
    float nv = clamp(dot(n, v), 0.02, 1.0), nl = dot(n, l), surface_nl = dot(smooth_n, l);
    vec3 sheen_color = mix(vec3(0.04), sqrt(cloth.albedo), 0.35);

    // Light falls on this side, or comes through from the other one.
    float seen = key_visibility(world, surface_nl >= 0.0 ? smooth_n : -smooth_n);
    vec3 lit = vec3(0.0);
    if (seen > 0.0) {
        float diffuse = clamp((nl + wrap) / ((1.0 + wrap) * (1.0 + wrap)), 0.0, 1.0);
        // The wrap may not carry light past where the surface itself turns its back on the lamp.
        diffuse *= smoothstep(-0.12, 0.18, surface_nl);
        lit += cloth.albedo * diffuse;
        lit += cloth.albedo * cloth.albedo * (0.22 * max(-surface_nl, 0.0));
        if (nl > 0.0) {
            float nh = clamp(dot(n, normalize(l + v)), 0.0, 1.0);
            lit += sheen_color * (charlie(nh) * nl * 3.14159265 / (4.0 * (nl + nv - nl * nv)));
        }
        lit *= seen;
    }
    vec3 result = lit * key_color.rgb;
    result += cloth.albedo * fill_color.rgb * (max(0.0, 0.3 + 0.7 * dot(n, fill_direction.xyz)) * open);
    // Ambient: openness to the sky, and a rim of fibres that catch light from all around.
    float rim = pow(1.0 - nv, 4.0);
    result += (cloth.albedo + sheen_color * (0.45 * rim)) * ambient_light(n) * (0.12 + 0.88 * open);
    color = vec4(tone(result), 1.0);
}
