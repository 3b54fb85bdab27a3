// JSON, written from front to back.
#include "bake/report.h"

#include "core/c_locale.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

enum { MAX_DEPTH = 32, FIRST_BYTES = 4096, NUMBER_TEXT = 40 };

struct report {
    struct host *host;
    char *text;
    size_t size, capacity;
    int depth;
    bool is_list[MAX_DEPTH], has_member[MAX_DEPTH];
    bool failed;
};

static void append(struct report *report, const char *bytes, size_t count)
{
    if (report->failed) return;
    if (report->size + count + 1 > report->capacity) {
        size_t capacity = report->capacity ? report->capacity : FIRST_BYTES;
        while (capacity < report->size + count + 1) capacity *= 2;
        char *text = host_realloc(report->host, report->text, capacity, 1);
        report->failed = !text;
        if (!text) return;
        report->text = text;
        report->capacity = capacity;
    }
    memcpy(report->text + report->size, bytes, count);
    report->size += count;
    report->text[report->size] = 0;
}

static void append_text(struct report *report, const char *text)
{
    append(report, text, strlen(text));
}

static void append_quoted(struct report *report, const char *text)
{
    char escape[8];
    append(report, "\"", 1);
    for (; *text; text++) {
        const unsigned char c = (unsigned char)*text;
        if (c == '"' || c == '\\')
            snprintf(escape, sizeof escape, "\\%c", c);
        else if (c < ' ')
            snprintf(escape, sizeof escape, "\\u%04x", (unsigned)c);
        else
            snprintf(escape, sizeof escape, "%c", c);
        append_text(report, escape);
    }
    append(report, "\"", 1);
}

static void begin_value(struct report *report, const char *name)
{
    const int at = report->depth - 1;
    if (at >= 0 && report->has_member[at]) append(report, ", ", 2);
    if (at >= 0) report->has_member[at] = true;
    if (!name) return;
    append_quoted(report, name);
    append(report, ": ", 2);
}

static void begin(struct report *report, const char *name, bool is_list)
{
    if (report->depth == MAX_DEPTH) report->failed = true;
    if (report->failed) return;
    begin_value(report, name);
    append(report, is_list ? "[" : "{", 1);
    report->is_list[report->depth] = is_list;
    report->has_member[report->depth++] = false;
}

struct report *report_create(struct host *host)
{
    struct report *report = host_alloc(host, 1, sizeof *report);
    if (!report) return NULL;
    report->host = host;
    begin(report, NULL, false);
    return report;
}

void report_destroy(struct report *report)
{
    if (!report) return;
    host_free(report->host, report->text);
    host_free(report->host, report);
}

const char *report_text(struct report *report)
{
    if (report->depth == 1) report_end(report);
    if (report->depth != 0) report->failed = true;
    return report->failed ? NULL : report->text;
}

void report_begin_object(struct report *report, const char *name)
{
    begin(report, name, false);
}

void report_begin_list(struct report *report, const char *name)
{
    begin(report, name, true);
}

void report_end(struct report *report)
{
    if (report->depth == 0) report->failed = true;
    if (report->failed) return;
    append(report, report->is_list[--report->depth] ? "]" : "}", 1);
}

void report_number(struct report *report, const char *name, double value)
{
    char text[NUMBER_TEXT];
    c_locale_print(text, sizeof text, "%.9g", value);
    begin_value(report, name);
    append_text(report, isfinite(value) ? text : "null");
}

void report_text_value(struct report *report, const char *name, const char *value)
{
    begin_value(report, name);
    append_quoted(report, value);
}

void report_bool(struct report *report, const char *name, bool value)
{
    begin_value(report, name);
    append_text(report, value ? "true" : "false");
}
