// Drives headless Chromium through its debugging pipe (Chrome DevTools Protocol).
#pragma once

#include "framework/test.h"

#include <jansson.h>

struct browser;

// Skips the test, visibly, without Chromium. AFTERGLOW_CHROMIUM names one outside the PATH.
struct browser *browser_open(void);
void browser_close(struct browser *browser);
// Loads a file and waits for its scripts.
void browser_load(struct browser *browser, const char *path, int width, int height);
// Value of an expression in the page; the caller releases it. An exception fails the test.
json_t *browser_value(struct browser *browser, const char *expression, ...)
    __attribute__((format(printf, 2, 3)));
double browser_number(struct browser *browser, const char *expression, ...)
    __attribute__((format(printf, 2, 3)));
bool browser_true(struct browser *browser, const char *expression, ...)
    __attribute__((format(printf, 2, 3)));
// Position in window pixels. type: mouseMoved, mousePressed, mouseReleased; clicks of the left
// button, 0 for a move.
void browser_mouse(struct browser *browser, const char *type, double x, double y, int clicks);
void browser_wheel(struct browser *browser, double x, double y, double delta);
void browser_key(struct browser *browser, const char *key, int code);
void browser_dark(struct browser *browser, bool dark);
// Exceptions, errors and warnings of the page, and all requests except for itself and data: URIs;
// "" expected.
const char *browser_complaints(const struct browser *browser);
