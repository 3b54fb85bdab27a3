// Defaults and ranges of the catalogue's options, as text.
#include "option_text.h"

#include <stdio.h>
#include <string.h>

bool option_is(const struct ag_option_info *option, const char *type)
{
    return strcmp(option->type, type) == 0;
}

const char *option_choice(const char *choices, int index, char out[64])
{
    for (; index > 0 && *choices; index--) {
        choices += strcspn(choices, "|");
        choices += *choices == '|';
    }
    snprintf(out, 64, "%.*s", (int)strcspn(choices, "|"), choices);
    return out;
}

const char *option_default(const struct ag_option_info *o, char out[64])
{
    if (option_is(o, "choice")) return option_choice(o->unit, (int)o->initial, out);
    if (option_is(o, "bool")) return o->initial != 0.0 ? "true" : "false";
    if (option_is(o, "text")) return "";
    snprintf(out, 64, "%g", o->initial);
    return out;
}

void option_range(const struct ag_option_info *o, char out[512])
{
    out[0] = 0;
    if (option_is(o, "choice") || option_is(o, "text"))
        snprintf(out, 512, " (%s)", o->unit);
    else if (!option_is(o, "bool"))
        snprintf(out, 512, " (%g to %g%s%s)", o->min, o->max, o->unit[0] ? " " : "", o->unit);
}
