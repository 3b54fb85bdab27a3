// Techniques that a library without bakes (AFTERGLOW_BAKES=OFF) does not have.
#include "techniques/registry.h"

#include <string.h>

bool technique_left_out(const char *name)
{
    static const char *const of_bakes[] = { "mrt", "drt", "radiosity", "ort", "prt", "dnrt" };
    for (size_t i = 0; !AG_BAKES && i < sizeof of_bakes / sizeof *of_bakes; i++)
        if (strcmp(of_bakes[i], name) == 0) return true;
    return false;
}
