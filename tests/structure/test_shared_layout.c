// C and GLSL agree on shared structs: in every block of every shader, the structs of *_shared.h
// headers have the members, offsets and sizes of C. A generated shader has a block of each struct.
#include "framework/test.h"

#include "core/files/file.h"

#include <spirv_cross_c.h>

#include <stdlib.h>
#include <string.h>

struct member {
    const char *name;
    size_t offset, size;
};

struct shared {
    const char *name;
    size_t size;
    const struct member *members;
    size_t count;
};

#include "shared_structs.inc" // written by shared_structs.awk from the headers

enum { STRUCTS = sizeof shared_structs / sizeof *shared_structs };

static int seen[STRUCTS]; // blocks that a struct was found in

struct shader {
    const char *path;
    spvc_compiler compiler;
};

// A struct may be "…_data" in GLSL, where a block has its name.
static const struct shared *find(const char *name)
{
    for (int i = 0; i < STRUCTS; i++) {
        size_t length = strlen(shared_structs[i].name);
        const char *rest = name + length;
        if (strncmp(name, shared_structs[i].name, length)) continue;
        if (*rest && strcmp(rest, "_data")) continue;
        seen[i]++;
        return &shared_structs[i];
    }
    return NULL;
}

static void check_equal(const struct shader *s, const struct shared *c, const char *what,
                        size_t glsl, size_t in_c)
{
    if (glsl == in_c) return;
    fail_msg("%s: struct %s: %s: %zu in GLSL, %zu in C", s->path, c->name, what, glsl, in_c);
}

static void check_struct(const struct shader *s, spvc_type type, const struct shared *c)
{
    spvc_type_id id = spvc_type_get_base_type_id(type);
    check_equal(s, c, "number of members", spvc_type_get_num_member_types(type), c->count);
    for (unsigned i = 0; i < c->count; i++) {
        unsigned offset = 0;
        size_t size = 0;
        const char *name = spvc_compiler_get_member_name(s->compiler, id, i);
        CHECK_STRING(name, c->members[i].name);
        CHECK(!spvc_compiler_type_struct_member_offset(s->compiler, type, i, &offset));
        CHECK(!spvc_compiler_get_declared_struct_member_size(s->compiler, type, i, &size));
        check_equal(s, c, name, offset, c->members[i].offset);
        check_equal(s, c, name, size, c->members[i].size);
    }
    size_t size = 0;
    CHECK(!spvc_compiler_get_declared_struct_size(s->compiler, type, &size));
    check_equal(s, c, "size", size, c->size);
}

// The structs in a block, recursively.
static void check_members(const struct shader *s, spvc_type block)
{
    for (unsigned i = 0; i < spvc_type_get_num_member_types(block); i++) {
        spvc_type type =
            spvc_compiler_get_type_handle(s->compiler, spvc_type_get_member_type(block, i));
        if (spvc_type_get_basetype(type) != SPVC_BASETYPE_STRUCT) continue;
        spvc_type_id id = spvc_type_get_base_type_id(type);
        const struct shared *c = find(spvc_compiler_get_name(s->compiler, id));
        if (c) check_struct(s, type, c);
        if (c && spvc_type_get_num_array_dimensions(type) > 0) {
            unsigned stride = 0;
            CHECK(!spvc_compiler_type_struct_member_array_stride(s->compiler, block, i, &stride));
            check_equal(s, c, "stride", stride, c->size);
        }
        check_members(s, type);
    }
}

static void check_blocks(const struct shader *s)
{
    static const spvc_resource_type kinds[] = { SPVC_RESOURCE_TYPE_UNIFORM_BUFFER,
                                                SPVC_RESOURCE_TYPE_STORAGE_BUFFER,
                                                SPVC_RESOURCE_TYPE_PUSH_CONSTANT };
    spvc_resources resources;
    CHECK(!spvc_compiler_create_shader_resources(s->compiler, &resources));
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
        const spvc_reflected_resource *list;
        size_t count;
        CHECK(!spvc_resources_get_resource_list_for_type(resources, kinds[k], &list, &count));
        for (size_t i = 0; i < count; i++)
            check_members(s, spvc_compiler_get_type_handle(s->compiler, list[i].base_type_id));
    }
}

static void check_shader(const char *path)
{
    struct shader s = { .path = path };
    struct file_bytes bytes;
    CHECK(file_read(test_host(), path, 0, &bytes));
    spvc_context context;
    spvc_parsed_ir ir;
    CHECK(!spvc_context_create(&context));
    CHECK(!spvc_context_parse_spirv(context, (const SpvId *)(const void *)bytes.data,
                                    bytes.size / sizeof(SpvId), &ir));
    CHECK(!spvc_context_create_compiler(context, SPVC_BACKEND_NONE, ir,
                                        SPVC_CAPTURE_MODE_TAKE_OWNERSHIP, &s.compiler));
    check_blocks(&s);
    spvc_context_destroy(context);
    file_bytes_finish(test_host(), &bytes);
}

TEST(c_and_glsl_agree_about_every_shared_struct)
{
    static const char *const shaders[] = {
#include "shared_shaders.inc" // the paths of the .spv files, written by tests.cmake
    };
    for (size_t i = 0; i < sizeof shaders / sizeof *shaders; i++) check_shader(shaders[i]);
    for (int i = 0; i < STRUCTS; i++) {
        if (!seen[i]) fail_msg("struct %s: no shader has it in a block", shared_structs[i].name);
    }
}
