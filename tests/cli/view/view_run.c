#include "cli/view/view_run.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void check_differ(const char *a, const char *b)
{
    if (files_are_equal(a, b)) fail_msg("%s and %s are the same", a, b);
}

void check_size(const char *path, int width, int height)
{
    int w = 0, h = 0;
    CHECK(png_read_size(test_host(), path, &w, &h));
    if (w != width || h != height) fail_msg("%s is %dx%d", path, w, h);
}

double mean_of(const char *path)
{
    struct image image;
    double sum = 0;
    CHECK(png_read(test_host(), path, &image));
    const size_t count = (size_t)image.width * (size_t)image.height * (size_t)image.channels;
    for (size_t i = 0; i < count; i++) sum += (double)image.pixels[i];
    image_finish(&image, test_host());
    return sum / (double)count;
}

// ---- the command of a view

void run_line(const char *path, const char *output)
{
    char line[4096] = "", command[8192];
    FILE *file = fopen(path, "r");
    if (!file || !fgets(line, sizeof line, file)) fail_msg("%s is empty", path);
    fclose(file);
    line[strcspn(line, "\n")] = 0;
    if (strncmp(line, "afterglow ", 10) != 0) fail_msg("no command: %s", line);
    snprintf(command, sizeof command, "'%s' %s --quiet -o %s", AFTERGLOW_PROGRAM, line + 10,
             output);
    if (system(command) != 0) fail_msg("failed: %s", command);
}

void check_command(const char *words, const char *script)
{
    char lines[1024];
    snprintf(lines, sizeof lines, "%ssettle\nsave saved.png\ncommand command.sh\n", script);
    view(words, lines);
    run_line("command.sh", "rendered.png");
    if (!files_are_equal("saved.png", "rendered.png"))
        fail_msg("%s: the command renders another image", words);
}
