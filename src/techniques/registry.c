// The array of all techniques.
#include "techniques/registry.h"

#include "techniques/ambient/ambient.h"
#include "techniques/dnrt/dnrt.h"
#include "techniques/gtao/gtao.h"
#include "techniques/hbao/hbao.h"
#include "techniques/lpv/lpv.h"
#include "techniques/mrt/mrt.h"
#include "techniques/none/none.h"
#include "techniques/ort/ort.h"
#include "techniques/prt/prt.h"
#include "techniques/radiosity/radiosity.h"
#include "techniques/ssao/ssao.h"
#include "techniques/ssr/ssr.h"
#include "techniques/vct/vct.h"
#include "techniques/vo/vo.h"

#include <string.h>

// The order is that of `afterglow list`.
const struct technique *const techniques[] = {
    // sources
    &technique_none, &technique_ambient, &technique_lpv, &technique_holpv, &technique_vct,
#if AG_BAKES
    &technique_mrt, &technique_drt, &technique_radiosity, &technique_ort, &technique_prt,
    // deltas
    &technique_dnrt,
#endif
    // visibility
    &technique_vo, &technique_ssao, &technique_hbao, &technique_gtao, &technique_vctao,
    // reflection
    &technique_ssr, NULL
};

const struct technique_debug_view *technique_find_view(const struct technique *technique,
                                                       const char *name)
{
    const size_t length = strlen(technique->name);
    if (strncmp(name, technique->name, length) == 0 && name[length] == '.') name += length + 1;
    const struct technique_debug_view *view = technique->debug_views;
    for (; view && view->name; view++)
        if (strcmp(view->name, name) == 0 || (view->old_name && strcmp(view->old_name, name) == 0))
            return view;
    return NULL;
}
