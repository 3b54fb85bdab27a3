ag_test(techniques/common/kept USES techniques)
ag_test(techniques/common/sample_sets USES techniques LIBRARIES ag_samples)
