// Dynamic objects outside the scene, lit by it: white balls. Their indirect light comes from the
// probes of a technique; this program draws them on the CPU.
//
//     balls SCENE GI WIDTH HEIGHT OUT.png
//     balls @planter lpv:probes=true 640 480 balls.png
#include <afterglow/afterglow.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { BALLS_A_SIDE = 6 };
static const float PI = 3.14159265f;

// Layers of the frame and the axes of the camera.
struct view {
    struct ag_image *color, *depth;
    struct ag_probes *probes;
    float ev;
    float eye[3], right[3], up[3], forward[3], half_height; // of the image at distance 1
};

static float dot(const float *a, const float *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const float *a, const float *b, float *out)
{
    for (int i = 0; i < 3; i++)
        out[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

static void unit(float *v)
{
    float length = sqrtf(dot(v, v));
    for (int i = 0; i < 3; i++) v[i] /= length;
}

static void aim(struct view *view, const struct ag_camera *camera)
{
    for (int i = 0; i < 3; i++) {
        view->eye[i] = camera->eye[i];
        view->forward[i] = camera->target[i] - camera->eye[i];
    }
    unit(view->forward);
    cross(view->forward, camera->up, view->right);
    unit(view->right);
    cross(view->right, view->forward, view->up);
    view->half_height = tanf(0.5f * camera->vertical_fov_rad);
}

// Direction of a primary ray, one metre along the view axis.
static void primary_ray(const struct view *view, int x, int y, float *direction)
{
    float width = (float)view->color->width, height = (float)view->color->height;
    float right = (2 * ((float)x + 0.5f) - width) / height * view->half_height;
    float up = (1 - 2 * ((float)y + 0.5f) / height) * view->half_height;
    for (int i = 0; i < 3; i++)
        direction[i] = view->forward[i] + right * view->right[i] + up * view->up[i];
}

// Distance to the front of the ball; 0: no hit, or the origin is inside.
static float hit_distance(const float *eye, const float *direction, const float *centre,
                          float radius)
{
    float to[3] = { centre[0] - eye[0], centre[1] - eye[1], centre[2] - eye[2] };
    float along = dot(to, direction) / dot(direction, direction);
    float beside = dot(to, to) - along * along * dot(direction, direction);
    float half = sqrtf(fmaxf(radius * radius - beside, 0) / dot(direction, direction));
    return half > 0 && along > half ? along - half : 0;
}

// Draws a white ball where it is in front of the scene. Depth is in metres along the view axis, 0
// for background.
static void draw_ball(struct view *view, const float *centre, float radius)
{
    for (int y = 0; y < view->color->height; y++) {
        for (int x = 0; x < view->color->width; x++) {
            int pixel = y * view->color->width + x;
            float *depth = &view->depth->pixels[pixel], direction[3], normal[3], lux[3];
            primary_ray(view, x, y, direction);
            float distance = hit_distance(view->eye, direction, centre, radius);
            if (distance <= 0 || (*depth > 0 && *depth < distance)) continue;
            *depth = distance;
            for (int i = 0; i < 3; i++)
                normal[i] = (view->eye[i] + distance * direction[i] - centre[i]) / radius;
            ag_probes_irradiance(view->probes, centre, normal, lux);
            for (int i = 0; i < 3; i++) view->color->pixels[3 * pixel + i] = 0.8f / PI * lux[i];
        }
    }
}

static void draw_balls(struct view *view, const float *low, const float *high)
{
    float longest = 0, centre[3];
    for (int i = 0; i < 3; i++) longest = fmaxf(longest, high[i] - low[i]);
    for (int n = 0; n < BALLS_A_SIDE * BALLS_A_SIDE * BALLS_A_SIDE; n++) {
        int at[3] = { n % BALLS_A_SIDE, n / BALLS_A_SIDE % BALLS_A_SIDE,
                      n / BALLS_A_SIDE / BALLS_A_SIDE };
        for (int i = 0; i < 3; i++)
            centre[i] = low[i] + (high[i] - low[i]) * ((float)at[i] + 0.5f) / BALLS_A_SIDE;
        draw_ball(view, centre, 0.012f * longest);
    }
}

static enum ag_result take(struct ag_device *device, struct ag_scene *scene,
                           const struct ag_renderer_desc *desc, const struct ag_frame_desc *frame,
                           struct view *out)
{
    struct ag_renderer *renderer = NULL;
    enum ag_result result = ag_renderer_create(device, scene, desc, &renderer);
    if (result == AG_OK) result = ag_renderer_render(renderer, frame);
    if (result == AG_OK) result = ag_renderer_read(renderer, "color", &out->color);
    if (result == AG_OK) result = ag_renderer_read(renderer, "depth", &out->depth);
    if (result == AG_OK) result = ag_renderer_read_probes(renderer, &out->probes);
    if (result == AG_OK) result = ag_renderer_exposure(renderer, &out->ev);
    ag_renderer_destroy(renderer);
    return result;
}

static enum ag_result run(struct ag_context *context, char **argv, struct view *view)
{
    struct ag_device *device = NULL;
    struct ag_scene *scene = NULL;
    struct ag_image *display = NULL;
    struct ag_renderer_desc desc;
    struct ag_frame_desc frame;
    struct ag_scene_info info;
    ag_frame_desc_default(&frame);
    ag_renderer_desc_default(&desc);
    desc.gi = argv[2];
    desc.width = atoi(argv[3]);
    desc.height = atoi(argv[4]);

    enum ag_result result = ag_device_create(context, NULL, &device);
    if (result == AG_OK) result = ag_scene_load(context, argv[1], &scene);
    if (result == AG_OK) result = ag_scene_add_default_lighting(scene, NULL);
    if (result == AG_OK) result = ag_scene_default_camera(scene, 0, 0.0, &frame.camera, NULL);
    if (result == AG_OK) result = ag_scene_get_info(scene, 0, 0.0, &info);
    if (result == AG_OK) result = take(device, scene, &desc, &frame, view);
    if (result == AG_OK) {
        aim(view, &frame.camera);
        draw_balls(view, info.bounds_min, info.bounds_max);
        result = ag_image_tonemap(context, view->color, view->ev, &display);
    }
    if (result == AG_OK) result = ag_image_write_png(context, argv[5], display);
    ag_image_destroy(context, display);
    ag_scene_destroy(scene);
    ag_device_destroy(device);
    return result;
}

int main(int argc, char **argv)
{
    if (argc != 6) {
        fprintf(stderr, "usage: balls SCENE GI WIDTH HEIGHT OUT.png\n");
        return 2;
    }
    struct ag_context *context = NULL;
    struct view view = { 0 };
    enum ag_result result = ag_context_create(NULL, &context);
    if (result == AG_OK) result = run(context, argv, &view);
    if (result != AG_OK) fprintf(stderr, "balls: %s\n", ag_context_last_error(context));
    ag_probes_destroy(context, view.probes);
    ag_image_destroy(context, view.color);
    ag_image_destroy(context, view.depth);
    ag_context_destroy(context);
    return result == AG_OK ? 0 : 1;
}
