#include "paper_prt/report.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { TEXT = 256 };

// Names are not values in a report but those of stages, which differ from all members.
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

// A stage has its name before its seconds.
double report_seconds_of(const char *json, const char *stage)
{
    char quoted[TEXT];
    snprintf(quoted, sizeof quoted, "\"%s\"", stage);
    const char *at = strstr(json, quoted);
    return at ? report_number_of(at, "seconds") : (double)NAN;
}
