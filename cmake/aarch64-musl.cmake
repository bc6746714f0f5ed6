# Linux on 64-bit ARM with the C library musl, linked into each program: one file that runs anywhere. The environment
# variable KILN_MUSL_GCC is the compiler, which packaging/libraries.sh makes.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_C_COMPILER $ENV{KILN_MUSL_GCC})
set(CMAKE_EXE_LINKER_FLAGS_INIT -static)
set(CMAKE_CROSSCOMPILING_EMULATOR qemu-aarch64)
