// Options with which the bakes of techniques take moments in a small scene.
#pragma once

// NULL: the technique has no bake.
const char *cheap_bake(const char *technique);
