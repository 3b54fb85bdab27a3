// Public functions of what a library was built without.
#pragma once

#include "api/objects.h"

// Logs why and returns AG_ERROR_UNSUPPORTED. `what` of the sentence "…: the library was built
// without path tracing (AFTERGLOW_REFERENCE=OFF)".
static inline enum ag_result api_absent(struct ag_context *context, const char *function,
                                        const char *what, const char *option)
{
    if (!context) return AG_ERROR_UNSUPPORTED;
    return api_done(context, host_fail(&context->host, FAIL_UNSUPPORTED,
                                       "cannot call %s: the library was built without %s (%s=OFF)",
                                       function, what, option));
}
