// A pixel that an outline runs through: mixed with its neighbour beyond the line, by the share that lies there. Along
// the axis that the line is steeper to, so that one neighbour is enough.
uniform sampler2D picture;
uniform sampler2D depth;
flat in vec4 line;
flat in vec2 line_depth;
out vec4 color;

void main() {
    vec2 run = line.zw - line.xy, from = gl_FragCoord.xy - line.xy;
    bool upright = abs(run.y) > abs(run.x);
    float t = upright ? from.y / run.y : from.x / run.x;
    float across = upright ? t * run.x - from.x : t * run.y - from.y;  // px from here to the line
    float slack = 0.5 / max(abs(run.x), abs(run.y));
    if (!(abs(across) < 0.5) || t < -slack || t > 1.0 + slack) discard;
    ivec2 here = ivec2(gl_FragCoord.xy), step = across > 0.0 ? ivec2(1) : ivec2(-1);
    ivec2 there = here + step * ivec2(upright ? 1 : 0, upright ? 0 : 1);
    there = clamp(there, ivec2(0), textureSize(picture, 0) - 1);
    // What is hidden bounds nothing.
    if (mix(line_depth.x, line_depth.y, clamp(t, 0.0, 1.0)) >
        max(texelFetch(depth, here, 0).r, texelFetch(depth, there, 0).r))
        discard;
    vec4 own = texelFetch(picture, here, 0), other = texelFetch(picture, there, 0);
#if ENCODED
    // Squares are near enough to linear light for a mean of two.
    vec4 mixed = mix(own * own, other * other, 0.5 - abs(across));
    color = vec4(sqrt(mixed.rgb), 1.0);
#else
    color = mix(own, other, 0.5 - abs(across));
#endif
}
