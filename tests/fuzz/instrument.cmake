# Instruments all that is compiled after it for libFuzzer and the sanitizers.
if(NOT CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
    message(FATAL_ERROR "PENUMBRA_FUZZ needs clang; use the preset `fuzz`")
endif()
# A number that does not fit its new type is a finding too, though it is not in `undefined`.
set(fuzz_checks address,undefined,float-cast-overflow)
add_compile_options(-fsanitize=fuzzer-no-link,${fuzz_checks} -fno-sanitize-recover=all
    -fno-omit-frame-pointer)
add_link_options(-fsanitize=${fuzz_checks})
