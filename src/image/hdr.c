// A decoder of its own, as stb_image allocates before it checks and ignores EXPOSURE. Scan lines
// are unpacked twice: first all of them into one line, which proves that the file has them, then
// into the image. A short file with a header of 16384x16384 thus allocates 64 KiB.
#include "image/hdr.h"

#include "core/files/file.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

enum {
    LINE_BYTES = 256,  // that are read of a header line
    RLE_MIN_WIDTH = 8, // of the new run-length encoding
    MANTISSA_EXPONENT = 136,
};

struct input {
    const uint8_t *at, *end;
};

struct reader {
    struct host *host;
    const char *name;
    struct input lines; // from the first scan line on
    int width, height;
    double exposure;
};

static bool fail(const struct reader *reader, enum fail_kind kind, const char *why)
{
    return host_fail(reader->host, kind, "cannot read %s: %s", reader->name, why);
}

static bool fail_at_row(const struct reader *reader, int row, const char *why)
{
    return host_fail(reader->host, FAIL_FORMAT, "cannot read %s: row %d: %s", reader->name, row,
                     why);
}

// ---- header

// The next line, without its end and cut to the buffer; false where the input ends first.
static bool next_line(struct input *input, char out[LINE_BYTES])
{
    const size_t left = (size_t)(input->end - input->at);
    const uint8_t *newline = left > 0 ? memchr(input->at, '\n', left) : NULL;
    if (!newline) return false;
    size_t length = (size_t)(newline - input->at);
    if (length > LINE_BYTES - 1) length = LINE_BYTES - 1;
    memcpy(out, input->at, length);
    if (length > 0 && out[length - 1] == '\r') length--;
    out[length] = 0;
    input->at = newline + 1;
    return true;
}

static bool is_digit(char c)
{
    return c >= '0' && c <= '9';
}

// A side of the resolution line; values above the limit become limit + 1.
static bool parse_side(const char **at, int *out)
{
    if (!is_digit(**at)) return false;
    int value = 0;
    for (; is_digit(**at); ++*at)
        if (value <= IMAGE_MAX_SIZE) value = value * 10 + (**at - '0');
    *out = value <= IMAGE_MAX_SIZE ? value : IMAGE_MAX_SIZE + 1;
    return true;
}

static int parse_digits(const char **at, double *value)
{
    int count = 0;
    for (; is_digit(**at); ++*at, count++) *value = *value * 10.0 + (**at - '0');
    return count;
}

static bool parse_exponent(const char **at, int *out)
{
    enum { EXPONENT_MAX = 1000 }; // beyond a double's
    *out = 0;
    if (**at != 'e' && **at != 'E') return true;
    ++*at;
    const bool negative = **at == '-';
    if (**at == '-' || **at == '+') ++*at;
    if (!is_digit(**at)) return false;
    for (; is_digit(**at); ++*at)
        if (*out < EXPONENT_MAX) *out = *out * 10 + (**at - '0');
    if (negative) *out = -*out;
    return true;
}

// A positive decimal number; strtod would depend on the locale of the host program.
static bool parse_positive(const char *at, double *out)
{
    int exponent, decimals = 0;
    *out = 0.0;
    while (*at == ' ' || *at == '\t') at++;
    if (*at == '+') at++;
    int digits = parse_digits(&at, out);
    if (*at == '.') at++, decimals = parse_digits(&at, out);
    if (digits + decimals == 0 || !parse_exponent(&at, &exponent)) return false;
    while (*at == ' ' || *at == '\t') at++;
    *out *= pow(10.0, exponent - decimals);
    return *at == 0 && *out > 0.0 && isfinite(*out);
}

// "NAME=value": the value; NULL for other lines.
static const char *value_of(const char *line, const char *name)
{
    const size_t length = strlen(name);
    return strncmp(line, name, length) == 0 && line[length] == '=' ? line + length + 1 : NULL;
}

