// Import of OBJ, PLY, X and FBX files.
#include "scene/gltf_maker.h"

#include "scene/pose.h"

#include <math.h>

static struct scene *load_text(const char *name, const char *text)
{
    write_bytes(name, text, strlen(text));
    test_forget_messages();
    return scene_load(test_host(), test_path(name));
}

static const char cube_corner[] = "mtllib made.mtl\n"
                                  "v 0 0 0\nv 2 0 0\nv 2 3 0\nv 0 3 0\n"
                                  "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
                                  "usemtl red\n"
                                  "f 1/1 2/2 3/3 4/4\n";

TEST(obj_faces_become_triangles_with_their_material)
{
    const char mtl[] = "newmtl red\nKd 0.8 0.1 0.2\nKe 0 3 0\n";
    write_bytes("made.mtl", mtl, sizeof mtl - 1);
    struct scene *scene = load_text("made.obj", cube_corner);
    CHECK(scene);
    CHECK_STRING(test_last_message(), "");
    CHECK(scene_triangle_count(scene) == 2 && scene->instance_count == 1);
    const struct mesh *mesh = &scene->meshes[0];
    const struct material *material = &scene->materials[mesh->material];
    CHECK_NEAR(material->base_color.x, 0.8, 1e-6);
    CHECK_NEAR(material->emissive.y, 3.0, 1e-6);
    CHECK_NEAR(mesh->bounds.max.y, 3.0, 1e-6);
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        CHECK_NEAR(mesh->normals[v].z, 1.0, 1e-6);
        // v grows downwards: the bottom vertex has v = 1.
        CHECK_NEAR(mesh->uv[0][v].y, 1.0 - (double)(mesh->positions[v].y / 3.0f), 1e-6);
    }
    scene_destroy(scene);
}

// docs/materials.md: Ks 0 and illum 0 or 1 are purely diffuse, else F0 = 0.08 Ks.
TEST(phong_materials_of_obj_map_to_a_dielectric)
{
    static const struct {
        const char *text;
        double weight, f0, roughness;
    } of[] = {
        { "Ks 0 0 0\nillum 2\nNs 14\n", 0, 0, 0.5946 }, // α = √(2/16)
        { "Ks 0.5 0.5 0.5\nillum 1\n", 0, 0.04, 1 },
        { "Ks 0.5 0.5 0.5\nillum 0\n", 0, 0.04, 1 },
        { "Ks 0.5 0.5 0.5\nillum 2\nNs 198\n", 1, 0.04, 0.3162 }, // α = 0.1
        { "Ks 1 1 1\nillum 2\n", 1, 0.08, 1 },
    };
    for (int i = 0; i < 5; i++) {
        char mtl[128];
        const int length = snprintf(mtl, sizeof mtl, "newmtl red\nKd 0.8 0.1 0.2\n%s", of[i].text);
        write_bytes("made.mtl", mtl, (size_t)length);
        struct scene *scene = load_text("made.obj", cube_corner);
        CHECK(scene);
        const struct material *m = &scene->materials[scene->meshes[0].material];
        CHECK_NEAR(m->specular, of[i].weight, 0);
        CHECK_NEAR(material_specular_f0(m).y, of[i].f0, 1e-6);
        CHECK_NEAR(m->roughness, of[i].roughness, 1e-3);
        scene_destroy(scene);
    }
}

TEST(an_obj_without_its_materials_still_loads)
{
    remove(test_path("made.mtl"));
    struct scene *scene = load_text("made.obj", cube_corner);
    CHECK(scene && scene_triangle_count(scene) == 2);
    scene_destroy(scene);
}

TEST(a_missing_texture_is_noted_and_ignored)
{
    const char mtl[] = "newmtl red\nmap_Kd nowhere.png\n";
    write_bytes("made.mtl", mtl, sizeof mtl - 1);
    struct scene *scene = load_text("made.obj", cube_corner);
    CHECK(scene && scene->image_count == 0);
    CHECK(strstr(test_last_message(), "nowhere.png"));
    CHECK(scene->materials[scene->meshes[0].material].base_color_map.image == -1);
    scene_destroy(scene);
}

TEST(files_outside_the_folder_of_an_obj_are_not_read)
{
    const char mtl[] = "newmtl red\nmap_Kd ../../../etc/hostname\n";
    write_bytes("made.mtl", mtl, sizeof mtl - 1);
    struct scene *scene = load_text("made.obj", cube_corner);
    CHECK(scene && strstr(test_last_message(), "not in the file's folder"));
    scene_destroy(scene);
}

