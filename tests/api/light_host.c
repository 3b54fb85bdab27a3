// light_host [full]: renders with the techniques that a light library has and prints hashes of the
// images, which the full library makes too; then, unless full, checks that what is left out is
// refused in words. Its messages are those of light_build.sh.
#include <afterglow/afterglow.h>

#include <stdio.h>
#include <string.h>

enum { WIDTH = 48, HEIGHT = 32 };

static int failures;

static void check(struct ag_context *context, int ok, const char *what)
{
    if (ok) return;
    failures++;
    printf("%s: %s\n", what, ag_context_last_error(context));
}

// FNV-1a of the pixels' bytes, and whether one is lit.
static void print_hash(const char *gi, const struct ag_image *image)
{
    const size_t count = (size_t)image->width * (size_t)image->height * (size_t)image->channels;
    const unsigned char *bytes = (const unsigned char *)image->pixels;
    uint64_t hash = 14695981039346656037u;
    float most = 0.0f;
    for (size_t i = 0; i < count * sizeof *image->pixels; i++)
        hash = (hash ^ bytes[i]) * 1099511628211u;
    for (size_t i = 0; i < count; i++) most = image->pixels[i] > most ? image->pixels[i] : most;
    if (!(most > 0.0f)) failures++;
    printf("%s %016llx %s\n", gi, (unsigned long long)hash, most > 0.0f ? "lit" : "black");
}

static void render(struct ag_device *device, struct ag_scene *scene, struct ag_context *context,
                   const char *gi)
{
    struct ag_renderer *renderer = NULL;
    struct ag_image *image = NULL;
    struct ag_renderer_desc desc;
    struct ag_frame_desc frame;
    ag_renderer_desc_default(&desc);
    ag_frame_desc_default(&frame);
    desc.width = WIDTH;
    desc.height = HEIGHT;
    desc.gi = gi;
    desc.indirect_layer = true;
    enum ag_result result = ag_scene_default_camera(scene, 0, 0.0, &frame.camera, NULL);
    if (result == AG_OK) result = ag_renderer_create(device, scene, &desc, &renderer);
    for (int i = 0; i < 2 && result == AG_OK; i++) result = ag_renderer_render(renderer, &frame);
    if (result == AG_OK) result = ag_renderer_read(renderer, "indirect", &image);
    check(context, result == AG_OK, gi);
    if (result == AG_OK) print_hash(gi, image);
    ag_image_destroy(context, image);
    ag_renderer_destroy(renderer);
}

static void check_refused(struct ag_context *context, enum ag_result result, const char *option)
{
    check(context,
          result == AG_ERROR_UNSUPPORTED && strstr(ag_context_last_error(context), option) != NULL,
          option);
}

static void check_files(struct ag_context *context, struct ag_scene *scene)
{
    struct ag_scene *none = NULL;
    struct ag_image *image = NULL;
    const struct ag_scene_memory_desc memory = { .bytes = "{}", .size = 2, .name = "x.gltf" };
    const struct ag_scene_image_desc encoded = { .encoded = "x", .encoded_bytes = 1 };
    check_refused(context, ag_scene_load(context, "room.glb", &none), "AFTERGLOW_FILES");
    check_refused(context, ag_scene_load_memory(context, &memory, &none), "AFTERGLOW_FILES");
    check_refused(context, ag_scene_add_image(scene, &encoded, NULL), "AFTERGLOW_FILES");
    check_refused(context, ag_image_read(context, "x.png", NULL, &image), "AFTERGLOW_FILES");
    check_refused(context, ag_image_read(context, "x.exr", NULL, &image), "AFTERGLOW_FILES");
    if (ag_image_create(context, 2, 2, 3, &image) != AG_OK) failures++;
    check_refused(context, ag_image_write_png(context, "x.png", image), "AFTERGLOW_FILES");
    ag_image_destroy(context, image);
}

static void check_left_out(struct ag_context *context, struct ag_device *device,
                           struct ag_scene *scene)
{
    static const char *const of_bakes[] = { "mrt", "drt", "radiosity", "ort", "prt", "lpv+dnrt" };
    struct ag_reference_desc reference_desc;
    struct ag_reference *reference = NULL;
    struct ag_bake *bake = NULL;
    struct ag_renderer *renderer = NULL;
    struct ag_lightmap *lightmap = NULL;
    const char *name = NULL;
    ag_reference_desc_default(&reference_desc);
    ag_scene_default_camera(scene, 0, 0.0, &reference_desc.camera, NULL);
    check_refused(context, ag_reference_create(scene, &reference_desc, &reference),
                  "AFTERGLOW_REFERENCE");
    check_refused(context, ag_bake_create(scene, "radiosity", NULL, &bake), "AFTERGLOW_BAKES");
    check_refused(context, ag_lightmap_technique(context, "lpv", &name), "AFTERGLOW_BAKES");
    for (size_t i = 0; i < sizeof of_bakes / sizeof *of_bakes; i++) {
        struct ag_renderer_desc desc;
        ag_renderer_desc_default(&desc);
        desc.gi = of_bakes[i];
        check_refused(context, ag_renderer_create(device, scene, &desc, &renderer),
                      "AFTERGLOW_BAKES");
    }
    if (ag_bake_run(bake, NULL, NULL) != AG_ERROR_UNSUPPORTED) failures++;
    if (ag_reference_render(reference, 1, NULL, NULL) != AG_ERROR_UNSUPPORTED) failures++;
    if (ag_lightmap_write(lightmap, ".") != AG_ERROR_UNSUPPORTED) failures++;
    check_files(context, scene);
}

int main(int argc, char **argv)
{
    struct ag_context *context = NULL;
    struct ag_device *device = NULL;
    struct ag_scene *scene = NULL;
    if (ag_context_create(NULL, &context) != AG_OK) return 2;
    if (ag_device_create(context, NULL, &device) == AG_ERROR_DEVICE) return 77;
    check(context, ag_scene_load(context, "@cornell:light=point", &scene) == AG_OK, "@cornell");
    render(device, scene, context, "lpv+vo");
    render(device, scene, context, "vct+vo");
    if (argc < 2 || strcmp(argv[1], "full") != 0) check_left_out(context, device, scene);
    ag_scene_destroy(scene);
    ag_device_destroy(device);
    ag_context_destroy(context);
    return failures ? 1 : 0;
}
