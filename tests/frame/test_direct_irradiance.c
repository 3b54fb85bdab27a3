// Irradiance of direct light: what the diffuse lobe of FRAME_DIRECT reflects, and its replacement.
#include "frame/frame_fixture.h"
#include "frame/frame_state.h"

#include "frame_test_shaders.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double PI = 3.14159265358979323846;
static const double ROUNDING = 1.0 / 1024;   // of a half float, relative: some drivers truncate
static const double LEAST = 1.0 / (1 << 24); // of a scaled value: the least half float
static const uint32_t SIZE = 64;
static const vec3s LUX = { { 1000, 700, 400 } };

// Matte surfaces whose specular lobe is 0, an unlit and an emissive one, and the sky. White, since
// drivers decode other sRGB values inexactly.
static void begin(struct frame_fixture *s, struct gpu *gpu)
{
    fixture_init(s, gpu);
    const int matte = fixture_matte(s, vec3_of(1, 1, 1));
    struct material m = material_default();
    m.specular = 0; // the base colour is white
    m.emissive = vec3_of(30, 20, 10);
    const int emissive = fixture_material(s, &m);
    m.unlit = true;
    const int unlit = fixture_material(s, &m);
    fixture_floor(s, 5, matte);
    fixture_box(s, vec3_of(-1, 0, -0.6f), vec3_of(-0.3f, 0.7f, 0.4f), false, matte);
    fixture_box(s, vec3_of(0.6f, 0, -1.5f), vec3_of(2.4f, 1.4f, 0.5f), false, emissive);
    fixture_box(s, vec3_of(-0.2f, 0, 0.6f), vec3_of(0.2f, 0.3f, 1), false, unlit);
    fixture_quad(s, vec3_of(-1, 0.8f, 0.5f), vec3_of(1, 1, 0.5f), vec3_of(1, 1, -0.5f),
                 vec3_of(-1, 0.8f, -0.5f), matte);
    fixture_look(s, vec3_of(1.2f, 1.3f, 3), vec3_of(0, 0.6f, 0));
    s->input.environment.sky = vec3_of(50, 60, 70);
    s->width = s->height = SIZE;
    s->indirect.needs = FRAME_NEEDS_DIRECT_IRRADIANCE;
}

static void add_sun(struct frame_fixture *s)
{
    fixture_add_sun(s, vec3_of(0.7f, -0.45f, 0.3f), LUX);
}

static void add_locals(struct frame_fixture *s)
{
    fixture_add_point(s, vec3_of(-1.5f, 1.5f, 1.5f), vec3_of(200, 400, 300));
    fixture_add_spot(s, vec3_of(1, 2.5f, 1.5f), vec3_of(-0.4f, -1, -0.5f), 0.3f, 0.6f,
                     vec3_of(900, 600, 300));
}

static bool has_layer(const struct frame_fixture *s)
{
    return frame_layer_image(s->frame, FRAME_DIRECT_IRRADIANCE).id != 0;
}

// As it is stored: four channels, scaled. Owned by the caller.
static float *read_layer(struct frame_fixture *s, enum frame_layer layer)
{
    const size_t count = (size_t)s->width * s->height * 4;
    float *texels = calloc(count, sizeof *texels);
    assert_non_null(texels);
    assert_true(gpu_image_download_float(s->gpu, frame_layer_image(s->frame, layer), 0, 0, texels,
                                         4, count));
    return texels;
}

struct counts {
    int lit, shadowed, without; // surfaces with light, surfaces without, other pixels
    double worst;               // difference in half roundings
};

static void check_pixel(struct counts *counts, const float *direct, const float *irradiance,
                        const float *albedo, const float *emissive)
{
    const bool is_lit = albedo[3] > 0.75f;
    CHECK(irradiance[3] == (is_lit ? 1.0f : 0.0f));
    if (!is_lit) {
        CHECK(irradiance[0] == 0 && irradiance[1] == 0 && irradiance[2] == 0);
        counts->without++;
        return;
    }
    *(irradiance[0] > 0 ? &counts->lit : &counts->shadowed) += 1;
    for (int k = 0; k < 3; k++) {
        const double product = (double)albedo[k] * (double)direct[3] / PI * (double)irradiance[k];
        const double expected = product + (double)emissive[k];
        // Rounding of the layer, of direct light, and of its alpha.
        const double rounding = ROUNDING * (product + expected + product) + LEAST;
        CHECK_NEAR(direct[k], expected, rounding);
        counts->worst = fmax(counts->worst, fabs((double)direct[k] - expected) / rounding);
    }
}

