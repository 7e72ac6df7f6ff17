// Woven patterns from two yarns, filtered by the size of a pixel so that they fade to their mean and never alias.
// WEAVE: 0 plain, 1 twill, 2 checks, 3 stripes, 4 solid; known when the shader is built.
uniform float period;        // m, of checks and stripes
uniform float thread;        // m, between threads
uniform vec3 yarn_front[2];  // linear
uniform vec3 yarn_back[2];

struct Woven {
    vec3 albedo;
    vec2 tilt;  // of the surface along u and v, from the threads' roundness
};

// Mean over a window of width w of the square wave that is 1 on [0, duty) and repeats at 1.
float stripe(float x, float duty, float w) {
    w = max(w, 1e-4);
    vec2 at = vec2(x - 0.5 * w, x + 0.5 * w);
    vec2 integral = floor(at) * duty + min(fract(at), duty);
    // A box lets moiré through where a pixel nears half a stripe: fade to the mean before that.
    return mix((integral.y - integral.x) / w, duty, smoothstep(0.2, 0.45, w));
}

Woven woven(vec2 uv, bool front) {
    vec3 a = front ? yarn_front[0] : yarn_back[0], b = front ? yarn_front[1] : yarn_back[1];
    vec2 size = fwidth(uv);
    vec2 s = uv / thread, pixel = size / thread;

    vec3 warp = a, weft = a;  // threads along v and along u
    float over = 0.5;         // share of warp on top
#if WEAVE == 0
    weft = mix(a, b, 0.22);
#elif WEAVE == 1
    weft = b;
    over = stripe((s.x + s.y) / 4.0, 0.5, (pixel.x + pixel.y) / 4.0);
#elif WEAVE == 2
    warp = mix(b, a, stripe(uv.x / period, 0.5, size.x / period));
    weft = mix(b, a, stripe(uv.y / period, 0.5, size.y / period));
#elif WEAVE == 3
    warp = mix(b, a, stripe(uv.x / period, 0.5, size.x / period));
    weft = warp;
#endif

    Woven result = Woven(mix(weft, warp, over), vec2(0.0));
#if WEAVE != 4
    float detail = 1.0 - smoothstep(0.22, 0.6, max(pixel.x, pixel.y));
    // A loop and not an if, for the reason given in key_visibility.
    for (int near = detail > 0.0 ? 1 : 0; near > 0; --near) {
        vec2 cell = floor(s), within = fract(s) - 0.5;
        bool warp_on_top = WEAVE == 1 ? mod(cell.x + cell.y, 4.0) < 2.0 : mod(cell.x + cell.y, 2.0) < 1.0;
        // Across the thread on top the surface is round; along it, it dives under its neighbours.
        vec2 across = warp_on_top ? within : within.yx;
        float shade = 1.0 - 1.1 * across.x * across.x - 0.5 * across.y * across.y;
        float slub = fract(sin(dot(warp_on_top ? vec2(cell.x, 1.0) : vec2(2.0, cell.y), vec2(12.9898, 78.233))) * 43758.5);
        vec3 color = (warp_on_top ? warp : weft) * shade * 1.08 * (0.94 + 0.12 * slub);
        result.albedo = mix(result.albedo, color, detail);
        vec2 tilt = vec2(1.0 * across.x, 0.5 * across.y);
        result.tilt = detail * (warp_on_top ? tilt : tilt.yx);
    }
#endif
    return result;
}
