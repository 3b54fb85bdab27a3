#include "technique_names.h"

#include <stdio.h>

void technique_names(bool (*has)(const struct ag_technique_info *info), char *out, size_t size)
{
    struct ag_technique_info info;
    size_t used = 0;
    out[0] = 0;
    for (int i = 0; ag_technique_get(i, &info) && used < size; i++) {
        if (!has(&info)) continue;
        const int wrote = snprintf(out + used, size - used, "%s%s", used ? ", " : "", info.name);
        used += wrote > 0 ? (size_t)wrote : 0;
    }
}
