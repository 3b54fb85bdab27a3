// Screen-space reflections.
#pragma once

#include "techniques/technique.h"

extern const struct technique technique_ssr;
