#include "csv.h"

bool csv_open(const char *path, const char *header, FILE **out)
{
    *out = path ? fopen(path, "w") : NULL;
    if (path && !*out) perror(path);
    if (*out) fprintf(*out, "%s\n", header);
    return !path || *out;
}

void csv_text(FILE *file, const char *text)
{
    fputc('"', file);
    for (; *text; text++) {
        if (*text == '"') fputc('"', file);
        fputc(*text, file);
    }
    fputs("\",", file);
}

bool csv_close(FILE *file, const char *path)
{
    if (!file || !(ferror(file) | fclose(file))) return true;
    perror(path);
    return false;
}
