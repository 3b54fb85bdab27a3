// afterglow compare: measures methods against the reference.
#include "cli/bake/baking.h"
#include "commands.h"
#include "cli/compare/compare.h"
#include "cli/files/json.h"
#include "memory.h"
#include "cli/compare/report_page.h"

#include <stdio.h>
#include <stdlib.h>

static const char REPORT[] = "report.json";

// The reference with its eight layers; depth, mask, error maps and the planes of ssim and flip; of
// each method four layers. `more`: besides the images.
static enum status check_memory(const struct comparison *c, uint64_t more)
{
    const struct arguments *a = c->arguments;
    const uint64_t bytes = tracing_bytes_per_pixel(8) + 96 + 64 * (uint64_t)c->method_count;
    return memory_check_size("compare", a->positional[0], a->width, a->height, bytes, more);
}

// Detects wrong usage and unwritable folders before any file or device is opened.
static enum status plan(struct comparison *c)
{
    const struct arguments *a = c->arguments;
    char folder[PATH_SIZE];
    output_default(a->positional[0], "-compare", folder);
    enum status status = methods_plan(c);
    if (status == DONE) status = check_memory(c, 0);
    if (status == DONE)
        status = folder_plan(&c->folder, a->output ? a->output : folder, REPORT, files_are_named);
    return status;
}

static enum status check_bakes(const struct comparison *c)
{
    const char *gis[MAX_METHODS];
    for (int i = 0; i < c->method_count; i++) gis[i] = c->methods[i].gi;
    return bakes_check_files(&c->session, gis, c->method_count);
}

// A software device has its images in main memory.
static enum status check_memory_with_device(const struct comparison *c)
{
    struct ag_device_info device;
    ag_device_get_info(c->device, &device);
    return device.software ? check_memory(c, c->gpu_bytes) : DONE;
}

static enum status open_device(struct comparison *c)
{
    struct ag_device_desc desc;
    ag_device_desc_default(&desc);
    desc.device = c->arguments->device;
    enum ag_result result = ag_device_create(c->session.context, &desc, &c->device);
    if (result == AG_OK) return DONE;
    fail_library(c->session.context, result);
    return FAILED; // a missing device is not wrong usage
}

static enum status prepare(struct comparison *c)
{
    const struct arguments *a = c->arguments;
    enum status status = session_load(&c->session, a->positional[0], a->scene_scale);
    if (status == DONE) status = session_light(&c->session);
    if (status == DONE) status = session_camera(&c->session, a->time_s, &c->camera);
    if (status == DONE) status = reference_begin(c);
    if (status == DONE) status = open_device(c);
    if (status == DONE) status = methods_estimate(c); // with the size of the scene
    if (status == DONE) status = check_memory_with_device(c);
    if (status == DONE) session_say(&c->session);
    return status;
}

// Validation messages make the rendered images untrustworthy.
static enum status check_device(const struct comparison *c)
{
    if (ag_device_validation_messages(c->device) == 0) return DONE;
    return fail("cannot trust %s: Vulkan validation logged messages (see --verbose)",
                c->arguments->positional[0]);
}

static enum status write_folder(struct comparison *c, const json_t *report)
{
    char path[PATH_SIZE];
    enum status status = folder_begin(&c->folder);
    if (status == DONE) status = files_write(c);
    if (status == DONE && !folder_file(&c->folder, REPORT, path))
        status = fail("cannot write %s: the path is too long", c->folder.shown);
    if (status == DONE) status = json_write(report, path);
    if (status == DONE) status = report_page_write(c->folder.beside.path, report);
    if (status == DONE) status = folder_commit(&c->folder, REPORT);
    return status;
}

static enum status publish(struct comparison *c)
{
    json_t *report = report_json(c);
    if (!report) return fail("cannot compare %s: out of memory", c->arguments->positional[0]);
    enum status status = write_folder(c, report);
    if (status != DONE) {
        json_decref(report);
        return status;
    }
    if (c->arguments->json) {
        status = json_print(report); // takes ownership
    } else {
        report_print(c);
        json_decref(report);
    }
    if (!c->arguments->output) note("written: %s", c->folder.shown);
    return status == DONE ? report_gates(c) : status;
}

static enum status compare(const struct arguments *arguments)
{
    struct comparison *c = calloc(1, sizeof *c);
    if (!c) return fail("cannot compare %s: out of memory", arguments->positional[0]);
    c->arguments = arguments;
    enum status status = session_begin(&c->session, arguments);
    if (status == DONE) status = plan(c);
    if (status == DONE) status = check_bakes(c);
    if (status == DONE) status = prepare(c);
    for (int i = 0; i < c->method_count && status == DONE; i++) status = method_render(c, i);
    if (status == DONE) status = check_device(c);
    if (status == DONE) status = reference_complete(c);
    if (status == DONE) status = reference_expose(c);
    if (status == DONE) status = methods_measure(c);
    if (status == DONE) status = publish(c);

    folder_abort(&c->folder);
    methods_finish(c);
    reference_finish(c);
    ag_scene_destroy(c->session.scene);
    c->session.scene = NULL;
    ag_device_destroy(c->device);
    session_end(&c->session);
    free(c);
    return status;
}

const struct command command_compare = {
    .name = "compare",
    .bit = COMPARE,
    .positional_count = 1,
    .usage = "SCENE [options]",
    .summary = "measure error, time and memory of methods against the reference",
    .text = "Renders SCENE with each --gi on the GPU and path-traces it on the CPU.\n"
            "Writes a folder: report.html, images, error maps and .exr files.\n"
            "All images have the same camera, light and exposure.\n"
            "\n"
            "The reference takes most of the time, proportional to pixels times --spp.\n"
            "On two cores: 640x360 of a room half a minute;\n"
            "1280x720 of a large scene with --spp 512 half an hour.\n"
            "Ctrl-C caches its samples; the same command continues with them.\n",
    .examples = "  afterglow compare @cornell --size 320x180 --spp 64\n"
                "      none, ambient and lpv, into cornell-compare\n"
                "  afterglow compare house.glb --size 640x360 --gi lpv:steps=16 --gi lpv -o house\n"
                "      one technique with two settings\n"
                "  afterglow reference @atrium --size 640x360 --spp 1024 -o atrium.exr\n"
                "  afterglow compare @atrium --size 640x360 --reference atrium.exr\n"
                "      use a reference traced before\n"
                "  afterglow compare @cornell --size 160x90 --gi lpv --max-flip 0.4 --quiet\n"
                "      in a test: exit status 1 if the error of lpv exceeds the bound\n",
    .run = compare,
};
