// The functions of os.h for Windows 7 and later. In: paths in kiln's UTF-8, descriptors, sizes.
// Out: as os.h states. The functions of Windows with wide characters are called, because those with
// narrow characters take paths in the user's code page. Paths are converted from UTF-8 to UTF-16. A
// path may have as many characters as Windows allows without a prefix (260), and may use forward
// slashes.
#define WIN32_LEAN_AND_MEAN
#define _WIN32_WINNT 0x0601
#include "base/os.h"

#include <windows.h>

#include <errno.h>
#include <fcntl.h>
#include <io.h>
#include <locale.h>
#include <malloc.h>
#include <process.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>

// ------------------------------------------------------------------------------------------- paths

enum { ROOM = 4096 }; // greatest number of UTF-16 units of a path, with its terminating zero

// Converts a path to UTF-16. Returns false with errno set if the path is not UTF-8 or is too long.
static bool widen(const char *path, wchar_t wide[ROOM])
{
    if (MultiByteToWideChar(CP_UTF8, MB_ERR_INVALID_CHARS, path, -1, wide, ROOM))
        return true;
    errno = GetLastError() == ERROR_INSUFFICIENT_BUFFER ? ENAMETOOLONG : EILSEQ;
    return false;
}

// Sets errno from the last error of Windows. Always returns false.
static bool failed(void)
{
    switch (GetLastError()) {
    case ERROR_FILE_NOT_FOUND:
    case ERROR_PATH_NOT_FOUND:
        errno = ENOENT;
        break;
    case ERROR_ACCESS_DENIED:
    case ERROR_SHARING_VIOLATION: // another process has the file open
        errno = EACCES;
        break;
    case ERROR_ALREADY_EXISTS:
    case ERROR_FILE_EXISTS:
        errno = EEXIST;
        break;
    case ERROR_DISK_FULL:
        errno = ENOSPC;
        break;
    case ERROR_DIR_NOT_EMPTY:
        errno = ENOTEMPTY;
        break;
    default:
        errno = EIO;
        break;
    }
    return false;
}

// ------------------------------------------------------------------------------------------- files

ki_os_kind ki_os_kind_of(const char *path)
{
    wchar_t wide[ROOM];
    if (!widen(path, wide))
        return KI_OS_NOTHING;
    DWORD attributes = GetFileAttributesW(wide);
    if (attributes == INVALID_FILE_ATTRIBUTES)
        return KI_OS_NOTHING;
    return attributes & FILE_ATTRIBUTE_DIRECTORY ? KI_OS_FOLDER
           : attributes & FILE_ATTRIBUTE_DEVICE  ? KI_OS_OTHER
                                                 : KI_OS_FILE;
}

uint64_t ki_os_size(int file)
{
    struct _stat64 status;
    bool known = _fstat64(file, &status) == 0 && (status.st_mode & _S_IFMT) == _S_IFREG &&
                 status.st_size > 0;
    return known ? (uint64_t)status.st_size : 0;
}

bool ki_os_is_separator(char c)
{
    return c == '/' || c == '\\';
}

int ki_os_open(const char *path)
{
    wchar_t wide[ROOM];
    return widen(path, wide) ? _wopen(wide, _O_RDONLY | _O_BINARY | _O_NOINHERIT) : -1;
}

int ki_os_standard_input(void)
{
    _setmode(0, _O_BINARY);
    return 0;
}

// Opens a file that other processes may read, rename and remove meanwhile.
static HANDLE open_shared(const wchar_t *wide, DWORD access, DWORD disposition, DWORD flags)
{
    return CreateFileW(wide, access, FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE, NULL,
                       disposition, flags, NULL);
}

// Locks one byte at an offset that no file reaches. Windows unlocks the byte when the handle is
// closed.
static bool lock(HANDLE file)
{
    OVERLAPPED at = {.OffsetHigh = 0x7fffffff};
    return LockFileEx(file, LOCKFILE_EXCLUSIVE_LOCK | LOCKFILE_FAIL_IMMEDIATELY, 0, 1, 0, &at);
}

// Another process may take the new file for an abandoned one and remove it between its creation and
// its locking; the name then counts as in use.
int ki_os_create(const char *path)
{
    wchar_t wide[ROOM];
    if (!widen(path, wide))
        return -1;
    HANDLE file = open_shared(wide, GENERIC_WRITE, CREATE_NEW, FILE_ATTRIBUTE_NORMAL);
    if (file == INVALID_HANDLE_VALUE) {
        failed();
        return -1;
    }
    FILE_STANDARD_INFO info = {0};
    bool held = lock(file) &&
                GetFileInformationByHandleEx(file, FileStandardInfo, &info, sizeof info) &&
                !info.DeletePending;
    int descriptor = held ? _open_osfhandle((intptr_t)file, _O_WRONLY | _O_BINARY) : -1;
    if (descriptor < 0) {
        CloseHandle(file);
        errno = EEXIST;
    }
    return descriptor;
}

