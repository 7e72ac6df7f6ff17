// Light on cloth: wrapped diffuse with a sheen of fibres standing off the surface, light through the cloth, two sides.
// Sheen: "Charlie" distribution [Estevez & Kulla 2017, Production Friendly Microfacet Sheen BRDF], with the visibility
// term of Neubelt & Pettineo 2013; energy-conserving wrap as in Filament's cloth model.
uniform vec3 mean_albedo[2];  // of front and back: colours what is too broad to show the weave

const float roughness = 0.42;
const float wrap = 0.25;

// The cloth's colour is albedo × diffuse + sheen.
struct FabricLight {
    vec3 diffuse, sheen;
};

float charlie(float nh) {
    float inverse = 1.0 / roughness, sine2 = max(1.0 - nh * nh, 0.008);
    return (2.0 + inverse) * pow(sine2, 0.5 * inverse) * (0.5 / 3.14159265);
}

// The normal on the side that is seen. Near a silhouette the smooth normal may look away from the viewer, which the
// surface itself does not.
vec3 seen_normal(vec3 n, vec3 v) { return normalize(n + v * max(0.0, 0.04 - dot(n, v))); }

//   smooth_n  of the surface; n: of its threads; both on the seen side
//   open      share of the sky
//   visible   share of the key light that reaches this place, on whichever side faces it
FabricLight fabric_light(vec3 smooth_n, vec3 n, vec3 v, vec3 mean, float open, float visible) {
    vec3 l = key_direction.xyz;
    float nv = clamp(dot(n, v), 0.02, 1.0), nl = dot(n, l), surface_nl = dot(smooth_n, l);
    vec3 fibres = mix(vec3(0.04), sqrt(mean), 0.35);

    // Light falls on this side, or comes through from the other one.
    vec3 key = key_color.rgb * visible;
    // The wrap may not carry light past where the surface itself turns its back on the lamp.
    float diffuse = clamp((nl + wrap) / ((1.0 + wrap) * (1.0 + wrap)), 0.0, 1.0) * smoothstep(-0.12, 0.18, surface_nl);
    float nh = clamp(dot(n, normalize(l + v)), 0.0, 1.0), lit = max(nl, 0.0);
    float away2 = (1.0 - nv) * (1.0 - nv), rim = away2 * away2;
    vec3 ambient = ambient_light(n) * (0.12 + 0.88 * open);

    FabricLight light;
    light.diffuse = key * (diffuse + mean * (0.22 * max(-surface_nl, 0.0)));
    light.diffuse += fill_color.rgb * (max(0.0, 0.3 + 0.7 * dot(n, fill_direction.xyz)) * open) + ambient;
    light.sheen = fibres * (key * (charlie(nh) * lit * 3.14159265 / (4.0 * (lit + nv - lit * nv))));
    // A rim of fibres that catch light from all around.
    light.sheen += fibres * ambient * (0.45 * rim);
    return light;
}
