// The stream to the library (scene/import/import_stream.h).
#include "importer/importer.h"

#include "scene/import/import_stream.h"

#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static int stream = -1;

// The library has gone where a write fails: nobody would hear of it.
static void write_all(const void *data, size_t size)
{
    const char *at = data;
    while (size > 0) {
        ssize_t wrote = write(stream, at, size);
        if (wrote < 0 && errno == EINTR) continue;
        if (wrote <= 0) _exit(1);
        at += wrote;
        size -= (size_t)wrote;
    }
}

// Whatever else prints must not come between: standard output becomes /dev/null.
void output_open(void)
{
    stream = fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 3);
    int null = open("/dev/null", O_RDWR | O_CLOEXEC);
    if (stream < 0 || null < 0 || dup2(null, STDOUT_FILENO) < 0) _exit(1);
    write_all(IMPORT_STREAM_GREETING, strlen(IMPORT_STREAM_GREETING));
}

__attribute__((format(printf, 1, 0))) static void write_line(const char *format, va_list arguments)
{
    char line[IMPORT_STREAM_LINE];
    vsnprintf(line, sizeof line - 1, format, arguments);
    for (char *c = line; *c; c++)
        if (*c == '\n') *c = ' ';
    strcat(line, "\n");
    write_all(line, strlen(line));
}

__attribute__((format(printf, 1, 2))) static void write_text(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    write_line(format, arguments);
    va_end(arguments);
}

int output_descriptor(void)
{
    return stream;
}

void output_log(const char *format, ...)
{
    char text[IMPORT_STREAM_LINE];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    write_text("log %s", text);
}

void output_note(const char *feature)
{
    write_text("note %s", feature);
}

void output_fail(const char *kind, const char *format, ...)
{
    char why[IMPORT_STREAM_LINE];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(why, sizeof why, format, arguments);
    va_end(arguments);
    write_text("fail %s %s", kind, why);
    _exit(1);
}

void *allocate(size_t count, size_t size)
{
    void *block = calloc(count ? count : 1, size ? size : 1);
    if (!block) output_fail("memory", "out of memory");
    return block;
}

static void put_u32(uint32_t value)
{
    uint8_t bytes[4] = { (uint8_t)value, (uint8_t)(value >> 8), (uint8_t)(value >> 16),
                         (uint8_t)(value >> 24) };
    write_all(bytes, sizeof bytes);
}

// _exit: no destructor of a library runs.
void output_glb(const char *json, const uint8_t *binary, size_t size)
{
    static const uint32_t MAGIC = 0x46546c67, JSON = 0x4e4f534a, BIN = 0x004e4942;
    static const char spaces[4] = "   ";
    size_t text = strlen(json), padded = (text + 3) & ~(size_t)3;
    size_t total = 12 + 8 + padded + 8 + size;
    if (total > UINT32_MAX) output_fail("memory", "needs more than 4 GB as glTF");
    write_text("glb %zu", total);
    put_u32(MAGIC);
    put_u32(2);
    put_u32((uint32_t)total);
    put_u32((uint32_t)padded);
    put_u32(JSON);
    write_all(json, text);
    write_all(spaces, padded - text);
    put_u32((uint32_t)size);
    put_u32(BIN);
    write_all(binary, size);
    _exit(0);
}
