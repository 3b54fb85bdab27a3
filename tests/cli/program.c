#include "cli/program.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <fcntl.h>
#include <unistd.h>

enum { MAX_WORDS = 64, WORDS_SIZE = 8192 };

static void read_text(const char *path, char *out, size_t size)
{
    FILE *file = fopen(path, "rb");
    if (!file) fail_msg("cannot read %s", path);
    size_t got = fread(out, 1, size - 1, file);
    out[got] = 0;
    fclose(file);
}

static void redirect(const char *path, int to)
{
    int fd = open(path, O_WRONLY | O_CREAT | O_TRUNC, 0600);
    if (fd < 0 || dup2(fd, to) < 0) _exit(126);
    close(fd);
}

static const struct run *execute(char **words)
{
    static struct run result;
    char out[512], err[512];
    snprintf(out, sizeof out, "%s", test_path("stdout"));
    snprintf(err, sizeof err, "%s", test_path("stderr"));
    pid_t child = fork();
    if (child < 0) fail_msg("cannot fork");
    if (child == 0) {
        redirect(out, STDOUT_FILENO);
        redirect(err, STDERR_FILENO);
        execv(AFTERGLOW_PROGRAM, words);
        _exit(127);
    }
    int status = 0;
    if (waitpid(child, &status, 0) != child) fail_msg("cannot wait for the program");
    result.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    read_text(out, result.out, sizeof result.out);
    read_text(err, result.err, sizeof result.err);
    return &result;
}

static const struct run *run_list(const char *first, va_list more)
{
    static char text[WORDS_SIZE];
    char *words[MAX_WORDS] = { (char *)AFTERGLOW_PROGRAM };
    int count = 1;
    snprintf(text, sizeof text, "%s", first);
    char *rest = text;
    for (char *word; (word = strsep(&rest, " "));)
        if (word[0] && count < MAX_WORDS - 1) words[count++] = word;
    for (char *word; (word = va_arg(more, char *));)
        if (count < MAX_WORDS - 1) words[count++] = word;
    return execute(words);
}

const struct run *run_program(const char *words, ...)
{
    va_list more;
    va_start(more, words);
    const struct run *result = run_list(words, more);
    va_end(more);
    return result;
}

const struct run *run_expect(int status, const char *words, ...)
{
    va_list more;
    va_start(more, words);
    const struct run *result = run_list(words, more);
    va_end(more);
    if (result->status != status)
        fail_msg("afterglow %s …: status %d, not %d: %s", words, result->status, status,
                 result->err);
    return result;
}

void check_one_error_line(const struct run *result)
{
    const char *end = strchr(result->err, '\n');
    if (strncmp(result->err, "afterglow: ", 11) != 0 || !end || end[1] || result->out[0])
        fail_msg("not one line on standard error:\n%s%s", result->err, result->out);
}

json_t *run_json(const struct run *result)
{
    json_error_t error;
    json_t *document = json_loads(result->out, 0, &error);
    if (!document) fail_msg("no JSON, line %d: %s", error.line, error.text);
    return document;
}

void require_device(void)
{
    json_t *list = run_json(run_expect(0, "list --json --quiet", NULL));
    json_t *device;
    size_t i;
    bool usable = false;
    json_array_foreach(json_object_get(list, "devices"), i, device) usable |=
        json_is_true(json_object_get(device, "usable"));
    json_decref(list);
    if (usable) return;
    test_skip("no Vulkan device");
}

const char *path_of(const char *name)
{
    static char paths[32][400];
    static int next;
    char *path = paths[next++ % 32];
    snprintf(path, sizeof paths[0], "%s", test_path(name));
    return path;
}

bool file_exists(const char *path)
{
    return access(path, F_OK) == 0;
}

bool files_are_equal(const char *a, const char *b)
{
    FILE *files[2] = { fopen(a, "rb"), fopen(b, "rb") };
    bool equal = files[0] && files[1];
    for (int x = 0; equal && x != EOF;) {
        x = fgetc(files[0]);
        equal = x == fgetc(files[1]);
    }
    for (int i = 0; i < 2; i++)
        if (files[i]) fclose(files[i]);
    return equal;
}

void write_file(const char *path, const char *bytes, size_t size)
{
    FILE *file = fopen(path, "wb");
    if (!file || fwrite(bytes, 1, size, file) != size || fclose(file) != 0)
        fail_msg("cannot write %s", path);
}

int count_files(const char *folder)
{
    DIR *dir = opendir(folder);
    if (!dir) fail_msg("cannot open %s", folder);
    int count = 0;
    for (struct dirent *entry; (entry = readdir(dir));)
        count += strcmp(entry->d_name, ".") != 0 && strcmp(entry->d_name, "..") != 0;
    closedir(dir);
    return count;
}

const char *make_folder(const char *name)
{
    const char *path = test_path(name);
    if (mkdir(path, 0700) != 0) fail_msg("cannot make %s", path);
    return path;
}