// albedo/π · (1−E_d) · E, and emission, is FRAME_DIRECT.
static struct counts check_product(struct frame_fixture *s)
{
    float *direct = read_layer(s, FRAME_DIRECT), *albedo = read_layer(s, FRAME_ALBEDO);
    float *irradiance = read_layer(s, FRAME_DIRECT_IRRADIANCE);
    float *emissive = read_layer(s, FRAME_EMISSIVE);
    struct counts counts = { 0 };
    for (size_t i = 0; i < (size_t)s->width * s->height; i++)
        check_pixel(&counts, &direct[4 * i], &irradiance[4 * i], &albedo[4 * i], &emissive[4 * i]);
    printf("irradiance: %d lit, %d in shadow, %d others; within %.2f of the bound\n", counts.lit,
           counts.shadowed, counts.without, counts.worst);
    free(direct), free(albedo), free(irradiance), free(emissive);
    return counts;
}

static uint32_t undecided_pixels(struct frame_fixture *s)
{
    struct direct_list_header header = { 0 };
    CHECK(gpu_buffer_download(s->gpu, s->frame->common->direct.list, 0, &header, sizeof header));
    return header.count;
}

// The first frame makes the whole shadow test, the second has blocks and a list.
TEST_GPU(a_suns_irradiance_is_what_direct_light_reflects)
{
    struct frame_fixture s;
    begin(&s, gpu);
    add_sun(&s);
    fixture_open(&s);
    fixture_render(&s);
    CHECK(!s.frame->has_blocks);
    const struct counts whole = check_product(&s);
    CHECK(whole.lit > 500 && whole.shadowed > 300 && whole.without > 100);
    float *before = read_layer(&s, FRAME_DIRECT_IRRADIANCE);
    fixture_render(&s);
    CHECK(s.frame->has_blocks && undecided_pixels(&s) > 0);
    const struct counts blocks = check_product(&s);
    CHECK(blocks.lit == whole.lit && blocks.shadowed == whole.shadowed);
    float *after = read_layer(&s, FRAME_DIRECT_IRRADIANCE);
    CHECK(memcmp(before, after, sizeof(float) * 4 * SIZE * SIZE) == 0);
    free(before), free(after);
    fixture_finish(&s);
}

TEST_GPU(all_lights_and_filters_give_what_direct_light_reflects)
{
    for (int i = 0; i < 5; i++) {
        struct frame_fixture s;
        begin(&s, gpu);
        s.options.shadow_filter = i == 1 || i == 4 ? 2 : 0;
        if (i == 1 || i >= 3) add_sun(&s);
        if (i == 0 || i >= 3) add_locals(&s);
        if (i == 2)
            fixture_add_spot(&s, vec3_of(1, 2.5f, 1.5f), vec3_of(-0.4f, -1, -0.5f), 0.3f, 0.6f,
                             vec3_of(900, 600, 300));
        fixture_open(&s);
        fixture_render(&s);
        const struct counts counts = check_product(&s);
        CHECK(counts.lit > 200 && counts.without > 100);
        fixture_finish(&s);
    }
}

TEST_GPU(a_frame_without_lights_has_surfaces_without_irradiance)
{
    struct frame_fixture s;
    begin(&s, gpu);
    fixture_open(&s);
    fixture_render(&s);
    const struct counts counts = check_product(&s);
    CHECK(counts.lit == 0 && counts.shadowed > 1000 && counts.without > 100);
    fixture_finish(&s);
}