static const char ply[] = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
                          "property float y\nproperty float z\nproperty uchar red\n"
                          "property uchar green\nproperty uchar blue\nelement face 1\n"
                          "property list uchar int vertex_indices\nend_header\n"
                          "0 0 0 255 0 0\n1 0 0 255 0 0\n0 1 0 188 0 0\n3 0 1 2\n";

TEST(ply_colours_are_read_as_srgb)
{
    struct scene *scene = load_text("made.ply", ply);
    CHECK(scene && scene_triangle_count(scene) == 1 && scene->meshes[0].colors);
    for (uint32_t v = 0; v < 3; v++) {
        bool top = scene->meshes[0].positions[v].y > 0.5f;
        CHECK_NEAR(scene->meshes[0].colors[v].x, top ? 0.5 : 1.0, 5e-3);
    }
    scene_destroy(scene);
}

// A triangle's vertices, and one face with this list of corners.
static struct scene *load_face(const char *corners)
{
    char text[1024];
    int header = (int)(strstr(ply, "3 0 1 2") - ply);
    snprintf(text, sizeof text, "%.*s%s\n", header, ply, corners);
    write_bytes("face.ply", text, strlen(text));
    return scene_load(test_host(), test_path("face.ply"));
}

TEST(a_face_of_a_ply_has_at_most_two_corners_per_vertex)
{
    struct scene *six = load_face("6 0 1 2 0 1 2");
    CHECK(six);
    scene_destroy(six);
    CHECK(!load_face("7 0 1 2 0 1 2 0"));
    CHECK(strstr(test_last_message(), "corners"));
}

TEST(faces_of_a_ply_may_come_in_several_elements)
{
    static char text[200000] =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
        "property float z\nelement face 1000\nproperty list uchar int vertex_indices\n"
        "element face 1000\nproperty list uchar int vertex_indices\nend_header\n"
        "0 0 0\n1 0 0\n0 1 0\n";
    char *end = text + strlen(text);
    for (int i = 0; i < 2000; i++) end = stpcpy(end, "3 0 1 2\n");
    struct scene *scene = load_text("faces.ply", text);
    if (!scene) fail_msg("%s", test_last_message());
    CHECK(scene_triangle_count(scene) == 2000);
    for (uint32_t i = 0; i < 6000; i++) CHECK(scene->meshes[0].indices[i] < 6000);
    scene_destroy(scene);
}

static const char x_file[] = "xof 0303txt 0032\n"
                             "Frame Arm {\n"
                             " FrameTransformMatrix {\n"
                             "  1.0,0.0,0.0,0.0,\n"
                             "  0.0,1.0,0.0,0.0,\n"
                             "  0.0,0.0,1.0,0.0,\n"
                             "  5.0,0.0,0.0,1.0;;\n"
                             " }\n"
                             " Mesh Plate {\n"
                             "  3;\n"
                             "  0.0;0.0;0.0;,\n"
                             "  0.0;1.0;0.0;,\n"
                             "  1.0;0.0;0.0;;\n"
                             "  1;\n"
                             "  3;0,1,2;;\n"
                             " }\n"
                             "}\n"
                             "AnimTicksPerSecond {\n"
                             " 10;\n"
                             "}\n"
                             "AnimationSet Wave {\n"
                             " Animation {\n"
                             "  {Arm}\n"
                             "  AnimationKey {\n"
                             "   2;\n"
                             "   2;\n"
                             "   0;3;5.0,0.0,0.0;;,\n"
                             "   20;3;7.0,0.0,0.0;;;\n"
                             "  }\n"
                             " }\n"
                             "}\n";

TEST(x_frames_and_their_animation_are_read)
{
    struct scene *scene = load_text("made.x", x_file);
    if (!scene) fail_msg("%s", test_last_message());
    CHECK(scene_triangle_count(scene) == 1 && scene->animation_count == 1);
    CHECK_NEAR(scene->animations[0].duration_s, 2.0, 1e-6);
    struct scene_pose pose;
    CHECK(pose_init(&pose, scene, 0, 1.0f));
    CHECK_NEAR(pose.bounds.min.x, 6.0, 1e-5);
    pose_finish(&pose);
    scene_destroy(scene);
}

