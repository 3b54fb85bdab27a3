ag_technique_tests(ssr/reflections)
