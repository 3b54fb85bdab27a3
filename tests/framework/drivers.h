// Drivers and the leak sanitizer: what a driver, a layer or one of their dependencies leaks is
// matched against lsan.supp by the name of its library, which must still be loaded at the exit.
// Without the address sanitizer nothing is done.
#pragma once

#include <stdbool.h>

bool drivers_are_checked(void); // with the address sanitizer

// Between the two a first device is created: leaks of loading cannot be attributed, they are
// ignored.
void drivers_load_begin(void);
void drivers_load_end(void); // keeps all libraries that are loaded now
