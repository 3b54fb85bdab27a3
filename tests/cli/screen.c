#include "cli/screen.h"
#include "cli/program.h"

#include <stdio.h>

const char *write_screen(const char *name, double x)
{
    static const char FORMAT[] =
        "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0,1]}],\"nodes\":["
        "{\"mesh\":0,\"scale\":[8,1,8]},"
        "{\"mesh\":0,\"translation\":[%g,0.5,0],\"rotation\":[0.70710678,0,0,0.70710678]}],"
        "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":1,\"material\":"
        "0}]}],"
        "\"materials\":[{\"doubleSided\":true,\"pbrMetallicRoughness\":{\"metallicFactor\":0}}],"
        "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\","
        "\"min\":[-0.5,0,-0.5],\"max\":[0.5,0,0.5]},"
        "{\"bufferView\":1,\"componentType\":5123,\"count\":6,\"type\":\"SCALAR\"}],"
        "\"bufferViews\":[{\"buffer\":0,\"byteLength\":48},"
        "{\"buffer\":0,\"byteOffset\":48,\"byteLength\":12}],"
        "\"buffers\":[{\"byteLength\":60,\"uri\":\"data:application/octet-stream;base64,"
        "AAAAvwAAAAAAAAC/AAAAvwAAAAAAAAA/AAAAPwAAAAAAAAA/AAAAPwAAAAAAAAC/AAABAAIAAAACAAMA\"}]}";
    static char text[2048];
    const int size = snprintf(text, sizeof text, FORMAT, x);
    write_file(path_of(name), text, (size_t)size);
    return path_of(name);
}
