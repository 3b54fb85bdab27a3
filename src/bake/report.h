// The JSON report of a bake, written member by member. A failure (out of memory) is remembered and
// ends in a NULL text, so callers check once.
#pragma once

#include "core/host.h"

struct report;

struct report *report_create(struct host *host);
void report_destroy(struct report *report);
// The finished text, one JSON object, owned by the report; NULL: out of memory, or an object was
// not closed.
const char *report_text(struct report *report);

// `name` is NULL for elements of a list. Numbers that are not finite become null.
void report_begin_object(struct report *report, const char *name);
void report_begin_list(struct report *report, const char *name);
void report_end(struct report *report); // of the innermost object or list
void report_number(struct report *report, const char *name, double value);
void report_text_value(struct report *report, const char *name, const char *value);
void report_bool(struct report *report, const char *name, bool value);
