// Renderers and views of the fixture's scene.
#include "api/view_fixture.h"

#include <string.h>

struct ag_camera view_other_camera(const struct ag_camera *camera)
{
    struct ag_camera other = *camera;
    for (int i = 0; i < 3; i++)
        other.eye[i] += 0.3f * (camera->target[i] - camera->eye[i]) + (i == 0 ? 0.4f : 0.1f);
    other.vertical_fov_rad *= 1.2f;
    return other;
}

struct ag_renderer *view_make_renderer(struct renderer_fixture *s, const char *gi, int width,
                                       int height, const struct ag_bake *bake)
{
    struct ag_renderer *renderer = NULL;
    struct ag_renderer_desc desc = fixture_renderer_desc(gi);
    desc.width = width;
    desc.height = height;
    desc.bakes = &bake;
    desc.bake_count = bake != NULL;
    if (ag_renderer_create(s->device, s->scene, &desc, &renderer) != AG_OK)
        fail_msg("%s: %s", gi, ag_context_last_error(s->context));
    return renderer;
}

struct ag_view *view_create(struct renderer_fixture *s, struct ag_renderer *renderer,
                            const struct ag_view_desc *desc)
{
    struct ag_view *view = NULL;
    if (ag_view_create(renderer, desc, &view) != AG_OK)
        fail_msg("%s", ag_context_last_error(s->context));
    return view;
}

struct ag_view *view_make(struct renderer_fixture *s, struct ag_renderer *renderer, int width,
                          int height)
{
    struct ag_view_desc desc;
    ag_view_desc_default(&desc);
    desc.width = width;
    desc.height = height;
    desc.indirect_layer = desc.motion_layer = desc.all_layers = true;
    return view_create(s, renderer, &desc);
}

struct ag_view *view_make_lean(struct renderer_fixture *s, struct ag_renderer *renderer, int width,
                               int height)
{
    struct ag_view_desc desc;
    ag_view_desc_default(&desc);
    desc.width = width;
    desc.height = height;
    return view_create(s, renderer, &desc);
}

void view_render(struct renderer_fixture *s, struct ag_renderer *renderer,
                 const struct ag_camera *camera, const struct ag_view_frame *views, int count)
{
    struct ag_frame_desc frame = s->frame;
    frame.camera = *camera;
    frame.views = views;
    frame.view_count = count;
    if (ag_renderer_render(renderer, &frame) != AG_OK)
        fail_msg("%s: %s", ag_renderer_gi(renderer), ag_context_last_error(s->context));
}

struct ag_view_frame view_in_frame(struct ag_view *view, const struct ag_camera *camera)
{
    struct ag_view_frame frame;
    ag_view_frame_default(&frame);
    frame.view = view;
    frame.camera = *camera;
    return frame;
}

struct ag_image *view_read_layer(struct renderer_fixture *s, struct ag_renderer *renderer,
                                 struct ag_view *view, const char *layer)
{
    struct ag_image *image = NULL;
    if (!view) return fixture_read_from(s, renderer, layer);
    if (ag_view_read(view, layer, &image) != AG_OK)
        fail_msg("%s: %s", layer, ag_context_last_error(s->context));
    return image;
}

void view_check_layer(struct renderer_fixture *s, const char *layer, struct ag_renderer *renderer,
                      struct ag_view *view, struct ag_renderer *alone)
{
    struct ag_image *got = view_read_layer(s, renderer, view, layer);
    struct ag_image *expected = fixture_read_from(s, alone, layer);
    assert_true(got->width == expected->width && got->height == expected->height);
    const size_t bytes =
        sizeof *got->pixels * (size_t)got->width * (size_t)got->height * (size_t)got->channels;
    if (memcmp(got->pixels, expected->pixels, bytes) != 0)
        fail_msg("%s of the %s differs by %g", layer, view ? "view" : "renderer's camera",
                 fixture_difference(got, expected));
    ag_image_destroy(s->context, got);
    ag_image_destroy(s->context, expected);
}