// Assimp's reader recurses into blocks until the stack ends.
TEST(blocks_nested_without_end_are_refused)
{
    enum { BLOCKS = 200000 };
    static char text[BLOCKS * 10 + 64] = "xof 0303txt 0032\n";
    char *end = text + strlen(text);
    for (int i = 0; i < BLOCKS; i++) end = stpcpy(end, "Frame a {\n");
    CHECK(!load_text("deep.x", text));
    CHECK(test_host()->failure == FAIL_FORMAT && strstr(test_last_message(), "importer failed"));
}

static const char fbx[] =
    "; FBX 7.4.0 project file\nFBXHeaderExtension:  {\n FBXHeaderVersion: 1003\n"
    " FBXVersion: 7400\n}\nGlobalSettings:  {\n Version: 1000\n Properties70:  {\n"
    "  P: \"UpAxis\", \"int\", \"Integer\", \"\",1\n"
    "  P: \"UnitScaleFactor\", \"double\", \"Number\", \"\",1\n }\n}\n"
    "Objects:  {\n Geometry: 1, \"Geometry::g\", \"Mesh\" {\n  Vertices: *9 {\n"
    "   a: 0,0,0,100,0,0,0,200,0\n  }\n  PolygonVertexIndex: *3 {\n   a: 0,1,-3\n  }\n }\n"
    " Model: 2, \"Model::m\", \"Mesh\" {\n  Version: 232\n }\n}\n"
    "Connections:  {\n C: \"OO\",2,0\n C: \"OO\",1,2\n}\n";

TEST(fbx_centimetres_become_metres)
{
    struct scene *scene = load_text("made.fbx", fbx);
    if (!scene) fail_msg("%s", test_last_message());
    CHECK(scene_triangle_count(scene) == 1);
    struct scene_pose pose;
    CHECK(pose_init(&pose, scene, -1, 0.0f));
    CHECK_NEAR(box3_size(pose.bounds).x, 1.0, 1e-5);
    CHECK_NEAR(box3_size(pose.bounds).y, 2.0, 1e-5);
    pose_finish(&pose);
    scene_destroy(scene);
}

static void *counting_reallocate(void *user, void *old, size_t bytes)
{
    int *blocks = user;
    *blocks += (bytes != 0 && !old) - (bytes == 0 && old);
    if (bytes > 0) return realloc(old, bytes);
    free(old);
    return NULL;
}

// `stride`: the importer program starts for each length of the file.
static void check_truncations(const char *name, const void *bytes, size_t size, size_t stride)
{
    int blocks = 0;
    struct host host = host_default();
    host.reallocate = counting_reallocate;
    host.user = &blocks;
    host.importer = test_importer();
    for (size_t cut = 0; cut <= size; cut += stride) {
        write_bytes(name, bytes, cut);
        host.failure = FAIL_NONE;
        struct scene *scene = scene_load(&host, test_path(name));
        CHECK(scene || host.failure != FAIL_NONE);
        scene_destroy(scene);
        CHECK(blocks == 0);
    }
}

TEST(an_obj_truncated_at_any_length_is_read_or_refused)
{
    check_truncations("cut.obj", cube_corner, strlen(cube_corner), 5);
}

TEST(a_ply_truncated_at_any_length_is_read_or_refused)
{
    check_truncations("cut.ply", ply, strlen(ply), 1);
}

TEST(an_x_file_truncated_at_any_length_is_read_or_refused)
{
    check_truncations("cut.x", x_file, strlen(x_file), 13);
}

TEST(an_fbx_truncated_at_any_length_is_read_or_refused)
{
    check_truncations("cut.fbx", fbx, strlen(fbx), 17);
}

// --- Binary FBX, version 7400: records of end offset, property count, property bytes, name,
// properties, nested records and a null record after those.
struct fbx_writer {
    uint8_t bytes[4096];
    size_t size;
};

static void put(struct fbx_writer *w, const void *data, size_t size)
{
    CHECK(w->size + size <= sizeof w->bytes);
    memcpy(w->bytes + w->size, data, size);
    w->size += size;
}

static void put_u32(struct fbx_writer *w, size_t value)
{
    uint32_t u32 = (uint32_t)value;
    put(w, &u32, 4);
}

