// A real browser, driven as a person would: Chromium without a window, over its debugging pipe.
// Chrome DevTools Protocol.
#pragma once

#include "framework/test.h"

#include <jansson.h>

struct browser;

// Skips the running test, visibly, where there is no Chromium. AFTERGLOW_CHROMIUM names one that is
// not in the PATH.
struct browser *browser_open(void);
void browser_close(struct browser *browser);
// Loads a file, and waits until its scripts have run.
void browser_load(struct browser *browser, const char *path, int width, int height);
// The value of an expression in the page; the caller releases it. An exception fails the test.
json_t *browser_value(struct browser *browser, const char *expression, ...)
    __attribute__((format(printf, 2, 3)));
double browser_number(struct browser *browser, const char *expression, ...)
    __attribute__((format(printf, 2, 3)));
bool browser_true(struct browser *browser, const char *expression, ...)
    __attribute__((format(printf, 2, 3)));
// In pixels of the window. type: mouseMoved, mousePressed, mouseReleased; clicks: of the left
// button, 0 for a move.
void browser_mouse(struct browser *browser, const char *type, double x, double y, int clicks);
void browser_wheel(struct browser *browser, double x, double y, double delta);
void browser_key(struct browser *browser, const char *key, int code);
void browser_dark(struct browser *browser, bool dark);
// All that the page complained of (exceptions, errors and warnings of the console) and all
// addresses that it asked for beside its own and data: URIs. "" is the wish.
const char *browser_complaints(const struct browser *browser);
