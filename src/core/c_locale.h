// Numbers in texts with a decimal point, whatever the locale of the host program.
#pragma once

#include <locale.h>
#include <stddef.h>

// snprintf in the C locale.
__attribute__((format(printf, 3, 4))) int c_locale_print(char *out, size_t size, const char *format,
                                                         ...);
// strtod in the C locale.
double c_locale_parse(const char *text, char **end);

struct c_locale { // private
    locale_t c, before;
};
// Switches the calling thread to the C locale, until c_locale_leave of the result. Without memory
// the locale stays.
struct c_locale c_locale_enter(void);
void c_locale_leave(struct c_locale scope);
