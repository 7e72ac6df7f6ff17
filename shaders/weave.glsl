// Woven patterns from two yarns, filtered by the size of a pixel so that they fade to their mean and never alias.
// THREADS: some threads may be large enough to be seen.
// WEAVE: 0 plain, 1 twill, 2 checks, 3 stripes, 4 solid; known when the shader is built.
uniform float per_period;    // 1/m, of checks and stripes
uniform float per_thread;    // 1/m
uniform vec3 yarn_front[2];  // linear
uniform vec3 yarn_back[2];

struct Woven {
    vec3 albedo;
    vec2 tilt;  // of the surface along u and v, from the threads' roundness
};

// Mean over a window of width w of the square wave that is 1 on [0, 1/2) and repeats at 1.
float stripe(float x, float w) {
    float inside = 0.25 - abs(fract(x + 0.25) - 0.5);  // distance from the nearest edge
    // A box lets moiré through where a pixel nears half a stripe: fade to the mean before that.
    return mix(clamp(0.5 + inside / max(w, 1e-4), 0.0, 1.0), 0.5, clamp((w - 0.2) * 4.0, 0.0, 1.0));
}

#if THREADS && WEAVE != 4
// How much of a window of size w [threads] around s shows the thread along v: over one and under one, or over two and
// under two, one further in every row. Both are sums of products of waves in s.x and s.y, so each is filtered alone.
float warp_on_top(vec2 s, vec2 w) {
#if WEAVE == 1
    w *= 0.25;
    s *= 0.25;
    vec4 wave = 2.0 * vec4(stripe(s.x, w.x), stripe(s.x + 0.25, w.x), stripe(s.y, w.y), stripe(s.y + 0.25, w.y)) - 1.0;
    return 0.5 + 0.25 * ((wave.x + wave.y) * wave.z + (wave.x - wave.y) * wave.w);
#else
    w *= 0.5;
    s *= 0.5;
    return 0.5 + 0.5 * (2.0 * stripe(s.x, w.x) - 1.0) * (2.0 * stripe(s.y, w.y) - 1.0);
#endif
}
#endif

// `pixel`: how the window of one finished pixel reaches over the cloth: two vectors of (u, v) that span it [m].
Woven woven(vec2 uv, mat2 pixel, bool front) {
    vec3 a = front ? yarn_front[0] : yarn_back[0], b = front ? yarn_front[1] : yarn_back[1];
    vec2 size = abs(pixel[0]) + abs(pixel[1]);
    vec2 s = uv * per_thread, threads = size * per_thread;

    // Share of yarn a in the threads along v and along u, and in what is seen of both.
    float warp = 1.0, weft = 1.0, both = 1.0;
#if WEAVE == 0
    weft = 0.78;
    both = 0.89;
#elif WEAVE == 1
    weft = 0.0;
    both = stripe((s.x + s.y) * 0.25, (abs(pixel[0].x + pixel[0].y) + abs(pixel[1].x + pixel[1].y)) * (0.25 * per_thread));
#elif WEAVE == 2
    warp = stripe(uv.x * per_period, size.x * per_period);
    weft = stripe(uv.y * per_period, size.y * per_period);
    both = 0.5 * (warp + weft);
#elif WEAVE == 3
    warp = weft = both = stripe(uv.x * per_period, size.x * per_period);
#endif

    Woven result = Woven(mix(b, a, both), vec2(0.0));
#if THREADS && WEAVE != 4
    // Along each axis threads fade where they grow too fine for it, whatever the other one shows.
    vec2 detail = 1.0 - smoothstep(0.22, 0.6, threads);
    if (detail.x + detail.y > 0.0) {
        float top = warp_on_top(s, 1.4 * threads);
        vec2 cell = floor(s), within = fract(s) - 0.5, square = mix(vec2(1.0 / 12.0), within * within, detail);
        // Across the thread on top the surface is round; along it, it dives under its neighbours. Their mean is 1.
        vec2 shade = 1.154 - 1.27 * square - 0.58 * square.yx;
        vec2 own = fract(sin(vec2(cell.x, 78.233 + cell.y) * 12.9898) * 43758.5) - 0.5;  // no thread is like the next
        shade *= 1.0 + 0.12 * detail * own;
        vec3 color = mix(mix(b, a, weft) * shade.y, mix(b, a, warp) * shade.x, top);
        result.albedo = mix(result.albedo, color, max(detail.x, detail.y));
        result.tilt = detail * within * mix(vec2(0.5, 1.0), vec2(1.0, 0.5), top);
    }
#endif
    return result;
}
