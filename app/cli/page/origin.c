#include "origin.h"
#include "shell/json_values.h"

#include <afterglow/context.h>

#include <time.h>

static json_t *version_json(void)
{
    const int v = ag_version();
    return json_sprintf("%d.%d.%d", v / 10000, v / 100 % 100, v % 100);
}

static json_t *date_json(void)
{
    char text[32] = "";
    struct tm utc;
    const time_t now = time(NULL);
    if (gmtime_r(&now, &utc)) strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &utc);
    return json_string(text);
}

void report_add_origin(json_t *report, const char *command, const struct arguments *arguments)
{
    char text[COMMAND_SIZE];
    arguments_command(command, arguments, text, sizeof text);
    json_object_set_new(report, "command", json_text(text));
    json_object_set_new(report, "version", version_json());
    json_object_set_new(report, "date", date_json());
}
