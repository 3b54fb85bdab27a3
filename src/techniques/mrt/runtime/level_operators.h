// Operators of the dictionary in the frames of the blocks of a level: input of the run time.
#pragma once

#include "techniques/mrt/level/level.h"
#include "techniques/mrt/runtime/input.h"

struct mrt_level_operators {
    struct host *host;
    struct mrt_basis_input *bases; // room for two of each block
    int *basis_of_block;
    struct mrt_response_input *responses; // by mrt_response_of
    struct mrt_opening_input *openings;
    struct mrt_pair_input *pairs;
    struct mrt_runtime_input input; // without atlas and geometry; refers to the level
};

bool mrt_level_operators_init(struct host *host, const struct mrt_level *level,
                              struct mrt_level_operators *out);
void mrt_level_operators_finish(struct mrt_level_operators *operators);

void mrt_response_input_finish(struct host *host, struct mrt_response_input *response);
