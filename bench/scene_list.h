// Scenes of a list such as light_levels.txt: "NAME MARK SCENE OPTIONS" in each line. Of the command
// line's options --light (suns), --sky, --eye, --target and --fov are known.
#ifndef AG_BENCH_SCENE_LIST_H
#define AG_BENCH_SCENE_LIST_H

#include <afterglow/afterglow.h>

struct listed_scene {
    char name[64], path[1024];
    bool has_sun, has_sky, has_eye;
    float direction[3], lux[3], sky[3], eye[3], target[3], fov_deg;
};

// Calls `each` with the scenes whose names match the regular expression from the start. "SCENES/"
// stands for the folder $AFTERGLOW_SCENES; without it such scenes are left out.
enum ag_result scene_list_each(const char *file, const char *regex,
                               enum ag_result (*each)(void *user, const struct listed_scene *scene),
                               void *user);
enum ag_result listed_scene_light(const struct listed_scene *listed, struct ag_scene *scene);
enum ag_result listed_scene_camera(const struct listed_scene *listed, struct ag_scene *scene,
                                   struct ag_camera *out);

#endif