// Whatever the material: the cosine law.
TEST_GPU(irradiance_of_a_sun_on_a_plane_is_of_the_cosine)
{
    for (int i = 0; i < 3; i++) {
        struct frame_fixture s;
        fixture_init(&s, gpu);
        struct material m = material_default();
        m.metallic = i == 2 ? 1 : 0;
        m.roughness = i == 0 ? 1 : 0.3f;
        fixture_floor(&s, 20, fixture_material(&s, &m));
        fixture_look(&s, vec3_of(0, 2, 2), vec3_of(0, 0, 0));
        const vec3s to_sun = glms_vec3_normalize(vec3_of(0.4f, 1, -0.3f));
        fixture_add_sun(&s, glms_vec3_negate(to_sun), LUX);
        s.indirect.needs = FRAME_NEEDS_DIRECT_IRRADIANCE;
        fixture_open(&s);
        fixture_render(&s);
        float *irradiance = read_layer(&s, FRAME_DIRECT_IRRADIANCE);
        const double scale = (double)frame_radiance_scale(s.frame);
        const float *pixel = &irradiance[(size_t)4 * (20 * s.width + 12)];
        for (int k = 0; k < 3; k++)
            CHECK_RELATIVE((double)pixel[k] / scale, LUX.raw[k] * to_sun.y, ROUNDING);
        free(irradiance);
        fixture_finish(&s);
    }
}

static uint64_t frame_bytes(struct gpu *gpu)
{
    struct gpu_memory memory[16];
    const int count = gpu_memory_by_owner(gpu, memory, 16);
    for (int i = 0; i < count; i++)
        if (strcmp(memory[i].owner, "frame") == 0) return memory[i].bytes;
    return 0;
}

// The same frame without the need, with it, and without it again. The first one makes the whole
// shadow test, the others have blocks.
TEST_GPU(only_the_need_makes_the_layer)
{
    struct frame_fixture s;
    begin(&s, gpu);
    add_sun(&s);
    fixture_open(&s);
    float *color[3][2];
    uint64_t bytes[3];
    for (int i = 0; i < 3; i++) {
        s.indirect.needs = FRAME_NEEDS_MOTION | (i == 1 ? FRAME_NEEDS_DIRECT_IRRADIANCE : 0);
        for (int k = 0; k < 2; k++) {
            fixture_render(&s);
            color[i][k] = fixture_read(&s, READ_COLOR);
        }
        CHECK(has_layer(&s) == (i == 1));
        bytes[i] = frame_bytes(gpu);
    }
    CHECK(bytes[2] == bytes[0] && bytes[1] >= bytes[0] + SIZE * SIZE * 8);
    const size_t count = (size_t)SIZE * SIZE * 3;
    for (int k = 0; k < 2; k++) {
        CHECK(memcmp(color[0][k], color[2][k], count * sizeof(float)) == 0);
        for (size_t p = 0; p < count; p++)
            CHECK_RELATIVE(color[1][k][p], color[0][k][p], 2 * ROUNDING);
    }
    for (int i = 0; i < 6; i++) free(color[i / 2][i % 2]);
    fixture_finish(&s);
}

TEST_GPU(memory_estimate_has_the_layer)
{
    struct frame_fixture s;
    begin(&s, gpu);
    add_sun(&s);
    fixture_open(&s);
    fixture_resize(&s, 256, 128); // the software driver pads rows to 64 bytes: nothing here
    fixture_render(&s);
    const uint64_t without = frame_memory_estimate(&s.options, &s.input, 0, 256, 128);
    const uint64_t with = frame_memory_estimate(&s.options, &s.input, s.indirect.needs, 256, 128);
    CHECK(with == without + 256 * 128 * 8);
    CHECK_RELATIVE(frame_bytes(gpu), with, 0.01);
    CHECK(frame_view_memory_estimate(&s.options, &s.input, NULL, s.indirect.needs, 256, 128, 0) ==
          frame_view_memory_estimate(&s.options, &s.input, NULL, 0, 256, 128, 0) + 256 * 128 * 8);
    fixture_finish(&s);
}

TEST_GPU(the_layer_follows_the_size)
{
    struct frame_fixture s;
    begin(&s, gpu);
    add_sun(&s);
    fixture_open(&s);
    static const uint32_t sizes[][2] = { { 64, 64 }, { 1, 1 }, { 41, 23 }, { 90, 70 } };
    for (int i = 0; i < 4; i++) {
        fixture_resize(&s, sizes[i][0], sizes[i][1]);
        fixture_render(&s);
        const struct counts counts = check_product(&s);
        CHECK(counts.lit + counts.shadowed + counts.without == (int)(sizes[i][0] * sizes[i][1]));
    }
    fixture_finish(&s);
}

