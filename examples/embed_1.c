// Step 1 of docs/embed.md: a program that links with the library.
#include <afterglow/afterglow.h>

#include <stdio.h>

int main(void)
{
    struct ag_context *context = NULL;
    if (ag_context_create(NULL, &context) != AG_OK) return 1;
    printf("afterglow %d.%d\n", ag_version() / 10000, ag_version() / 100 % 100);
    ag_context_destroy(context);
    return 0;
}
