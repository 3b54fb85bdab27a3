// Work that would not fit into the memory of the machine is refused before it begins.
#pragma once

#include "cli/terminal/messages.h"

#include <stdint.h>

// Main memory that the program may use, in bytes: of the machine, or of the control group or
// address space limit (ulimit -v) where that is less. 0: unknown.
uint64_t memory_limit(void);
// Main memory that the process has, and the most that it had, in bytes. 0: unknown.
uint64_t memory_resident(void);
uint64_t memory_peak(void);
// Fails if `bytes` are more than that: "cannot <what>: it takes about 90 GB of memory, this machine
// allows 16 GB; <remedy>". --verbose shows the estimate.
enum status memory_check(uint64_t bytes, const char *what, const char *remedy);
// The same for bytes per pixel of an image, and bytes besides; the remedy is a smaller --size.
enum status memory_check_size(const char *command, const char *scene, int width, int height,
                              uint64_t bytes_per_pixel, uint64_t more);
