ag_test(core/sh USES core)
