// Entries of a row of form factors.
#ifndef AG_RADIOSITY_ROW_GLSL
#define AG_RADIOSITY_ROW_GLSL

#include "techniques/radiosity/radiosity_shared.h"

uint radiosity_source(uint word)
{
    return word & ((1u << RADIOSITY_NODE_BITS) - 1u);
}

float radiosity_form_factor(uint word)
{
    return unpackHalf2x16(word >> RADIOSITY_NODE_BITS).x;
}

// Rows end with zeros.
bool radiosity_has_ended(uint word)
{
    return word >> RADIOSITY_NODE_BITS == 0u;
}

#endif
