// The viewer with the scene of the command line, and others that are opened in its window.
#pragma once

#include "cli/session.h"

enum status viewing_run(const struct arguments *arguments);
