// What lies behind everything.
// KIND: 1 a gradient, 2 a picture, 3 the sky's image
uniform sampler2D picture;
uniform vec3 bottom, top;  // sRGB
uniform vec2 size;         // of the target [px]
uniform vec2 window;       // share of the picture that is seen, along x and y
uniform mat3 rays;         // from (x, y, 1), with x and y in [-1, 1] over the target, to a direction
out vec4 color;

void main() {
    vec2 at = gl_FragCoord.xy / size;
#if KIND == 1
    vec3 light = linear(mix(bottom, top, at.y));
#elif KIND == 2
    vec2 place = 0.5 + (at - 0.5) * window;
    vec3 light = textureLod(picture, vec2(place.x, 1.0 - place.y), 0.0).rgb;
#else
    vec3 way = normalize(rays * vec3(2.0 * at - 1.0, 1.0));
    vec2 place = vec2(0.5 + atan(way.x, -way.z) * 0.15915494, acos(clamp(way.y, -1.0, 1.0)) * 0.31830989);
    vec3 light = textureLod(picture, place, 0.0).rgb;
#endif
    color = vec4(written(light), 1.0);
}