static bool read_variable(struct reader *reader, const char *line)
{
    const char *format = value_of(line, "FORMAT"), *exposure = value_of(line, "EXPOSURE");
    double factor;
    if (format) {
        while (*format == ' ') format++;
        if (strncmp(format, "32-bit_rle_rgbe", 15) == 0) return true;
        if (strncmp(format, "32-bit_rle_xyze", 15) == 0)
            return fail(reader, FAIL_UNSUPPORTED,
                        "its format is 32-bit_rle_xyze; convert it to 32-bit_rle_rgbe");
        return fail(reader, FAIL_FORMAT, "its FORMAT is not 32-bit_rle_rgbe");
    }
    if (exposure) {
        if (!parse_positive(exposure, &factor))
            return fail(reader, FAIL_FORMAT, "its EXPOSURE is not a positive number");
        reader->exposure *= factor;
        if (!(reader->exposure > 0.0) || !isfinite(reader->exposure))
            return fail(reader, FAIL_FORMAT, "the product of its EXPOSUREs is out of range");
    }
    return true;
}

static bool read_variables(struct reader *reader, struct input *input)
{
    char line[LINE_BYTES];
    if (!next_line(input, line) || (strcmp(line, "#?RADIANCE") != 0 && strcmp(line, "#?RGBE") != 0))
        return fail(reader, FAIL_FORMAT, "not a Radiance image");
    do {
        if (!next_line(input, line)) return fail(reader, FAIL_FORMAT, "its header has no end");
        if (!read_variable(reader, line)) return false;
    } while (line[0]);
    return true;
}

static bool is_axis(const char *text, char axis)
{
    return (text[0] == '-' || text[0] == '+') && text[1] == axis && text[2] == ' ';
}

static bool read_resolution(struct reader *reader, struct input *input)
{
    char line[LINE_BYTES];
    int first, second;
    if (!next_line(input, line)) return fail(reader, FAIL_FORMAT, "it has no resolution line");
    const char axis = line[0] ? line[1] : 0;
    const char *at = line + 3, *second_axis;
    if (!is_axis(line, 'Y') && !is_axis(line, 'X')) goto malformed;
    if (!parse_side(&at, &first) || *at++ != ' ') goto malformed;
    second_axis = at;
    if (!is_axis(second_axis, axis == 'Y' ? 'X' : 'Y')) goto malformed;
    at += 3;
    if (!parse_side(&at, &second) || *at) goto malformed;
    if (strncmp(line, "-Y", 2) != 0 || strncmp(second_axis, "+X", 2) != 0)
        return host_fail(reader->host, FAIL_UNSUPPORTED,
                         "cannot read %s: its orientation is %.2s %.2s, only -Y +X is supported",
                         reader->name, line, second_axis);
    if (first < 1 || second < 1 || first > IMAGE_MAX_SIZE || second > IMAGE_MAX_SIZE)
        return host_fail(reader->host, FAIL_FORMAT,
                         "cannot read %s: its resolution is '%.60s', each side must be 1 to %d",
                         reader->name, line, IMAGE_MAX_SIZE);
    reader->height = first;
    reader->width = second;
    return true;
malformed:
    return fail(reader, FAIL_FORMAT, "its resolution line is not '-Y height +X width'");
}

// ---- scan lines: `rgbe` receives width × 4 bytes; NULL, or why it failed

static const char TOO_SHORT[] = "the file ends too early";

static const char *unpack_channel(struct input *input, int width, uint8_t *out)
{
    for (int x = 0; x < width;) {
        if (input->end - input->at < 2) return TOO_SHORT;
        const int code = *input->at++;
        const bool is_run = code > 128;
        const int count = is_run ? code - 128 : code;
        if (count == 0) return "it has an empty run";
        if (count > width - x) return "a run exceeds the scan line";
        if (!is_run && input->end - input->at < count) return TOO_SHORT;
        for (int i = 0; i < count; i++, x++) out[4 * x] = is_run ? *input->at : *input->at++;
        if (is_run) input->at++;
    }
    return NULL;
}

// The channels one after the other, each with runs and literals, behind 2, 2 and the width.
static const char *unpack_new(struct input *input, int width, uint8_t *rgbe)
{
    const char *why = NULL;
    if ((input->at[2] << 8 | input->at[3]) != width) return "its scan line has another width";
    input->at += 4;
    for (int c = 0; c < 4 && !why; c++) why = unpack_channel(input, width, rgbe + c);
    return why;
}

