# What makes a fault harder to exploit, where compiler and linker have it:
#   - the stack protector and landing pads of indirect jumps (CET on x86, BTI and signed return addresses on 64-bit
#     ARM) in all objects, and checked calls of the C library (FORTIFY) in those that are no kernels;
#   - relocations that are read-only from the start on (full RELRO), a stack that is not executable, and a command
#     at random addresses (PIE) for what is linked.
# kiln_fortify(TARGET) checks the calls of a library of objects; kiln_harden(TARGET) does this and adds the
# linker's part to a program or shared library.
include(CheckCCompilerFlag)
include(CheckLinkerFlag)

set(hardened_options "")
set(hardened_links "")
macro(kiln_add_option name flag)
    check_c_compiler_flag("-Werror ${flag}" KILN_HAS_${name})
    if(KILN_HAS_${name})
        list(APPEND hardened_options ${flag})
    endif()
endmacro()
macro(kiln_add_link name flag)
    check_linker_flag(C ${flag} KILN_LINKS_${name})
    if(KILN_LINKS_${name})
        list(APPEND hardened_links ${flag})
    endif()
endmacro()

if(NOT EMSCRIPTEN AND NOT WIN32) # the page has a machine of its own; mingw's stack protector needs a DLL more
    kiln_add_option(STACK_PROTECTOR -fstack-protector-strong)
    kiln_add_option(CLASH_PROTECTION -fstack-clash-protection)
    if(processor MATCHES "^(x86_64|amd64|i[3-6]86)$")
        kiln_add_option(CET -fcf-protection=full)
    elseif(processor MATCHES "^(aarch64|arm64)$")
        kiln_add_option(BTI -mbranch-protection=standard)
    endif()
    kiln_add_link(RELRO -Wl,-z,relro)
    kiln_add_link(NOW -Wl,-z,now)
    kiln_add_link(NOEXECSTACK -Wl,-z,noexecstack)
    # FORTIFY needs optimisation, and the sanitizers check the same calls themselves.
    if(NOT CMAKE_C_FLAGS MATCHES "sanitize|_FORTIFY_SOURCE")
        set(fortify 3)
        if(CMAKE_C_COMPILER_ID STREQUAL GNU AND CMAKE_C_COMPILER_VERSION VERSION_LESS 12)
            set(fortify 2)
        endif()
        set(fortify_options $<$<NOT:$<CONFIG:Debug>>:-U_FORTIFY_SOURCE>
            $<$<NOT:$<CONFIG:Debug>>:-D_FORTIFY_SOURCE=${fortify}>)
    endif()
endif()
target_compile_options(kiln_settings INTERFACE ${hardened_options})

include(CheckPIESupported)
check_pie_supported(LANGUAGES C)

# The kernels are left out of FORTIFY: the compiler would call memcpy for vectors in inner loops, which costs 9 %
# of a bake's instructions, and kernels read no files.
function(kiln_fortify target)
    target_compile_options(${target} PRIVATE ${fortify_options})
endfunction()

function(kiln_harden target)
    kiln_fortify(${target})
    target_link_options(${target} PRIVATE ${hardened_links})
    get_target_property(type ${target} TYPE)
    if(type STREQUAL EXECUTABLE AND NOT CMAKE_EXE_LINKER_FLAGS MATCHES "-static")
        set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE ON)
    endif()
endfunction()
