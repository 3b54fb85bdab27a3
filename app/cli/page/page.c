// Data goes into <script> blocks of type JSON, in ASCII without "<", so that no name can end a
// block or begin another.
#include "page.h"
#include "page_files.h"
#include "cli/files/whole_file.h"

#include <errno.h>
#include <string.h>

// ---- images

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

enum status page_add_image(struct page *page, const char *name)
{
    char path[PATH_SIZE];
    FILE *file = NULL;
    if (!page->images) page->images = json_object();
    if (!name || json_object_get(page->images, name)) return DONE;
    enum status status = image_path(page->folder, name, path);
    if (status == DONE) status = image_open(path, &file);
    if (file) fclose(file);
    if (status == DONE && json_object_set_new(page->images, name, json_true()) != 0)
        return fail("cannot embed %s: out of memory", name);
    return status;
}

// ---- data

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
    const char *key;
    json_t *value;
    if (is(piece, "images")) return write_images(file, page);
    json_object_foreach((json_t *)page->data, key, value)
    {
        if (is(piece, key)) return write_json(file, value);
    }
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
    const struct embedded_file *template =
        embedded((struct piece){ page->template, strlen(page->template) });
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

enum status page_write(const struct page *page, const char *path)
{
    return whole_file_write(path, write_page, page);
}

void page_finish(struct page *page)
{
    json_decref(page->images);
    *page = (struct page){ 0 };
}
