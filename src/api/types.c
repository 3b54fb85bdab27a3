// Results and versions.
#include "api/objects.h"

#include "core/text.h"

const char *ag_result_string(enum ag_result result)
{
    switch (result) {
    case AG_OK:
        return "done";
    case AG_ERROR_ARGUMENT:
        return "wrong argument";
    case AG_ERROR_FILE:
        return "file cannot be opened, read or written";
    case AG_ERROR_FORMAT:
        return "wrong file content";
    case AG_ERROR_UNSUPPORTED:
        return "not supported";
    case AG_ERROR_MEMORY:
        return "out of memory";
    case AG_ERROR_DEVICE:
        return "no usable GPU";
    case AG_ERROR_CANCELLED:
        return "cancelled";
    }
    return "unknown result";
}

int ag_version(void)
{
    return AG_VERSION;
}

size_t ag_printable(const char *text, char *out, size_t size)
{
    return out && size > 0 ? text_escape(text ? text : "", out, size) : 0;
}
