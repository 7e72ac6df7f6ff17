// One of 16 angles of a 4 × 4 ordered pattern: neighbouring pixels look up different rings.
float pattern_turn() {
    ivec2 cell = ivec2(gl_FragCoord.xy) & 3;
    return float(((cell.x ^ cell.y) & 1) * 8 + (cell.y & 1) * 4 + (((cell.x ^ cell.y) >> 1) & 1) * 2 +
                 ((cell.y >> 1) & 1)) * (6.2831853 / 16.0);
}
