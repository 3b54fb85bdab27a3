// OBJ, FBX and X files, through the importer program (src/importer): a process of its own, since
// hostile files end Assimp. It hands the scene over as glTF, which is read and checked like any
// other glTF file.
#include "scene/import/importers.h"

#include "scene/import/import_stream.h"

#include "core/files/process.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

// Limits that follow from a file's size: processor time, addresses, and bytes of glTF.
static const double CPU_S = 5.0, CPU_S_PER_MEGABYTE = 4.0;
static const double WALL_FACTOR = 12.0; // of a loaded machine; the program ends itself before
static const size_t MEMORY_ALLOWANCE_BYTES = (size_t)1 << 30;
static const size_t GLTF_ALLOWANCE_BYTES = (size_t)128 << 20;

// The rest of the stream.
struct stream {
    struct import *import;
    const unsigned char *at, *end;
};

static bool wrong(const struct stream *stream, const char *why)
{
    return host_fail(stream->import->host, FAIL_FORMAT, "%s: %s", stream->import->path, why);
}

// The next line without its end; false if there is none of a proper length.
static bool next_line(struct stream *stream, char line[IMPORT_STREAM_LINE])
{
    size_t left = (size_t)(stream->end - stream->at);
    const unsigned char *end = left > 0 ? memchr(stream->at, '\n', left) : NULL;
    if (!end || end - stream->at >= IMPORT_STREAM_LINE) return false;
    memcpy(line, stream->at, (size_t)(end - stream->at));
    line[end - stream->at] = 0;
    stream->at = end + 1;
    return true;
}

// The text after a word and a space; NULL for another word.
static const char *after(const char *line, const char *word)
{
    size_t n = strlen(word);
    return strncmp(line, word, n) == 0 && line[n] == ' ' ? line + n + 1 : NULL;
}

// "KIND WHY"
static bool fail(const struct stream *stream, const char *line)
{
    static const struct {
        const char *word;
        enum fail_kind kind;
    } kinds[] = { { "format", FAIL_FORMAT },
                  { "unsupported", FAIL_UNSUPPORTED },
                  { "file", FAIL_FILE },
                  { "memory", FAIL_MEMORY } };
    if (after(line, "link")) return import_fail_link(stream->import, after(line, "link"));
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
        const char *why = after(line, kinds[i].word);
        if (!why) continue;
        return host_fail(stream->import->host, kinds[i].kind, "%s: %s", stream->import->path,
                         import_printable(why).s);
    }
    return wrong(stream, "cannot be read");
}

// The program was ended by a limit or by a fault, which a file causes.
static bool fail_ended(const struct stream *stream, const struct process_end *end)
{
    if (end->timed_out || end->signal == SIGXCPU || end->signal == SIGALRM ||
        end->signal == SIGKILL)
        return wrong(stream, "takes more time to read than its size justifies");
    return wrong(stream, "cannot be read: the importer failed on it");
}

// Finds the glTF in the stream.
static bool read_stream(struct import *import, struct stream *stream, const struct process_end *end,
                        struct file_bytes *gltf)
{
    size_t greeting = strlen(IMPORT_STREAM_GREETING);
    if ((size_t)(stream->end - stream->at) < greeting ||
        memcmp(stream->at, IMPORT_STREAM_GREETING, greeting) != 0) {
        return host_fail(import->host, FAIL_UNSUPPORTED,
                         "%s: cannot be read: %s is not an importer of this version", import->path,
                         import->host->importer);
    }
    stream->at += greeting;
    char line[IMPORT_STREAM_LINE];
    while (next_line(stream, line)) {
        const char *note = after(line, "note"), *why = after(line, "fail");
        const char *size = after(line, "glb"), *text = after(line, "log");
        if (why) return fail(stream, why);
        if (note) import_note(import, "%s", import_printable(note).s);
        if (text)
            host_log(import->host, LOG_DEBUG, "%s: importer: %s", import->path,
                     import_printable(text).s);
        if (!size) continue;
        size_t bytes = (size_t)strtoull(size, NULL, 10);
        if (bytes != (size_t)(stream->end - stream->at)) break;
        *gltf = (struct file_bytes){ (unsigned char *)stream->at, bytes };
        return true;
    }
    return fail_ended(stream, end);
}

// These formats have no alpha mode: images with alpha are used as masks.
static void mask_by_alpha(struct scene *scene)
{
    for (int i = 0; i < scene->material_count; i++) {
        struct material *m = &scene->materials[i];
        int image = m->base_color_map.image;
        if (image >= 0 && scene->images[image].has_alpha && m->alpha_mode == ALPHA_OPAQUE)
            m->alpha_mode = ALPHA_MASK;
    }
}

// The descriptor of a file in memory with the bytes, not one of a standard stream; -1 on failure.
static int input_of(struct import *import, const struct file_bytes *bytes)
{
    int made = memfd_create("afterglow-import", MFD_CLOEXEC);
    int fd = made >= 0 ? fcntl(made, F_DUPFD_CLOEXEC, STDERR_FILENO + 1) : -1;
    if (made >= 0) close(made);
    for (size_t at = 0; fd >= 0 && at < bytes->size;) {
        const ssize_t written = write(fd, bytes->data + at, bytes->size - at);
        if (written < 0 && errno == EINTR) continue;
        if (written > 0) at += (size_t)written;
        if (written > 0) continue;
        close(fd);
        fd = -1;
    }
    if (fd < 0)
        host_fail(import->host, FAIL_MEMORY, "%s: cannot be passed to the importer: %s",
                  import->path, strerror(errno));
    return fd;
}

static bool run(struct import *import, const struct file_bytes *bytes, struct file_bytes *out,
                struct process_end *end)
{
    const size_t size = bytes->size;
    const int input = import->memory ? input_of(import, bytes) : -1;
    if (import->memory && input < 0) return false;
    char cpu[32], memory[32], *path = (char *)import->path;
    double cpu_s = CPU_S + CPU_S_PER_MEGABYTE * 1e-6 * (double)size;
    snprintf(cpu, sizeof cpu, "%.0f", cpu_s);
    snprintf(memory, sizeof memory, "%zu", import_limit(import, MEMORY_ALLOWANCE_BYTES));
    char *arguments[7] = { (char *)"afterglow-import", path, cpu, memory };
    int count = 4;
    if (import->memory) arguments[count++] = (char *)"stdin";
    if (import->host->follow_links) arguments[count++] = (char *)"follow-links";
    const bool ok =
        process_output(import->host, import->host->importer, arguments, input,
                       import_limit(import, GLTF_ALLOWANCE_BYTES), WALL_FACTOR * cpu_s, out, end);
    if (input >= 0) close(input);
    return ok;
}

bool import_program(struct import *import, const struct file_bytes *bytes)
{
    struct file_bytes out, gltf;
    struct process_end end;
    if (!import->host->importer) {
        return host_fail(import->host, FAIL_UNSUPPORTED,
                         "%s: OBJ, FBX and X files need the program afterglow-import, which is not "
                         "installed beside the library; AFTERGLOW_IMPORTER can name it",
                         import->path);
    }
    if (!run(import, bytes, &out, &end)) return false;
    struct stream stream = { import, out.data, out.data + out.size };
    import->converted = true;
    bool ok = read_stream(import, &stream, &end, &gltf) && import_charge(import, out.size, 1) &&
              import_gltf(import, &gltf);
    if (ok) mask_by_alpha(import->scene);
    file_bytes_finish(import->host, &out);
    return ok;
}
