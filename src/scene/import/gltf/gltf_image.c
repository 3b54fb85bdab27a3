// The place of the encoded bytes of an image (glTF 2.0, section 3.8.2).
#include "scene/import/gltf/gltf.h"

#include "scene/import/import_files.h"
#include "scene/import/import_image.h"

#include <string.h>

static bool has_extension(const char *name, const char *wanted)
{
    char extension[16] = "";
    if (name) file_extension(name, extension);
    return strcmp(extension, wanted) == 0;
}

// The image file of a uri. Files of other formats often name images that are not there.
static bool find_image_file(struct gltf *gltf, const char *uri, struct import_files *files,
                            struct image_source *source)
{
    struct import *import = gltf->import;
    char *path =
        import->converted ? import_resolve_quietly(import, uri, true) : import_resolve(import, uri);
    const struct import_text name = import_printable(source->name);
    if (!path && import->converted)
        import_note(import, "image %s (not in the file's folder)", name.s);
    if (!path) return import->converted;
    const struct import_file *file = import_files_read(files, path);
    if (!file) return false;
    if (file->missing) import_note(import, "image %s (no such file)", name.s);
    source->data = file->bytes.data;
    source->size = file->bytes.size;
    return true;
}

bool gltf_find_image(struct gltf *gltf, size_t i, struct import_files *files,
                     struct image_source *source, void **owned)
{
    struct import *import = gltf->import;
    struct gltf_object object = gltf_element(gltf, gltf->images, "image", i);
    const char *uri = gltf_string(object, "uri"), *name = gltf_string(object, "name");
    int view_index = gltf_index(object, "bufferView", gltf->views);
    bool is_data = uri && strncmp(uri, "data:", 5) == 0;
    source->jpeg_and_png_only = !import->converted;
    source->is_tga = import->converted && has_extension(name, "tga");
    source->name = import_name(import, !name && !is_data ? uri : name, "image", i);
    if (gltf->failed || !source->name) return false;
    if (view_index >= 0) {
        struct gltf_view view;
        if (!gltf_view(gltf, view_index, &view)) return false;
        source->data = view.data;
        source->size = view.size;
        return true;
    }
    if (!uri) return gltf_wrong(object, "has neither uri nor bufferView");
    if (!is_data) return find_image_file(gltf, uri, files, source);
    source->data = *owned = gltf_data_uri(object, uri, &source->size);
    return source->data != NULL;
}
