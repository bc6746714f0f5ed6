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

# kiln_kernels(NAME): NAME_scalar.c and, where the processor has them, one file an instruction set.
function(kiln_kernels name)
    set(options_scalar "-O3;$<$<C_COMPILER_ID:GNU>:-fno-tree-vectorize;-fno-tree-slp-vectorize>")
    set(options_sse2 "-O3;-msse2")
    set(options_avx2 "-O3;-mavx2")
    set(options_avx512
        "-O3;-mavx512f;-mavx512vl;-mavx512dq;-mavx512bw;-mprefer-vector-width=512")
    set(sets scalar)
    if(KILN_X86)
        list(APPEND sets sse2 avx2 avx512)
    endif()
    foreach(set ${sets})
        target_sources(kiln_objects PRIVATE ${name}_${set}.c)
        set_source_files_properties(${name}_${set}.c TARGET_DIRECTORY kiln_objects
                                    PROPERTIES COMPILE_OPTIONS "${options_${set}}")
    endforeach()
endfunction()
