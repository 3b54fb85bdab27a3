// Numbers of a bake's report (ag_bake_report).
#pragma once

// A member of the document with this name; NaN: there is none.
double report_number_of(const char *json, const char *name);
// Wall time of a stage.
double report_seconds_of(const char *json, const char *stage);
