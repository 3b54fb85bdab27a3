# Warnings and sanitizers for the project's own code. Third-party headers are system headers.
set(AFTERGLOW_C_WARNINGS
  -Wall -Wextra -Wpedantic -Wshadow -Wstrict-prototypes -Wmissing-prototypes -Wundef -Wvla
  -Wdouble-promotion -Wpointer-arith -Wimplicit-fallthrough -Wconversion -Wno-sign-conversion)

add_library(afterglow_flags INTERFACE)
target_compile_options(afterglow_flags INTERFACE
  $<$<COMPILE_LANGUAGE:C>:${AFTERGLOW_C_WARNINGS}> -fno-math-errno -ffp-contract=off)
target_compile_definitions(afterglow_flags INTERFACE _GNU_SOURCE)
if(AFTERGLOW_SANITIZE)
  target_compile_options(afterglow_flags INTERFACE -fsanitize=${AFTERGLOW_SANITIZE} -fno-omit-frame-pointer)
  target_link_options(afterglow_flags INTERFACE -fsanitize=${AFTERGLOW_SANITIZE})
endif()
