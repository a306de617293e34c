# Settings for all libraries and programs of retrace: language standard, warnings and sanitizers.

add_library(retrace_options INTERFACE)
target_compile_features(retrace_options INTERFACE cxx_std_20)
target_include_directories(retrace_options INTERFACE "${PROJECT_SOURCE_DIR}")
# Without errno and trapping, the optimiser may keep square roots in registers. Rounding and NaN conform to IEEE 754.
# Contraction is off so that results do not depend on whether the processor has fused multiply-add.
target_compile_options(retrace_options INTERFACE -fno-math-errno -fno-trapping-math -ffp-contract=off)
target_compile_options(retrace_options INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion
                                                 -Wnon-virtual-dtor -Woverloaded-virtual -Wcast-align)
# GCC 12 reports false warnings about overlapping memory in std::string (GCC bug 105651).
target_compile_options(retrace_options INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>)
# In a unity build, source files are included in another file. GCC then treats their anonymous namespaces like those of
# a header and warns.
if(CMAKE_UNITY_BUILD)
  target_compile_options(retrace_options INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
endif()
if(RETRACE_WARNINGS_AS_ERRORS)
  target_compile_options(retrace_options INTERFACE -Werror)
endif()
if(RETRACE_NATIVE)
  target_compile_options(retrace_options INTERFACE -march=native)
endif()
if(RETRACE_SANITIZE)
  target_compile_options(retrace_options INTERFACE -fsanitize=${RETRACE_SANITIZE} -fno-omit-frame-pointer)
  target_link_options(retrace_options INTERFACE -fsanitize=${RETRACE_SANITIZE})
  # With sanitizers, GCC reports false warnings about uninitialised values in std::regex (GCC bug 105616).
  target_compile_options(retrace_options INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
endif()

# retrace_library(NAME SOURCES ... [PUBLIC targets] [PRIVATE targets]) adds the static library retrace_NAME with the
# alias retrace::NAME.
function(retrace_library name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "SOURCES;PUBLIC;PRIVATE")
  add_library(retrace_${name} STATIC ${arg_SOURCES})
  add_library(retrace::${name} ALIAS retrace_${name})
  target_link_libraries(retrace_${name} PUBLIC retrace_options ${arg_PUBLIC} PRIVATE ${arg_PRIVATE})
endfunction()

# retrace_module(TARGET) configures a library that is loaded at run time from lib/retrace. This folder is next to the
# program's bin/, before and after installation.
function(retrace_module target)
  set_target_properties(${target} PROPERTIES PREFIX "" LIBRARY_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}/lib/retrace")
  install(TARGETS ${target} LIBRARY DESTINATION lib/retrace)
  set_property(GLOBAL APPEND PROPERTY RETRACE_MODULES ${target})
endfunction()

# retrace_needs_modules(TARGET) builds all modules together with a program. Libraries do not depend on the modules,
# because all other targets would then wait for them.
function(retrace_needs_modules target)
  get_property(modules GLOBAL PROPERTY RETRACE_MODULES)
  if(modules)
    add_dependencies(${target} ${modules})
  endif()
endfunction()
