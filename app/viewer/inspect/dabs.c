#include "dabs.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// A texel is behind if its depth exceeds these: of its distance along a curved surface, in texels.
static const float BEHIND = 0.5f, BEHIND_TEXELS = 1.5f;

bool dabs_add(struct dabs *dabs, const struct dab *dab)
{
    if (dabs->count == DABS_MOST) return false;
    if (dabs->count == dabs->capacity) {
        const int capacity = dabs->capacity > 0 ? 2 * dabs->capacity : 64;
        struct dab *at = realloc(dabs->at, (size_t)capacity * sizeof *at);
        if (!at) return false;
        dabs->at = at;
        dabs->capacity = capacity;
    }
    dabs->at[dabs->count++] = *dab;
    return true;
}

bool dabs_copy(struct dabs *to, const struct dabs *from)
{
    *to = (struct dabs){ 0 };
    if (from->count == 0) return true;
    to->at = malloc((size_t)from->count * sizeof *to->at);
    if (!to->at) return false;
    memcpy(to->at, from->at, (size_t)from->count * sizeof *to->at);
    to->count = to->capacity = from->count;
    return true;
}

// A dab has floats alone, without padding.
bool dabs_same(const struct dabs *a, const struct dabs *b)
{
    return a->count == b->count &&
           (a->count == 0 || memcmp(a->at, b->at, (size_t)a->count * sizeof *a->at) == 0);
}

void dabs_close(struct dabs *dabs)
{
    free(dabs->at);
    *dabs = (struct dabs){ 0 };
}

float dab_weight(const struct dab *dab, const float texel[3], float texel_m)
{
    float square = 0, height = 0;
    for (int i = 0; i < 3; i++) {
        const float d = texel[i] - dab->position[i];
        square += d * d;
        height += d * dab->normal[i];
    }
    const float far = square / (dab->radius * dab->radius);
    const float along = sqrtf(fmaxf(square - height * height, 0.0f));
    if (!(far < 1.0f) || -height > BEHIND * along + BEHIND_TEXELS * texel_m) return 0;
    return (1.0f - far) * (1.0f - far);
}
