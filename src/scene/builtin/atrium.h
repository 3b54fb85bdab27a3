// Parts of @atrium: the building (atrium.c), its drapes and furniture (atrium_furniture.c).
#pragma once

#include "scene/builtin/parts.h"

// Metres. The courtyard is open to the sky; aisles run along both its sides on two storeys. The
// long axis is x.
#define ATRIUM_HALF_LENGTH 12.0f // inner face of the end walls
#define ATRIUM_COLONNADE   3.5f  // z of the columns' axes
#define ATRIUM_HALF_WIDTH  7.0f  // inner face of the long walls
#define ATRIUM_GALLERY     5.1f  // floor of the upper storey
#define ATRIUM_BAY         3.0f  // between columns
#define ATRIUM_BAYS        8
#define ATRIUM_ARCH_LOW    3.2f // top of the lower columns
#define ATRIUM_ARCH_HIGH   7.7f // top of the upper ones
#define ATRIUM_ROOF        9.2f // underside of the aisles' roof

enum atrium_material {
    ATRIUM_WALL,
    ATRIUM_STONE,
    ATRIUM_FLOOR,
    ATRIUM_PLASTER,
    ATRIUM_WOOD,
    ATRIUM_RED,
    ATRIUM_GREEN,
    ATRIUM_BLUE,
    ATRIUM_TERRACOTTA,
    ATRIUM_BRASS,
    ATRIUM_WATER,
    ATRIUM_MATERIALS
};

bool atrium_drapes(struct scene *scene, const int *materials);
bool atrium_furniture(struct scene *scene, const int *materials);

// The x of column k, 0…ATRIUM_BAYS.
static inline float atrium_column_x(int k)
{
    return -ATRIUM_HALF_LENGTH + ATRIUM_BAY * (float)k;
}
