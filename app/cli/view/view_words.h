// The options of the command line that give the scene of view again, for "Copy as command".
#pragma once

#include "cli/session.h"

enum { VIEW_WORDS_SIZE = 8192 };

// Each with a blank before each word; "": none are needed.
struct view_words {
    char scene[SPEC_SIZE + 128], camera[2 * SPEC_SIZE];
    char light[VIEW_WORDS_SIZE];
    char kept[VIEW_WORDS_SIZE];        // of light: area lights
    char environment[VIEW_WORDS_SIZE]; // the value of --environment without rotation and strength
};

// camera: as the session gave it.
void view_words(const struct session *session, const struct ag_camera *camera,
                struct view_words *out);