TEST_GPU(a_programs_gbuffer_gives_the_same_irradiance)
{
    struct frame_fixture s;
    begin(&s, gpu);
    add_sun(&s);
    fixture_open(&s);
    fixture_render(&s);
    float *own = read_layer(&s, FRAME_DIRECT_IRRADIANCE);
    struct frame_gbuffer gbuffer = { .emissive_scale = 1 };
    for (int l = FRAME_DEPTH; l <= FRAME_ALBEDO; l++)
        gbuffer.layers[l] = frame_layer_image(s.frame, (enum frame_layer)l);
    struct frame *first = s.frame;
    fixture_open_frame(&s);
    s.input.gbuffer = &gbuffer;
    for (int k = 0; k < 2; k++) {
        fixture_render(&s);
        float *given = read_layer(&s, FRAME_DIRECT_IRRADIANCE);
        CHECK(memcmp(own, given, sizeof(float) * 4 * SIZE * SIZE) == 0);
        free(given);
    }
    free(own);
    frame_destroy(s.frame);
    s.frame = first;
    fixture_finish(&s);
}

// ---- A source that replaces the diffuse reflection of direct light

struct replacing {
    gpu_pipeline pipeline;
    gpu_sampler nearest;
    float share;
};

static void record(void *user, struct gpu_cmd *cmd, const struct frame_view *view)
{
    const struct replacing *r = user;
    gpu_dispatch(cmd, r->pipeline,
                 GPU_BIND(view->constants_binding,
                          { "direct_irradiance", .image = view->layers[FRAME_DIRECT_IRRADIANCE],
                            .sampler = r->nearest },
                          { "irradiance", .image = view->layers[FRAME_IRRADIANCE] }),
                 &r->share, sizeof r->share, gpu_groups(view->width, 8),
                 gpu_groups(view->height, 8), 1);
}

static void begin_replacing(struct frame_fixture *s, struct replacing *r, struct gpu *gpu,
                            float share)
{
    begin(s, gpu);
    *r = (struct replacing){ .pipeline = test_gpu_compute(gpu, &shader_replace_direct_comp),
                             .share = share };
    struct gpu_sampler_desc nearest = {
        .name = "test.nearest", .wrap_u = GPU_CLAMP, .wrap_v = GPU_CLAMP, .wrap_w = GPU_CLAMP
    };
    assert_true(gpu_sampler_get(gpu, &nearest, &r->nearest));
    s->indirect = (struct frame_indirect){
        .record = record,
        .user = r,
        .needs = FRAME_NEEDS_DIRECT_IRRADIANCE | FRAME_WRITES_IRRADIANCE,
    };
    s->input.want_indirect_layer = s->input.want_display = true;
}

// Radiance is emission plus `share` of what direct light reflects diffusely, wherever it is lit.
static void check_replaced(struct frame_fixture *s, float share)
{
    float *direct = read_layer(s, FRAME_DIRECT), *color = read_layer(s, FRAME_COLOR);
    float *emissive = read_layer(s, FRAME_EMISSIVE), *albedo = read_layer(s, FRAME_ALBEDO);
    float *indirect = fixture_read(s, READ_INDIRECT);
    const double scale = (double)frame_radiance_scale(s->frame), factor = (double)share - 1;
    int negative = 0;
    double least = 0;
    for (size_t i = 0; i < (size_t)s->width * s->height * 4; i++) {
        if (i % 4 == 3) continue;
        const bool is_lit = albedo[i / 4 * 4 + 3] > 0.75f;
        const double all = (double)direct[i], most = fmax(1, fabs(factor)) * all;
        const double diffuse = is_lit ? all - (double)emissive[i] : 0;
        const double expected = all + factor * diffuse;
        const double read = (double)indirect[i / 4 * 3 + i % 4] * scale;
        CHECK_NEAR(color[i], expected, ROUNDING * 3 * most + 2 * LEAST);
        CHECK_NEAR(read, factor * diffuse, ROUNDING * 3 * most + 2 * LEAST);
        negative += read < 0;
        if (all > 0) least = fmin(least, (double)color[i] / all);
    }
    printf("share %.1f: %d values of indirect light negative, color at least %.5f of direct\n",
           (double)share, negative, least);
    CHECK((negative > 1000) == (share < 1) && least >= -1.01 * ROUNDING);
    free(direct), free(color), free(emissive), free(albedo), free(indirect);
}

