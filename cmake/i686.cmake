# Linux on 32-bit x86 by Debian's cross compiler (gcc-i686-linux-gnu). Programs are linked statically, since
# its C library is not where programs look for it; a 64-bit Linux runs them, elsewhere qemu-user does.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR i686)
set(CMAKE_C_COMPILER i686-linux-gnu-gcc)
set(CMAKE_EXE_LINKER_FLAGS_INIT -static)
if(NOT CMAKE_HOST_SYSTEM_PROCESSOR STREQUAL x86_64)
    set(CMAKE_CROSSCOMPILING_EMULATOR qemu-i386)
endif()
