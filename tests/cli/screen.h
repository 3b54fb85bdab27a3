// A scene file for light maps.
#pragma once

// Writes NAME, a floor of 8 m and a screen of 1 m that stands on it at x. Returns its path.
const char *write_screen(const char *name, double x);
