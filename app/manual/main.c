// afterglow-manual: prints the manual page; run by the build.
#include "manual_page.h"

#include <stdio.h>

int main(void)
{
    print_manual_page();
    return fflush(stdout) != 0;
}