// `types` has one letter per argument: "I" and "L" integers of 32 and 64 bits, "S" a string, "d"
// and "i" arrays.
static size_t begin_record(struct fbx_writer *w, const char *name, const char *types, ...)
{
    size_t start = w->size, name_size = strlen(name);
    put_u32(w, 0);
    put_u32(w, strlen(types));
    put_u32(w, 0);
    uint8_t length = (uint8_t)name_size;
    put(w, &length, 1);
    put(w, name, name_size);
    size_t properties = w->size;
    va_list arguments;
    va_start(arguments, types);
    for (const char *t = types; *t; t++) {
        put(w, t, 1);
        if (*t == 'L') {
            int64_t value = va_arg(arguments, int);
            put(w, &value, 8);
        } else if (*t == 'I') {
            put_u32(w, (size_t)va_arg(arguments, int));
        } else if (*t == 'S') {
            const char *text = va_arg(arguments, const char *);
            put_u32(w, strlen(text));
            put(w, text, strlen(text));
        } else {
            size_t element = *t == 'd' ? 8 : 4;
            const void *array = va_arg(arguments, const void *);
            size_t count = (size_t)va_arg(arguments, int);
            put_u32(w, count);
            put_u32(w, 0); // not compressed
            put_u32(w, count * element);
            put(w, array, count * element);
        }
    }
    va_end(arguments);
    uint32_t property_bytes = (uint32_t)(w->size - properties);
    memcpy(w->bytes + start + 8, &property_bytes, 4);
    return start;
}

static void end_record(struct fbx_writer *w, size_t start, bool nested)
{
    static const uint8_t null_record[13];
    if (nested) put(w, null_record, sizeof null_record);
    uint32_t end = (uint32_t)w->size;
    memcpy(w->bytes + start, &end, 4);
}

static struct fbx_writer binary_fbx(void)
{
    static const double vertices[9] = { 0, 0, 0, 100, 0, 0, 0, 200, 0 };
    static const int32_t corners[3] = { 0, 1, -3 };
    static const uint8_t header[27] = "Kaydara FBX Binary  \0\x1a\0\xe8\x1c";
    struct fbx_writer w = { .size = 0 };
    put(&w, header, sizeof header);
    size_t outer = begin_record(&w, "FBXHeaderExtension", "");
    end_record(&w, begin_record(&w, "FBXVersion", "I", 7400), false);
    end_record(&w, outer, true);
    outer = begin_record(&w, "Objects", "");
    size_t inner = begin_record(&w, "Geometry", "LSS", 1, "Geometry::g", "Mesh");
    end_record(&w, begin_record(&w, "Vertices", "d", vertices, 9), false);
    end_record(&w, begin_record(&w, "PolygonVertexIndex", "i", corners, 3), false);
    end_record(&w, inner, true);
    inner = begin_record(&w, "Model", "LSS", 2, "Model::m", "Mesh");
    end_record(&w, begin_record(&w, "Version", "I", 232), false);
    end_record(&w, inner, true);
    end_record(&w, outer, true);
    outer = begin_record(&w, "Connections", "");
    end_record(&w, begin_record(&w, "C", "SLL", "OO", 2, 0), false);
    end_record(&w, begin_record(&w, "C", "SLL", "OO", 1, 2), false);
    end_record(&w, outer, true);
    static const uint8_t null_record[13];
    put(&w, null_record, sizeof null_record);
    return w;
}

TEST(a_binary_fbx_is_read)
{
    struct fbx_writer w = binary_fbx();
    write_bytes("binary.fbx", w.bytes, w.size);
    struct scene *scene = scene_load(test_host(), test_path("binary.fbx"));
    if (!scene) fail_msg("%s", test_last_message());
    CHECK(scene_triangle_count(scene) == 1);
    scene_destroy(scene);
}

TEST(a_binary_fbx_truncated_at_any_length_is_read_or_refused)
{
    struct fbx_writer w = binary_fbx();
    check_truncations("cut.fbx", w.bytes, w.size, 17);
}

TEST(a_binary_fbx_with_huge_arrays_or_invalid_ends_is_refused)
{
    struct fbx_writer w = binary_fbx();
    const uint8_t *vertices = memmem(w.bytes, w.size, "Verticesd", 9);
    CHECK(vertices);
    uint32_t count = 4000000000u;
    size_t at = (size_t)(vertices - w.bytes) + 9;
    memcpy(w.bytes + at, &count, 4);
    write_bytes("huge.fbx", w.bytes, w.size);
    CHECK(!scene_load(test_host(), test_path("huge.fbx")));
    w = binary_fbx();
    memcpy(w.bytes + 27, &count, 4); // the first record ends beyond the file
    write_bytes("end.fbx", w.bytes, w.size);
    CHECK(!scene_load(test_host(), test_path("end.fbx")));
}

TEST(unknown_file_extensions_are_refused)
{
    CHECK(!load_text("made.blend", "anything"));
    CHECK(strstr(test_last_message(), "unknown kind"));
}
