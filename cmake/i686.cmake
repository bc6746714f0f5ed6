# Linux on 32-bit x86 by Debian's cross compiler (gcc-i686-linux-gnu). Programs are linked statically, since
# its C library is not where programs look for it. Most 64-bit kernels of x86 run them; where a trial shows that this
# one does not, qemu-user does.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR i686)
set(CMAKE_C_COMPILER i686-linux-gnu-gcc)
set(CMAKE_EXE_LINKER_FLAGS_INIT -static)
get_property(inside GLOBAL PROPERTY IN_TRY_COMPILE)
if(NOT inside AND NOT DEFINED KILN_I686_STATUS)
    file(WRITE ${CMAKE_BINARY_DIR}/runs.c "int main(void) { return 0; }\n")
    execute_process(COMMAND ${CMAKE_C_COMPILER} -static runs.c -o runs WORKING_DIRECTORY ${CMAKE_BINARY_DIR})
    execute_process(COMMAND ./runs WORKING_DIRECTORY ${CMAKE_BINARY_DIR} RESULT_VARIABLE status ERROR_QUIET)
    set(KILN_I686_STATUS "${status}" CACHE INTERNAL "0 if this system runs 32-bit programs of x86")
endif()
if(NOT inside AND NOT KILN_I686_STATUS STREQUAL 0)
    set(CMAKE_CROSSCOMPILING_EMULATOR qemu-i386)
endif()
