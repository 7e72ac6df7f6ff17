// What every shader of one frame shares; render/frame_block.hpp says what each member means.
const int SKY_DIRECTIONS = 8;

layout(std140) uniform Frame {
    mat4 view_projection;
    mat4 shadow_matrix;
    mat4 sky_matrix[SKY_DIRECTIONS];
    vec4 sky_direction[SKY_DIRECTIONS];
    vec4 eye;
    vec4 key_direction;
    vec4 key_color;
    vec4 fill_direction;
    vec4 fill_color;
    vec4 sky_color;
    vec4 bounce_color;
    vec4 background;
    vec4 ground;
    vec4 shadow;
    vec4 viewport;
    vec4 sky_harmonics[9];
};
