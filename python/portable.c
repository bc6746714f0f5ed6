// Makes the shared library of the wheel run on Linux systems that are older than the one it was
// built on, and on musl. In: calls of the C library as a new glibc names them. Out: hidden
// functions of the same names, which call what every C library of the last ten years has:
//   - stat, fstat and lstat are functions of glibc since 2.33 only, and become system calls;
//   - pthread_create, pthread_join and pthread_attr_setstacksize moved to another version in glibc 2.34, and become
//     calls of the versions before, and so does fmod of glibc 2.38;
//   - the checked functions that FORTIFY calls are not in musl, and check here;
//   - libjpeg-turbo's static library refers to stderr in a function that kiln never calls.
// tests/python/wheel.py reads the versions that the library needs.
// SPDX-License-Identifier: MIT
#undef _FORTIFY_SOURCE // the checked functions below would call themselves
#define _GNU_SOURCE    // syscall
#include <math.h>
#include <pthread.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#define HIDDEN __attribute__((visibility("hidden")))

// ------------------------------------------------------------------------------------------- files

enum {
    HERE = -100,
    NO_FOLLOW = 0x100,
    EMPTY = 0x1000
}; // AT_FDCWD, AT_SYMLINK_NOFOLLOW, AT_EMPTY_PATH

HIDDEN int stat64(const char *path, struct stat64 *status)
{
    return (int)syscall(SYS_newfstatat, HERE, path, status, 0);
}

HIDDEN int lstat64(const char *path, struct stat64 *status)
{
    return (int)syscall(SYS_newfstatat, HERE, path, status, NO_FOLLOW);
}

HIDDEN int fstat64(int file, struct stat64 *status)
{
    return (int)syscall(SYS_fstat, file, status);
}

// ----------------------------------------------------------------------------------------- threads

#ifdef __x86_64__
#define OLD "GLIBC_2.2.5"
#else
#define OLD "GLIBC_2.17"
#endif
#define FROM(name) __asm__(".symver old_" #name ", " #name "@" OLD)

int old_pthread_create(pthread_t *thread, const pthread_attr_t *attributes, void *(*run)(void *),
                       void *argument);
int old_pthread_join(pthread_t thread, void **result);
int old_pthread_attr_setstacksize(pthread_attr_t *attributes, size_t size);
FROM(pthread_create);
FROM(pthread_join);
FROM(pthread_attr_setstacksize);

HIDDEN int pthread_create(pthread_t *thread, const pthread_attr_t *attributes, void *(*run)(void *),
                          void *argument)
{
    return old_pthread_create(thread, attributes, run, argument);
}

HIDDEN int pthread_join(pthread_t thread, void **result)
{
    return old_pthread_join(thread, result);
}

HIDDEN int pthread_attr_setstacksize(pthread_attr_t *attributes, size_t size)
{
    return old_pthread_attr_setstacksize(attributes, size);
}

// glibc 2.38 has another fmod, which does not set errno. Both are exact.
double old_fmod(double x, double y);
FROM(fmod);

HIDDEN double fmod(double x, double y)
{
    return old_fmod(x, y);
}

// ----------------------------------------------------------------------------------- checked calls

static void check(size_t size, size_t room)
{
    if (size > room)
        abort();
}

HIDDEN void *__memcpy_chk(void *to, const void *from, size_t size, size_t room);
HIDDEN void *__memcpy_chk(void *to, const void *from, size_t size, size_t room)
{
    check(size, room);
    return memcpy(to, from, size);
}

HIDDEN void *__memmove_chk(void *to, const void *from, size_t size, size_t room);
HIDDEN void *__memmove_chk(void *to, const void *from, size_t size, size_t room)
{
    check(size, room);
    return memmove(to, from, size);
}

HIDDEN void *__memset_chk(void *to, int value, size_t size, size_t room);
HIDDEN void *__memset_chk(void *to, int value, size_t size, size_t room)
{
    check(size, room);
    return memset(to, value, size);
}

HIDDEN int __vsnprintf_chk(char *to, size_t size, int flag, size_t room, const char *format,
                           va_list list);
HIDDEN int __vsnprintf_chk(char *to, size_t size, int flag, size_t room, const char *format,
                           va_list list)
{
    (void)flag;
    check(size, room);
    return vsnprintf(to, size, format, list);
}

HIDDEN int __snprintf_chk(char *to, size_t size, int flag, size_t room, const char *format, ...);
HIDDEN int __snprintf_chk(char *to, size_t size, int flag, size_t room, const char *format, ...)
{
    va_list list;
    va_start(list, format);
    int length = __vsnprintf_chk(to, size, flag, room, format, list);
    va_end(list);
    return length;
}

HIDDEN _Noreturn void __longjmp_chk(jmp_buf to, int value);
HIDDEN _Noreturn void __longjmp_chk(jmp_buf to, int value)
{
    longjmp(to, value);
}

// Calls that libjpeg-turbo's static library makes in functions that kiln never calls.
#undef stderr
extern HIDDEN FILE *stderr;
FILE *stderr;
HIDDEN int __fprintf_chk(FILE *file, int flag, const char *format, ...);
HIDDEN int __fprintf_chk(FILE *file, int flag, const char *format, ...)
{
    (void)file, (void)flag, (void)format;
    return -1;
}
