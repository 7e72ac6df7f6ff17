// What is written of linear light. ENCODED: the target takes colours as they are; else it encodes them by itself.
#if ENCODED
vec3 written(vec3 light) { return encoded(light); }
#else
vec3 written(vec3 light) { return light; }
#endif
