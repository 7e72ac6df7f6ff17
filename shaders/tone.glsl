// Identity up to a shoulder, then highlights are compressed towards 1 without turning hue.
// After the Khronos PBR neutral tone mapper (2024), less its toe.
vec3 toned(vec3 color) {
    const float shoulder = 0.72;
    float peak = max(color.r, max(color.g, color.b));
    if (peak <= shoulder) return color;
    float room = 1.0 - shoulder, pressed = 1.0 - room * room / (peak + room - shoulder);
    float white = 1.0 - 1.0 / (0.2 * (peak - pressed) + 1.0);
    return mix(color * (pressed / peak), vec3(pressed), white);
}

// Of SAMPLED pictures the mean is taken first, of light; develop.frag makes a picture of it.
#ifdef SAMPLED
vec3 tone(vec3 color) { return color; }
#else
vec3 tone(vec3 color) { return toned(color); }
#endif
