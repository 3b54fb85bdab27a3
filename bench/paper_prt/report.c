#include "paper_prt/report.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { TEXT = 256 };

double report_number_of(const char *json, const char *name)
{
    char quoted[TEXT];
    const int length = snprintf(quoted, sizeof quoted, "\"%s\":", name);
    const char *at = strstr(json, quoted);
    char *end = NULL;
    if (!at) return (double)NAN;
    at += length;
    const double value = strtod(at, &end);
    return end != at ? value : (double)NAN;
}

// Options come before the stages, and a stage has its name before its seconds.
double report_seconds_of(const char *json, const char *stage)
{
    char quoted[TEXT];
    snprintf(quoted, sizeof quoted, "\"%s\"", stage);
    const char *stages = strstr(json, "\"stages\":");
    const char *at = stages ? strstr(stages, quoted) : NULL;
    return at ? report_number_of(at, "seconds") : (double)NAN;
}
