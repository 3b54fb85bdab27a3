#include "core/c_locale.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

struct c_locale c_locale_enter(void)
{
    struct c_locale scope = { .c = newlocale(LC_ALL_MASK, "C", (locale_t)0) };
    if (scope.c) scope.before = uselocale(scope.c);
    return scope;
}

void c_locale_leave(struct c_locale scope)
{
    if (!scope.c) return;
    uselocale(scope.before);
    freelocale(scope.c);
}

int c_locale_print(char *out, size_t size, const char *format, ...)
{
    va_list values;
    const struct c_locale scope = c_locale_enter();
    va_start(values, format);
    const int length = vsnprintf(out, size, format, values);
    va_end(values);
    c_locale_leave(scope);
    return length;
}

double c_locale_parse(const char *text, char **end)
{
    const struct c_locale scope = c_locale_enter();
    const double value = strtod(text, end);
    c_locale_leave(scope);
    return value;
}