void ki_os_remove_abandoned(const char *path)
{
    wchar_t wide[ROOM];
    if (!widen(path, wide))
        return;
    HANDLE file = open_shared(wide, GENERIC_WRITE, OPEN_EXISTING, FILE_ATTRIBUTE_NORMAL);
    if (file == INVALID_HANDLE_VALUE)
        return;
    if (lock(file))
        DeleteFileW(wide);
    CloseHandle(file);
}

// Nothing is copied: a new file of Windows takes its access list from its folder, as every file
// there does.
bool ki_os_copy_mode(int file, const char *path)
{
    (void)file;
    (void)path;
    return true;
}

// Limits the size of one read or write, because _read and _write take at most INT_MAX bytes.
static unsigned at_once(size_t size)
{
    return size < 1u << 30 ? (unsigned)size : 1u << 30;
}

ptrdiff_t ki_os_read(int file, void *bytes, size_t size)
{
    return _read(file, bytes, at_once(size));
}

ptrdiff_t ki_os_read_at(int file, void *bytes, size_t size, uint64_t at)
{
    DWORD got = 0;
    OVERLAPPED place = {.Offset = (DWORD)at, .OffsetHigh = (DWORD)(at >> 32)};
    if (ReadFile((HANDLE)_get_osfhandle(file), bytes, at_once(size), &got, &place))
        return (ptrdiff_t)got;
    if (GetLastError() == ERROR_HANDLE_EOF)
        return 0;
    failed();
    return -1;
}

ptrdiff_t ki_os_write(int file, const void *bytes, size_t size)
{
    return _write(file, bytes, at_once(size));
}

bool ki_os_sync(int file)
{
    return _commit(file) == 0;
}

bool ki_os_close(int file)
{
    return _close(file) == 0;
}

// Copies the path that Windows reports for an open file, behind all links, to `target`. Returns
// false with errno set.
static bool copy_final_path(HANDLE file, char target[KI_OS_PATH])
{
    wchar_t wide[ROOM];
    DWORD length = GetFinalPathNameByHandleW(file, wide, ROOM, 0);
    if (!length)
        return failed();
    if (length < ROOM && WideCharToMultiByte(CP_UTF8, 0, wide, -1, target, KI_OS_PATH, NULL, NULL))
        return true;
    errno = ENAMETOOLONG;
    return false;
}

bool ki_os_follow(const char *path, char target[KI_OS_PATH])
{
    wchar_t wide[ROOM];
    if (!widen(path, wide))
        return false;
    if (snprintf(target, KI_OS_PATH, "%s", path) >= KI_OS_PATH) {
        errno = ENAMETOOLONG;
        return false;
    }
    DWORD attributes = GetFileAttributesW(wide);
    if (attributes == INVALID_FILE_ATTRIBUTES || !(attributes & FILE_ATTRIBUTE_REPARSE_POINT))
        return true;
    HANDLE file = open_shared(wide, 0, OPEN_EXISTING, FILE_FLAG_BACKUP_SEMANTICS);
    if (file == INVALID_HANDLE_VALUE)
        return failed();
    bool good = copy_final_path(file, target);
    CloseHandle(file);
    return good;
}

bool ki_os_replace(const char *from, const char *to)
{
    wchar_t wide_from[ROOM], wide_to[ROOM];
    if (!widen(from, wide_from) || !widen(to, wide_to))
        return false;
    return MoveFileExW(wide_from, wide_to, MOVEFILE_REPLACE_EXISTING | MOVEFILE_WRITE_THROUGH) ||
           failed();
}

// Nothing is left to do: ki_os_replace renames with MOVEFILE_WRITE_THROUGH, which waits for the
// disk.
bool ki_os_sync_folder(const char *path)
{
    (void)path;
    return true;
}

// Windows cannot lock folders, so the caller goes on without a lock.
int ki_os_enter_folder(const char *path)
{
    (void)path;
    return -1;
}

void ki_os_leave_folder(int folder)
{
    (void)folder;
}

bool ki_os_remove(const char *path)
{
    wchar_t wide[ROOM];
    return widen(path, wide) && (DeleteFileW(wide) || failed());
}

bool ki_os_make_folder(const char *path)
{
    wchar_t wide[ROOM];
    return widen(path, wide) && (CreateDirectoryW(wide, NULL) || failed());
}

bool ki_os_remove_folder(const char *path)
{
    wchar_t wide[ROOM];
    return widen(path, wide) && (RemoveDirectoryW(wide) || failed());
}

bool ki_os_list_folder(const char *path, void (*name)(void *user, const char *name), void *user)
{
    char pattern[ROOM];
    wchar_t wide[ROOM];
    WIN32_FIND_DATAW entry;
    if (snprintf(pattern, sizeof pattern, "%s/*", path) >= ROOM) {
        errno = ENAMETOOLONG;
        return false;
    }
    if (!widen(pattern, wide))
        return false;
    HANDLE search = FindFirstFileW(wide, &entry);
    if (search == INVALID_HANDLE_VALUE)
        return failed();
    do {
        char utf8[4 * MAX_PATH];
        if (WideCharToMultiByte(CP_UTF8, 0, entry.cFileName, -1, utf8, sizeof utf8, NULL, NULL))
            name(user, utf8);
    } while (FindNextFileW(search, &entry));
    FindClose(search);
    return true;
}

