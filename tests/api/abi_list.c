// Prints the binary interface: the size of each struct, the offset, size and declaration of each
// member, the value of each constant, the declaration of each function. abi.sh compares it.
#include <afterglow/afterglow.h>
#include <afterglow/vulkan.h>

#include <stdio.h>

#define STRUCT(name) printf("struct %s %zu\n", #name, sizeof(struct name));
#define MEMBER(of, member, declaration)                                                            \
    printf("%s.%s %zu %zu %s\n", #of, #member, offsetof(struct of, member),                        \
           sizeof((struct of *)0)->member, declaration);
#define VALUE(constant)       printf("%s %d\n", #constant, (int)constant);
#define FUNCTION(declaration) printf("%s\n", declaration);

int main(void)
{
    if (sizeof(void *) != 8) return 77; // the list is that of 64-bit platforms
    printf("version %d.%d.%d\n", AG_VERSION_MAJOR, AG_VERSION_MINOR, AG_VERSION_PATCH);
#include "abi_rows.inc"
    return 0;
}