TEST_GPU(a_source_replaces_the_diffuse_reflection_of_direct_light)
{
    static const float shares[] = { 0, 0.5f, 1, 3 };
    for (int i = 0; i < 4; i++) {
        for (int filter = 0; filter < 2; filter++) {
            struct frame_fixture s;
            struct replacing r;
            begin_replacing(&s, &r, gpu, shares[i]);
            s.scene->materials[0].base_color = (vec4s){ { 0.8f, 0.5f, 0.3f, 1 } };
            s.options.shadow_filter = filter;
            add_sun(&s);
            if (filter) add_locals(&s);
            fixture_open(&s);
            for (int k = 0; k < 2; k++) fixture_render(&s);
            check_replaced(&s, shares[i]);
            gpu_pipeline_destroy(gpu, &r.pipeline);
            fixture_finish(&s);
        }
    }
}

// All that is lit is half as bright: one EV less, and the same display image.
TEST_GPU(exposure_meters_the_radiance_that_remains)
{
    float ev[2];
    float *shown[2];
    for (int i = 0; i < 2; i++) {
        struct frame_fixture s;
        struct replacing r;
        begin_replacing(&s, &r, gpu, i ? 0.5f : 1);
        s.scene->instance_count = 7; // the floor and the first box, without emission
        s.input.environment.sky = vec3_of(0, 0, 0);
        s.input.auto_exposure = true;
        add_sun(&s);
        fixture_open(&s);
        fixture_render(&s);
        assert_true(frame_exposure(s.frame, &ev[i]));
        shown[i] = fixture_read(&s, READ_DISPLAY);
        gpu_pipeline_destroy(gpu, &r.pipeline);
        fixture_finish(&s);
    }
    CHECK_NEAR(ev[1], (double)ev[0] - 1, 0.002);
    for (size_t i = 0; i < (size_t)SIZE * SIZE * 3; i++) CHECK_NEAR(shown[0][i], shown[1][i], 0.01);
    free(shown[0]), free(shown[1]);
}

// ---- Views

// Renders a further view with the other camera, then the first one.
static void render_both(struct frame_fixture *s, struct frame *view,
                        const struct frame_input *of_view)
{
    assert_true(frame_prepare(s->frame, &s->input, &s->indirect));
    assert_true(frame_prepare(view, of_view, &s->indirect));
    struct gpu_cmd *cmd = gpu_frame_begin(s->gpu);
    assert_non_null(cmd);
    frame_record_light(s->frame, cmd, &s->input, &s->indirect);
    frame_record_view(view, cmd, of_view, &s->indirect);
    frame_record_view(s->frame, cmd, &s->input, &s->indirect);
    assert_true(gpu_frame_end(s->gpu, cmd));
    assert_true(gpu_wait(s->gpu));
}

// The layer of a further view that does not keep it shares memory with the first one's.
TEST_GPU(each_view_has_the_irradiance_of_its_own_pixels)
{
    for (int keep = 0; keep < 2; keep++) {
        struct frame_fixture s;
        struct replacing r;
        const uint32_t client = gpu_client_add(gpu);
        gpu_client_set(gpu, client);
        begin_replacing(&s, &r, gpu, 0);
        s.options.cascades = 1; // not fitted to the first camera
        add_sun(&s);
        fixture_open(&s);
        struct frame *view = frame_create_view(s.frame);
        assert_non_null(view);
        assert_true(frame_resize(view, SIZE, SIZE));
        struct frame_input of_view = s.input;
        of_view.camera = camera_look_at(vec3_of(-1.5f, 1.6f, 2.5f), vec3_of(0, 0.4f, 0), 1, 0.05f);
        of_view.keep_layers = keep;
        for (int k = 0; k < 2; k++) render_both(&s, view, &of_view);
        check_product(&s);
        check_replaced(&s, 0);
        float *color = calloc((size_t)SIZE * SIZE * 3, sizeof *color);
        assert_true(frame_read(view, READ_COLOR, color, 3));
        CHECK(frame_keeps_layer(view, FRAME_DIRECT_IRRADIANCE) == keep);
        frame_destroy(view);
        s.input.camera = of_view.camera; // alone
        fixture_render(&s);
        float *alone = fixture_read(&s, READ_COLOR);
        CHECK(memcmp(color, alone, sizeof(float) * 3 * SIZE * SIZE) == 0);
        free(color), free(alone);
        gpu_pipeline_destroy(gpu, &r.pipeline);
        fixture_finish(&s);
        gpu_client_set(gpu, 0);
        gpu_client_remove(gpu, client);
    }
}
