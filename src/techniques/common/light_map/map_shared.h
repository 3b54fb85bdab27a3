// Data of the passes that make and show a light map. Scalar layout.
#ifndef AG_LIGHT_MAP_MAP_SHARED_H
#define AG_LIGHT_MAP_MAP_SHARED_H

#include "core/shared.h"

// Tables are images of this width (table.h).
#define LIGHT_MAP_TABLE_WIDTH 4096u

#endif
