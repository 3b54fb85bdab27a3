// Contexts, texts and files of the fuzz harnesses.
#include "fuzz/fuzz.h"

#include "core/host.h"
#include "core/text.h"

#include <dirent.h>
#include <string.h>
#include <unistd.h>

enum { PATH_SIZE = 256, MAX_TEXT = 1 << 16 };

static char folder[PATH_SIZE], file[PATH_SIZE];

// ---- messages

static void check_message(const char *message)
{
    char escaped[4 * 1024];
    FUZZ_CHECK(message[0]);
    FUZZ_CHECK(text_escape(message, escaped, sizeof escaped) < sizeof escaped - 1);
    FUZZ_CHECK(strcmp(message, escaped) == 0);
}

static void log_of_context(void *user, enum ag_log_level level, const char *message)
{
    (void)user, (void)level;
    check_message(message);
}

static void log_of_host(void *user, enum log_level level, const char *message)
{
    (void)user, (void)level;
    check_message(message);
}

struct ag_context *fuzz_context(void)
{
    struct ag_context_desc desc;
    struct ag_context *context = NULL;
    ag_context_desc_default(&desc);
    desc.log = log_of_context;
    desc.log_up_to = AG_LOG_DEBUG;
    desc.use_environment = false;
    desc.importer = FUZZ_IMPORTER;
    FUZZ_CHECK(ag_context_create(&desc, &context) == AG_OK);
    return context;
}

struct host *fuzz_host(void)
{
    static struct host host = { .log = log_of_host, .log_up_to = LOG_DEBUG };
    return &host;
}

// ---- input

char *fuzz_text(const uint8_t *data, size_t size)
{
    const size_t length = strnlen((const char *)data, size < MAX_TEXT ? size : MAX_TEXT);
    char *text = calloc(length + 1, 1);
    FUZZ_CHECK(text);
    if (length > 0) memcpy(text, data, length);
    return text;
}

static void remove_folder(void)
{
    char path[2 * PATH_SIZE];
    DIR *open = opendir(folder);
    for (struct dirent *entry; open && (entry = readdir(open));) {
        snprintf(path, sizeof path, "%s/%s", folder, entry->d_name);
        unlink(path); // fails for . and ..
    }
    if (open) closedir(open);
    rmdir(folder);
}

// In memory where that is possible: most of an execution would be spent on the disk.
static void make_folder(void)
{
    const char *parent = access("/dev/shm", W_OK | X_OK) == 0 ? "/dev/shm" : "/tmp";
    snprintf(folder, sizeof folder, "%s/afterglow-fuzz-XXXXXX", parent);
    FUZZ_CHECK(mkdtemp(folder));
    FUZZ_CHECK(atexit(remove_folder) == 0);
}

const char *fuzz_folder(void)
{
    if (!folder[0]) make_folder();
    return folder;
}

const char *fuzz_file(const uint8_t *data, size_t size, const char *extension)
{
    const int length = snprintf(file, sizeof file, "%s/input.%s", fuzz_folder(), extension);
    FUZZ_CHECK(length > 0 && length < PATH_SIZE);
    FILE *stream = fopen(file, "wb");
    FUZZ_CHECK(stream);
    FUZZ_CHECK(size == 0 || fwrite(data, 1, size, stream) == size);
    FUZZ_CHECK(fclose(stream) == 0);
    return file;
}
