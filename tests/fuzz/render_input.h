// Choices that the bytes of an input make. Past its end all bytes are 0: the first choice of each.
#pragma once

#include <afterglow/afterglow.h>

#include <stddef.h>
#include <stdint.h>

struct render_input {
    const uint8_t *data;
    size_t size, at;
};

uint8_t input_byte(struct render_input *in);
int input_choice(struct render_input *in, int count); // 0…count − 1
bool input_bool(struct render_input *in);
// A value of a table of ordinary and extreme ones, or any four bytes: infinities and NaN, too.
float input_number(struct render_input *in);
float input_size(struct render_input *in); // above 0 mostly
void input_vector(struct render_input *in, float out[3]);
// Nothing below 0.
void input_light(struct render_input *in, float out[3]);
// Column-major: translation · rotation · scale, also mirrored, flat and sheared.
void input_matrix(struct render_input *in, float out[16]);
void input_camera(struct render_input *in, struct ag_camera *out);
void input_punctual(struct render_input *in, struct ag_light_desc *out);
void input_material(struct render_input *in, struct ag_material_desc *out);

enum { INPUT_SPEC_SIZE = 4096 };
// A GI spec of techniques of the catalogue, with options from their least to their largest value,
// but for those that take long.
void input_spec(struct render_input *in, char out[INPUT_SPEC_SIZE]);
