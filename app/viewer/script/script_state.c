#include "script_state.h"

#include "viewer/state.h"

#include <string.h>

bool script_wrong(struct script *script, const char *what, const char *text)
{
    snprintf(script->error, sizeof script->error, "%.250s:%d: %.350s%s%.350s", script->path,
             script->line, what, text[0] ? " " : "", text);
    return false;
}

bool script_done(const struct words *w, bool success)
{
    return success || script_wrong(w->script, w->v->message, "");
}

bool script_is(const struct words *w, const char *name)
{
    return strcmp(w->name, name) == 0;
}
