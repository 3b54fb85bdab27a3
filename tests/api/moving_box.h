// A box that moves in a room that drt lights, through the public API.
#pragma once

#include "api/renderer_fixture.h"

#define MOVING_BOX_SCENE      "@cornell:light=point"
#define MOVING_BOX_BACKGROUND "drt:map=single," FIXTURE_SMALL_DICTIONARY
#define MOVING_BOX_WAIT       "drt:map=single,update=wait," FIXTURE_SMALL_DICTIONARY

// Surfaces of a scene stay while a bake uses it: the dictionary, which is that of all scenes, has a
// scene of its own. The caller destroys both; NULL: failed.
struct ag_bake *moving_box_bake(struct ag_context *context, struct ag_scene **scene);
// Its instance, at x = -1; -1: failed.
int moving_box_add(struct ag_scene *scene);
enum ag_result moving_box_place(struct ag_scene *scene, int instance, float x);
