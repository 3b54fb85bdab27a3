// The words of one value, from the tables of techniques, scenes and layers.
#pragma once

#include <stdbool.h>

// Candidates are printed after the first characters of this text: "--gi=" of "--gi=lpv".
void candidates_prefix(const char *text, int length);

struct candidate_word {
    const char *kept; // text before the name
    int kept_length;
    const char *typed; // beginning of the name
};
// Prints kept + name + suffix, with the first line of `help`, if it begins with kept + typed.
void candidate(const struct candidate_word *word, const char *name, const char *suffix,
               const char *help);

// "lpv:steps=4,filter=…+vo": a GI spec.
void candidates_gi(const char *typed);
// "@maze:blocks=3,…": a built-in scene.
void candidates_scene(const char *typed);
// Techniques and "@scene", for `list`.
void candidates_names(const char *typed);
// "shadow_size=2048,…"
void candidates_frame_options(const char *typed);
// "color,depth,…": names that the list does not have yet.
void candidates_layers(const char *typed, const char *(*layer_name)(int index));
void candidates_debug_views(const char *typed);
