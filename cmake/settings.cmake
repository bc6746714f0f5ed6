# Language, warnings and floating point, once for everything in the project.
set(CMAKE_C_STANDARD 17)
set(CMAKE_C_STANDARD_REQUIRED ON)
set(CMAKE_C_EXTENSIONS OFF)
set(CMAKE_C_VISIBILITY_PRESET hidden)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
    set(CMAKE_BUILD_TYPE Release)
endif()
if(PROJECT_IS_TOP_LEVEL)
    set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)
endif()

add_library(kiln_settings INTERFACE)
target_compile_options(kiln_settings INTERFACE
    -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wdouble-promotion -Wstrict-prototypes
    -Wmissing-prototypes -Wundef -Wvla
    # The same bits everywhere: no fused multiply-add behind our back, no reordering.
    -ffp-contract=off -fno-math-errno -fno-trapping-math
    $<$<BOOL:${KILN_WERROR}>:-Werror>)

# Vector kernels are compiled once an instruction set.
string(TOLOWER "${CMAKE_SYSTEM_PROCESSOR}" processor)
set(KILN_X86 OFF)
if(NOT KILN_SCALAR AND processor MATCHES "^(x86_64|amd64)$")
    set(KILN_X86 ON)
    target_compile_definitions(kiln_settings INTERFACE KILN_HAVE_X86)
endif()
set(KILN_SIMD128 OFF)
if(NOT KILN_SCALAR AND EMSCRIPTEN)
    set(KILN_SIMD128 ON)
    target_compile_definitions(kiln_settings INTERFACE KILN_HAVE_SIMD128)
    target_compile_options(kiln_settings INTERFACE -msimd128)
endif()