long ki_os_process(void)
{
    return _getpid();
}

// -------------------------------------------------------------------------------------------- text

// What a thread must restore after working in the locale "C".
typedef struct saved_locale {
    int per_thread;
    char name[128];
} saved_locale;

// Gives the calling thread a locale of its own, "C" for numbers.
static void enter_plain_locale(saved_locale *saved)
{
    saved->per_thread = _configthreadlocale(_ENABLE_PER_THREAD_LOCALE);
    const char *name = setlocale(LC_NUMERIC, NULL);
    snprintf(saved->name, sizeof saved->name, "%s", name ? name : "C");
    setlocale(LC_NUMERIC, "C");
}

static void leave_plain_locale(const saved_locale *saved)
{
    setlocale(LC_NUMERIC, saved->name);
    if (saved->per_thread > 0)
        _configthreadlocale(saved->per_thread);
}

int ki_os_print(char *text, size_t room, const char *format, va_list list)
{
    saved_locale saved;
    enter_plain_locale(&saved);
    int length = vsnprintf(text, room, format, list);
    leave_plain_locale(&saved);
    return length;
}

float ki_os_read_float(const char *text)
{
    saved_locale saved;
    enter_plain_locale(&saved);
    float value = strtof(text, NULL);
    leave_plain_locale(&saved);
    return value;
}

// ------------------------------------------------------------------------------------------ memory

void *ki_os_allocate(size_t size)
{
    return _aligned_malloc(size, 64);
}

void ki_os_release(void *memory, size_t size)
{
    (void)size;
    _aligned_free(memory);
}

// ----------------------------------------------------------------------------------------- threads

// Windows defines each of these objects as one pointer that is initially zero, so that os.h can
// declare them without <windows.h>.
_Static_assert(sizeof(ki_os_mutex) == sizeof(SRWLOCK), "ki_os_mutex holds an SRWLOCK");
_Static_assert(sizeof(ki_os_condition) == sizeof(CONDITION_VARIABLE),
               "ki_os_condition holds a CONDITION_VARIABLE");

static unsigned __stdcall run(void *data)
{
    const ki_os_work *work = data;
    work->run(work->data);
    return 0;
}

bool ki_os_thread_start(ki_os_thread *thread, ki_os_work *work)
{
    *thread = (HANDLE)_beginthreadex(NULL, KI_OS_STACK, run, work,
                                     STACK_SIZE_PARAM_IS_A_RESERVATION, NULL);
    return *thread != NULL;
}

void ki_os_thread_join(ki_os_thread *thread)
{
    WaitForSingleObject(*thread, INFINITE);
    CloseHandle(*thread);
}

uintptr_t ki_os_this_thread(void)
{
    return GetCurrentThreadId();
}

void ki_os_mutex_begin(ki_os_mutex *mutex)
{
    InitializeSRWLock((SRWLOCK *)mutex);
}

void ki_os_mutex_end(ki_os_mutex *mutex)
{
    (void)mutex;
}

void ki_os_lock(ki_os_mutex *mutex)
{
    AcquireSRWLockExclusive((SRWLOCK *)mutex);
}

void ki_os_unlock(ki_os_mutex *mutex)
{
    ReleaseSRWLockExclusive((SRWLOCK *)mutex);
}

void ki_os_condition_begin(ki_os_condition *condition)
{
    InitializeConditionVariable((CONDITION_VARIABLE *)condition);
}

void ki_os_condition_end(ki_os_condition *condition)
{
    (void)condition;
}

void ki_os_wait(ki_os_condition *condition, ki_os_mutex *mutex)
{
    SleepConditionVariableSRW((CONDITION_VARIABLE *)condition, (SRWLOCK *)mutex, INFINITE, 0);
}

void ki_os_wait_briefly(ki_os_condition *condition, ki_os_mutex *mutex)
{
    SleepConditionVariableSRW((CONDITION_VARIABLE *)condition, (SRWLOCK *)mutex, 50, 0);
}

void ki_os_wake_one(ki_os_condition *condition)
{
    WakeConditionVariable((CONDITION_VARIABLE *)condition);
}

void ki_os_wake_all(ki_os_condition *condition)
{
    WakeAllConditionVariable((CONDITION_VARIABLE *)condition);
}

int ki_os_core_count(void)
{
    DWORD count = GetActiveProcessorCount(ALL_PROCESSOR_GROUPS);
    return count < 1 ? 1 : count > 1 << 20 ? 1 << 20 : (int)count;
}

double ki_os_seconds(void)
{
    LARGE_INTEGER now, frequency;
    QueryPerformanceCounter(&now);
    QueryPerformanceFrequency(&frequency);
    return (double)now.QuadPart / (double)frequency.QuadPart;
}
