// Lists of techniques, for messages.
#pragma once

#include <afterglow/catalogue.h>

// "radiosity, ort": those that `has` accepts.
void technique_names(bool (*has)(const struct ag_technique_info *info), char *out, size_t size);
