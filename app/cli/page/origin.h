// The origin of a report.
#pragma once

#include "cli/arguments.h"

#include <jansson.h>

// Adds the command that makes the report again, the version and the date.
void report_add_origin(json_t *report, const char *command, const struct arguments *arguments);
