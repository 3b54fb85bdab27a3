// The page is a template, report/report.html: {{name}} is replaced by an embedded file or by one
// of three pieces of data. Data goes into <script> blocks of type JSON, in ASCII without "<", so
// that no name can end a block or begin another.
#include "report_page.h"
#include "report_files.h"
#include "cli/files/whole_file.h"
#include "shell/srgb.h"

#include <afterglow/image.h>

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SCALE_COLOURS = 33 };

struct page {
    const char *folder;
    const json_t *report;
    json_t *images;               // unique file names, as keys
    char scale[SCALE_COLOURS][8]; // colours of error maps, "#rrggbb", from no error to the largest
};

// ---- images of the report

static bool is_inside(const char *name)
{
    if (!name[0] || name[0] == '/') return false;
    for (const char *part = name; *part; part += strspn(part, "/")) {
        size_t length = strcspn(part, "/");
        if (length == 2 && memcmp(part, "..", 2) == 0) return false;
        part += length;
    }
    return true;
}

static enum status image_path(const char *folder, const char *name, char out[PATH_SIZE])
{
    if (!is_inside(name)) return fail("cannot embed %s: it is not in %s", name, folder);
    if (snprintf(out, PATH_SIZE, "%s/%s", folder, name) >= PATH_SIZE)
        return fail("cannot embed %s: the path is too long", name);
    return DONE;
}

static enum status image_open(const char *path, FILE **out)
{
    static const char SIGNATURE[8] = "\x89PNG\r\n\x1a\n";
    char head[sizeof SIGNATURE];
    FILE *file = fopen(path, "rbe");
    if (!file) return fail("cannot embed %s: %s", path, strerror(errno));
    if (fread(head, 1, sizeof head, file) != sizeof head ||
        memcmp(head, SIGNATURE, sizeof head) != 0) {
        fclose(file);
        return fail("cannot embed %s: not a PNG file", path);
    }
    rewind(file);
    *out = file;
    return DONE;
}

static enum status check_image(const char *folder, const char *name)
{
    char path[PATH_SIZE];
    FILE *file = NULL;
    enum status status = image_path(folder, name, path);
    if (status == DONE) status = image_open(path, &file);
    if (file) fclose(file);
    return status;
}

// `owner`: the reference or a method.
static enum status collect_images(struct page *page, const json_t *owner)
{
    const char *role;
    json_t *value;
    json_t *images = json_object_get(owner, "images");
    json_object_foreach(images, role, value)
    {
        const char *name = json_string_value(value);
        if (!name || json_object_get(page->images, name)) continue;
        enum status status = check_image(page->folder, name);
        if (status != DONE) return status;
        if (json_object_set_new(page->images, name, json_true()) != 0)
            return fail("cannot embed %s: out of memory", name);
    }
    return DONE;
}

static enum status find_images(struct page *page)
{
    size_t i;
    json_t *method;
    page->images = json_object();
    if (!page->images) return fail("cannot write report.html: out of memory");
    enum status status = collect_images(page, json_object_get(page->report, "reference"));
    if (status == DONE) status = collect_images(page, json_object_get(page->report, "direct"));
    json_array_foreach(json_object_get(page->report, "methods"), i, method)
    {
        if (status == DONE) status = collect_images(page, method);
    }
    return status;
}

// ---- colours of error maps

static void colour_text(const float *linear, char out[8])
{
    snprintf(out, 8, "#%02x%02x%02x", srgb_byte(linear[0]), srgb_byte(linear[1]),
             srgb_byte(linear[2]));
}

// The error map of a ramp against black contains all colours.
static enum ag_result map_ramp(struct ag_context *context, struct ag_image **map)
{
    struct ag_image *ramp = NULL, *black = NULL;
    enum ag_result result = ag_image_create(context, SCALE_COLOURS, 1, 3, &ramp);
    if (result == AG_OK) result = ag_image_create(context, SCALE_COLOURS, 1, 3, &black);
    for (int i = 0; result == AG_OK && i < 3 * SCALE_COLOURS; i++)
        ramp->pixels[i] = (float)(i / 3) / (float)(SCALE_COLOURS - 1);
    if (result == AG_OK)
        result = ag_image_error_map(context, ramp, black, NULL, AG_DIFFERENCE_ABSOLUTE, 1.0f, map);
    ag_image_destroy(context, ramp);
    ag_image_destroy(context, black);
    return result;
}

static enum status find_scale(struct page *page)
{
    struct ag_context *context = NULL;
    struct ag_image *map = NULL;
    enum ag_result result = ag_context_create(NULL, &context);
    if (result != AG_OK) return fail("cannot write report.html: %s", ag_result_string(result));
    result = map_ramp(context, &map);
    for (int i = 0; result == AG_OK && i < SCALE_COLOURS; i++)
        colour_text(map->pixels + 3 * i, page->scale[i]);
    enum status status = result == AG_OK ? DONE : fail_library(context, result);
    ag_image_destroy(context, map);
    ag_context_destroy(context);
    return status == DONE ? DONE : FAILED;
}

// ---- data in the page

