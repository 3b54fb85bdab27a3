// Runs a harness on files and folders of files, without libFuzzer: replay PATH...
#include "fuzz/fuzz.h"

#include <dirent.h>
#include <errno.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>

enum { PATH_SIZE = 4096, MAX_BYTES = 64 << 20 };

// The limit of one input: 10, as in tools/fuzz, times the factor of a loaded machine.
static double slowest_s(void)
{
    const char *factor = getenv("AFTERGLOW_TEST_TIME_FACTOR");
    return factor && atof(factor) > 1.0 ? 10.0 * atof(factor) : 10.0;
}

static int count, failures;

static double now_s(void)
{
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static void fail(const char *path, const char *why)
{
    fprintf(stderr, "%s: %s\n", path, why);
    failures++;
}

// The input has a block of exactly its size, so that a sanitizer sees reads past its end.
static void run(const char *path, size_t size)
{
    uint8_t *data = malloc(size ? size : 1);
    FILE *file = fopen(path, "rb");
    const bool ok = data && file && fread(data, 1, size, file) == size;
    if (file) fclose(file);
    if (ok) {
        const double begun = now_s();
        fprintf(stderr, "%s\n", path);
        LLVMFuzzerTestOneInput(data, size);
        if (now_s() - begun > slowest_s())
            fail(path, "takes more than 10 s, or that times AFTERGLOW_TEST_TIME_FACTOR");
        count++;
    } else {
        fail(path, "cannot be read");
    }
    free(data);
}

static void visit(const char *path);

static void visit_folder(const char *path)
{
    char inside[PATH_SIZE];
    struct dirent **entries = NULL;
    const int found = scandir(path, &entries, NULL, alphasort);
    if (found < 0) fail(path, strerror(errno));
    for (int i = 0; i < found; i++) {
        const int length = snprintf(inside, sizeof inside, "%s/%s", path, entries[i]->d_name);
        if (entries[i]->d_name[0] != '.' && length < PATH_SIZE) visit(inside);
        free(entries[i]);
    }
    free(entries);
}

static void visit(const char *path)
{
    struct stat info;
    if (stat(path, &info) != 0)
        fail(path, strerror(errno));
    else if (S_ISDIR(info.st_mode))
        visit_folder(path);
    else if (info.st_size > MAX_BYTES)
        fail(path, "is too large");
    else
        run(path, (size_t)info.st_size);
}

int main(int argc, char **argv)
{
    for (int i = 1; i < argc; i++) visit(argv[i]);
    if (count == 0) fail("corpus", "no input was run");
    printf("%d inputs, %d failures\n", count, failures);
    return failures > 0;
}
