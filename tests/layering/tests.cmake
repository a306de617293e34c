retrace_test(layering_test SOURCES layering/layering_test.cpp layering/layer_rules.cpp)
