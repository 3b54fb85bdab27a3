// afterglow-import FILE CPU_SECONDS MEMORY_BYTES [stdin] [follow-links]. The library starts it;
// src/importer/importer.h says why. A signal ends it where a limit is reached, or where Assimp
// fails.
#include "importer/importer.h"
#include "importer/sandbox.h"

#include <assimp/postprocess.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

static void limit(int resource, unsigned long long value)
{
    struct rlimit limits = { (rlim_t)value, (rlim_t)value };
    if (setrlimit(resource, &limits) == 0) return;
    output_fail("unsupported", "the importer's limits cannot be set");
}

// No file is written, no process started, no memory dumped. Processor time ends the program by
// SIGXCPU; the wall clock, for one that waits, by SIGALRM.
static void set_limits(const char *cpu_seconds, const char *memory_bytes)
{
    enum { OPEN_FILES = 16, WALL_FACTOR = 8 };
    unsigned long long seconds = strtoull(cpu_seconds, NULL, 10);
    limit(RLIMIT_CPU, seconds);
    limit(RLIMIT_CORE, 0);
    limit(RLIMIT_FSIZE, 0);
    limit(RLIMIT_NOFILE, OPEN_FILES);
    alarm((unsigned)(WALL_FACTOR * seconds));
// Sanitizers reserve terabytes of addresses.
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
    limit(RLIMIT_AS, strtoull(memory_bytes, NULL, 10));
#else
    (void)memory_bytes;
#endif
}

// Sanitizers need calls of their own.
static void restrict_calls(void)
{
#ifdef IMPORTER_SANDBOX
    const char *why = sandbox_enter(output_descriptor());
    if (why) output_log("no seccomp filter: %s", why);
#endif
}

static const struct aiScene *read_scene(const char *path, const struct files_options *options)
{
    struct aiFileIO io = files_of(path, options);
    // v grows downwards in glTF. FBX files state their unit; GlobalScale converts it to metres.
    unsigned steps = aiProcess_Triangulate | aiProcess_SortByPType |
                     aiProcess_JoinIdenticalVertices | aiProcess_LimitBoneWeights |
                     aiProcess_ValidateDataStructure | aiProcess_FlipUVs;
    if (strcmp(files_extension(path), "fbx") == 0) steps |= aiProcess_GlobalScale;
    const struct aiScene *scene = aiImportFileEx(path, steps, &io);
    if (!scene || !scene->mRootNode) output_fail("format", "%s", aiGetErrorString());
    return scene;
}

static bool read_words(char **words, struct files_options *options)
{
    *options = (struct files_options){ 0 };
    for (; *words; words++) {
        bool *option = strcmp(*words, "stdin") == 0          ? &options->from_input
                       : strcmp(*words, "follow-links") == 0 ? &options->follow_links
                                                             : NULL;
        if (!option) return false;
        *option = true;
    }
    return true;
}

int main(int argc, char **argv)
{
    struct files_options options;
    if (argc < 4 || !read_words(argv + 4, &options)) {
        fprintf(stderr,
                "afterglow-import is started by libafterglow to read OBJ, FBX and X files\n");
        return 2;
    }
    output_open();
    set_limits(argv[2], argv[3]);
    struct importer importer = { .glb = glb_begin() }; // jansson reads its seed
    restrict_calls();
    importer.from = read_scene(argv[1], &options);
    if (importer.from->mNumLights > 0) output_note("lights of this format (no units)");
    if (importer.from->mNumCameras > 0) output_note("cameras of this format");
    import_materials(&importer);
    import_meshes(&importer);
    import_node_list(&importer);
    import_skins(&importer);
    import_animations(&importer);
    import_nodes(&importer);
    glb_write(&importer.glb);
}