// "<" and ">" occur only in strings of a JSON document, where escapes are allowed.
static int write_escaped(const char *text, size_t size, void *user)
{
    FILE *file = user;
    for (size_t i = 0; i < size; i++) {
        if (text[i] == '<')
            fputs("\\u003c", file);
        else if (text[i] == '>')
            fputs("\\u003e", file);
        else
            fputc(text[i], file);
    }
    return ferror(file) ? -1 : 0;
}

static enum status write_json(FILE *file, const json_t *document)
{
    const size_t flags = JSON_ENSURE_ASCII | JSON_ENCODE_ANY | JSON_COMPACT | JSON_PRESERVE_ORDER |
                         JSON_REAL_PRECISION(12);
    if (json_dump_callback(document, write_escaped, file, flags) == 0 || ferror(file)) return DONE;
    return fail("cannot write report.html: out of memory");
}

enum { CHUNK_SIZE = 3 * 4096 }; // of an image: a multiple of 3, so that only the last one is padded

static void write_base64(FILE *file, const unsigned char *bytes, size_t size)
{
    static const char DIGITS[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    char text[CHUNK_SIZE / 3 * 4];
    size_t used = 0;
    for (size_t i = 0; i < size; i += 3) {
        size_t left = size - i;
        unsigned three = (unsigned)bytes[i] << 16 | (left > 1 ? (unsigned)bytes[i + 1] << 8 : 0) |
                         (left > 2 ? bytes[i + 2] : 0);
        text[used++] = DIGITS[three >> 18];
        text[used++] = DIGITS[three >> 12 & 63];
        text[used++] = left > 1 ? DIGITS[three >> 6 & 63] : '=';
        text[used++] = left > 2 ? DIGITS[three & 63] : '=';
    }
    fwrite(text, 1, used, file);
}

static enum status write_image(FILE *file, const char *path)
{
    unsigned char bytes[CHUNK_SIZE];
    FILE *image = NULL;
    enum status status = image_open(path, &image);
    if (status != DONE) return status;
    fputs("\"data:image/png;base64,", file);
    for (size_t got; (got = fread(bytes, 1, sizeof bytes, image)) > 0;)
        write_base64(file, bytes, got);
    if (ferror(image)) status = fail("cannot embed %s: it cannot be read", path);
    fputc('"', file);
    fclose(image);
    return status;
}

// {"reference.png":"data:…", …}
static enum status write_images(FILE *file, const struct page *page)
{
    const char *name;
    json_t *value;
    char path[PATH_SIZE];
    const char *before = "{";
    json_object_foreach(page->images, name, value)
    {
        fputs(before, file);
        before = ",\n";
        json_t *text = json_string(name);
        enum status status =
            text ? write_json(file, text) : fail("cannot write report.html: out of memory");
        json_decref(text);
        fputc(':', file);
        if (status == DONE) status = image_path(page->folder, name, path);
        if (status == DONE) status = write_image(file, path);
        if (status != DONE) return status;
    }
    fputs(json_object_size(page->images) ? "}" : "{}", file);
    return DONE;
}

static enum status write_scale(FILE *file, const struct page *page)
{
    for (int i = 0; i < SCALE_COLOURS; i++)
        fprintf(file, "%s\"%s\"", i ? "," : "[", page->scale[i]);
    fputc(']', file);
    return DONE;
}

// ---- the page

struct piece {
    const char *name;
    size_t length;
};

static bool is(struct piece piece, const char *name)
{
    return strlen(name) == piece.length && memcmp(name, piece.name, piece.length) == 0;
}

static const struct embedded_file *embedded(struct piece piece)
{
    for (const struct embedded_file *file = embedded_files; file->name; file++)
        if (is(piece, file->name)) return file;
    return NULL;
}

// Writes the replacement of {{name}}.
static enum status write_piece(FILE *file, const struct page *page, struct piece piece)
{
    if (is(piece, "report")) return write_json(file, page->report);
    if (is(piece, "images")) return write_images(file, page);
    if (is(piece, "scale")) return write_scale(file, page);
    const struct embedded_file *held = embedded(piece);
    if (!held)
        return fail("cannot write report.html: there is no {{%.*s}}", (int)piece.length,
                    piece.name);
    fwrite(held->bytes, 1, held->size, file);
    return DONE;
}

static enum status write_page(FILE *file, const void *what)
{
    const struct page *page = what;
    const struct embedded_file *template = embedded((struct piece){ "report.html", 11 });
    const char *text = (const char *)template->bytes, *end = text + template->size;
    while (text < end) {
        const char *open = memmem(text, (size_t)(end - text), "{{", 2);
        const char *close = open ? memmem(open, (size_t)(end - open), "}}", 2) : NULL;
        fwrite(text, 1, (size_t)((close ? open : end) - text), file);
        if (!close) break;
        enum status status =
            write_piece(file, page, (struct piece){ open + 2, (size_t)(close - open - 2) });
        if (status != DONE) return status;
        text = close + 2;
    }
    return DONE;
}

enum status report_page_write(const char *folder, const json_t *report)
{
    struct page page = { .folder = folder, .report = report };
    char path[PATH_SIZE];
    if (snprintf(path, sizeof path, "%s/report.html", folder) >= (int)sizeof path)
        return fail("cannot write %s/report.html: the path is too long", folder);
    enum status status = find_images(&page);
    if (status == DONE) status = find_scale(&page);
    if (status == DONE) status = whole_file_write(path, write_page, &page);
    json_decref(page.images);
    return status;
}
