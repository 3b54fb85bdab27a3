// The tables that tools/samples made.
#include "techniques/common/sample_sets.h"

#include <assert.h>

#include "techniques/common/sample_sets_disk.inc"
#include "techniques/common/sample_sets_ball.inc"

const struct sample_set *sample_set_at(enum sample_shape shape, int index)
{
    assert(index >= 0 && index < SAMPLE_SET_COUNT);
    return shape == SAMPLE_BALL ? &ball_sets[index] : &disk_sets[index];
}
