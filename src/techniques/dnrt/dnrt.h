#pragma once

#include "techniques/technique.h"

extern const struct technique technique_dnrt;
