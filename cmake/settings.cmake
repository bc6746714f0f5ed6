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
    # Enumerators are C17's integer constants here, with floats too, of which clang 18 and later warn.
    $<$<C_COMPILER_ID:Clang,AppleClang>:-Wno-enum-float-conversion>
    # The same bits everywhere: no fused multiply-add behind our back, no reordering.
    -ffp-contract=off -fno-math-errno -fno-trapping-math
    $<$<BOOL:${KILN_WERROR}>:-Werror>)

# Vector kernels are compiled once an instruction set: one of 128 bits that every processor of its kind has,
# and on 64-bit x86 those that a processor is asked for when a context is created.
string(TOLOWER "${CMAKE_SYSTEM_PROCESSOR}" processor)
set(kernel_sets scalar)
if(processor MATCHES "^(x86_64|amd64|i[3-6]86)$")
    set(options_simd128 -msse2)
    if(CMAKE_SIZEOF_VOID_P EQUAL 4) # the x87 would keep more bits than a double has
        target_compile_options(kiln_settings INTERFACE -msse2 -mfpmath=sse)
    elseif(NOT KILN_SCALAR)
        set(KILN_AVX ON)
    endif()
endif()
if(EMSCRIPTEN AND NOT KILN_SCALAR)
    set(options_simd128 -msimd128)
    target_compile_options(kiln_settings INTERFACE -msimd128)
endif()
if(NOT KILN_SCALAR AND (DEFINED options_simd128 OR processor MATCHES "^(aarch64|arm64)$"))
    list(APPEND kernel_sets simd128)
    target_compile_definitions(kiln_settings INTERFACE KILN_HAVE_SIMD128)
endif()
if(KILN_AVX)
    list(APPEND kernel_sets avx2 avx512)
    target_compile_definitions(kiln_settings INTERFACE KILN_HAVE_AVX)
endif()
# Scalar kernels stay scalar. Emscripten 3.1.6 (LLVM 15) vectorizes the kernel sum_degrees wrongly, as the golden hashes
# show.
set(options_scalar "$<$<C_COMPILER_ID:GNU>:-fno-tree-vectorize;-fno-tree-slp-vectorize>"
                   "$<$<C_COMPILER_ID:Clang>:-fno-vectorize;-fno-slp-vectorize>")
set(options_avx2 -mavx2)
set(options_avx512 -mavx512f -mavx512vl -mavx512dq -mavx512bw -mprefer-vector-width=512)
if(processor MATCHES "^(aarch64|arm64)$" AND CMAKE_C_COMPILER_ID STREQUAL GNU
   AND CMAKE_C_COMPILER_VERSION VERSION_GREATER_EQUAL 11)
    # GCC 12.2 leaves out the call of ki_huffman_assign: where two arrays of a structure are walked together,
    # their addresses become "constant - pointer", and the two passes that find out what a function modifies
    # no longer see that its argument is. The golden hashes of PNG and EXR files show the fault.
    target_compile_options(kiln_settings INTERFACE -fno-ipa-modref -fno-ipa-pure-const)
endif()
# GCC stores vectors of 32 and 64 bytes where a stack is aligned to less: on Windows' stacks, which are aligned to
# 16 bytes (GCC's bug 54412), and in the frames that AddressSanitizer allocates to find uses after a return, which
# are not aligned to 64 (LLVM's pull request 152819; that search is on by default since GCC 13). The assembler
# then writes moves that need no alignment.
if(CMAKE_C_COMPILER_ID STREQUAL GNU AND (MINGW OR CMAKE_C_FLAGS MATCHES "sanitize=[a-z,]*address"))
    list(APPEND options_avx2 -Wa,-muse-unaligned-vector-move)
    list(APPEND options_avx512 -Wa,-muse-unaligned-vector-move)
endif()
if(MINGW)
    # printf as C has it, and no word about the macro isfinite, which mixes float and double.
    target_compile_definitions(kiln_settings INTERFACE __USE_MINGW_ANSI_STDIO=1)
    target_compile_options(kiln_settings INTERFACE -Wno-float-conversion)
endif()

# kiln_kernels(NAME): NAME_scalar.c and one file an instruction set.
function(kiln_kernels name)
    foreach(set ${kernel_sets})
        target_sources(kiln_kernels_${set} PRIVATE ${name}_${set}.c)
    endforeach()
endfunction()
