#include "framework/drivers.h"

#ifdef __has_feature
#if __has_feature(address_sanitizer)
#define ADDRESS_SANITIZER
#endif
#endif
#ifdef __SANITIZE_ADDRESS__
#define ADDRESS_SANITIZER
#endif

#ifdef ADDRESS_SANITIZER
#include <dlfcn.h>
#include <link.h>
#include <sanitizer/lsan_interface.h>

static int pin(struct dl_phdr_info *info, size_t size, void *user)
{
    (void)size;
    (void)user;
    if (info->dlpi_name[0]) (void)dlopen(info->dlpi_name, RTLD_NOW | RTLD_NOLOAD | RTLD_NODELETE);
    return 0;
}

bool drivers_are_checked(void)
{
    return true;
}

void drivers_load_begin(void)
{
    __lsan_disable();
}

void drivers_load_end(void)
{
    dl_iterate_phdr(pin, NULL);
    __lsan_enable();
}
#else
bool drivers_are_checked(void)
{
    return false;
}

void drivers_load_begin(void)
{
}

void drivers_load_end(void)
{
}
#endif