// Pixels, and in the old encoding runs: 1, 1, 1 and a count repeat the pixel before. The first
// of consecutive counts has the lowest eight bits. Mantissas of a flat line are never all 1.
static const char *unpack_old(struct input *input, int width, uint8_t *rgbe)
{
    enum { SHIFT_MAX = 24 };
    int shift = 0;
    for (int x = 0; x < width;) {
        if (input->end - input->at < 4) return TOO_SHORT;
        const uint8_t *pixel = input->at;
        input->at += 4;
        if (pixel[0] != 1 || pixel[1] != 1 || pixel[2] != 1) {
            memcpy(rgbe + 4 * x++, pixel, 4);
            shift = 0;
            continue;
        }
        const uint32_t count = (uint32_t)pixel[3] << shift;
        if (x == 0) return "it begins with a run";
        if (shift == SHIFT_MAX || count > (uint32_t)(width - x))
            return "a run exceeds the scan line";
        for (uint32_t i = 0; i < count; i++, x++) memcpy(rgbe + 4 * x, rgbe + 4 * (x - 1), 4);
        shift += 8;
    }
    return NULL;
}

static const char *unpack_line(struct input *input, int width, uint8_t *rgbe)
{
    const uint8_t *at = input->at;
    const bool is_new =
        width >= RLE_MIN_WIDTH && input->end - at >= 4 && at[0] == 2 && at[1] == 2 && at[2] < 128;
    return is_new ? unpack_new(input, width, rgbe) : unpack_old(input, width, rgbe);
}

// ---- image

static bool check_lines(const struct reader *reader, uint8_t *rgbe)
{
    struct input input = reader->lines;
    for (int y = 0; y < reader->height; y++) {
        const char *why = unpack_line(&input, reader->width, rgbe);
        if (why) return fail_at_row(reader, y, why);
    }
    return true;
}

// Mantissas are truncated by writers, so that the middle of the step is expected (Ward 1991). An
// exponent of 0 is black.
static void convert_line(const uint8_t *rgbe, int width, const float scales[256], float *out)
{
    for (int x = 0; x < width; x++, rgbe += 4, out += 3)
        for (int c = 0; c < 3; c++)
            out[c] = rgbe[3] ? fminf(((float)rgbe[c] + 0.5f) * scales[rgbe[3]], FLT_MAX) : 0.0f;
}

static void convert_lines(const struct reader *reader, uint8_t *rgbe, const struct image *out)
{
    struct input input = reader->lines;
    float scales[256]; // by exponent
    for (int e = 0; e < 256; e++)
        scales[e] =
            (float)fmin(ldexp(1.0, e - MANTISSA_EXPONENT) / reader->exposure, (double)FLT_MAX);
    for (int y = 0; y < reader->height; y++) {
        (void)unpack_line(&input, reader->width, rgbe); // check_lines has succeeded
        convert_line(rgbe, reader->width, scales, image_at(out, 0, y));
    }
}

bool hdr_decode(struct host *host, const char *name, const void *bytes, size_t size,
                struct image *out)
{
    struct reader reader = { .host = host, .name = name, .exposure = 1.0 };
    struct input input = { bytes, size > 0 ? (const uint8_t *)bytes + size : bytes };
    *out = (struct image){ 0 };
    if (!read_variables(&reader, &input) || !read_resolution(&reader, &input)) return false;
    reader.lines = input;
    uint8_t *rgbe = host_alloc(host, (size_t)reader.width, 4);
    const bool ok =
        rgbe && check_lines(&reader, rgbe) && image_init(out, host, reader.width, reader.height, 3);
    if (ok) convert_lines(&reader, rgbe, out);
    host_free(host, rgbe);
    return ok;
}

bool hdr_read(struct host *host, const char *path, struct image *out)
{
    struct file_bytes bytes;
    *out = (struct image){ 0 };
    if (!file_read(host, path, 0, &bytes)) return false;
    const bool ok = hdr_decode(host, path, bytes.data, bytes.size, out);
    file_bytes_finish(host, &bytes);
    return ok;
}
