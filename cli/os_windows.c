// The command's interface to Windows 7 and later (os.h). In and out: paths in UTF-8, which are
// converted to UTF-16 for the Windows functions; errors are reported in errno.
#define WIN32_LEAN_AND_MEAN
#define _WIN32_WINNT 0x0601
#define PSAPI_VERSION 2 // takes GetProcessMemoryInfo from kernel32
#include "os.h"

#include <windows.h>

#include <errno.h>
#include <fcntl.h>
#include <io.h>
#include <psapi.h>
#include <shellapi.h>
#include <stdlib.h>

enum { ROOM = 4096 }; // greatest number of UTF-16 units of a path, with its final zero

static bool widen(const char *path, wchar_t wide[ROOM])
{
    if (MultiByteToWideChar(CP_UTF8, MB_ERR_INVALID_CHARS, path, -1, wide, ROOM))
        return true;
    errno = GetLastError() == ERROR_INSUFFICIENT_BUFFER ? ENAMETOOLONG : EILSEQ;
    return false;
}

// --------------------------------------------------------------------------------------- arguments

void os_use_slashes(char *path)
{
    bool verbatim = path[0] == '\\' && path[1] == '\\' && path[2] == '?';
    for (char *c = path; *c && !verbatim; c++)
        if (*c == '\\')
            *c = '/';
}

// Converts an argument to UTF-8 and its backslashes to slashes, which Windows accepts too: the
// command then knows one separator. Names that begin with \\?\ do not work in this form.
static char *narrow(const wchar_t *wide)
{
    int size = WideCharToMultiByte(CP_UTF8, 0, wide, -1, NULL, 0, NULL, NULL);
    char *text = size > 0 ? malloc((size_t)size) : NULL;
    if (!text || !WideCharToMultiByte(CP_UTF8, 0, wide, -1, text, size, NULL, NULL)) {
        free(text);
        return NULL;
    }
    os_use_slashes(text);
    return text;
}

static UINT code_page_before;

static void restore_code_page(void)
{
    SetConsoleOutputCP(code_page_before);
}

// The converted arguments are never freed: the process uses them until it ends.
bool os_begin(int *argc, char ***argv)
{
    code_page_before = GetConsoleOutputCP();
    if (code_page_before && SetConsoleOutputCP(CP_UTF8))
        atexit(restore_code_page);
    _setmode(_fileno(stdout), _O_BINARY); // in binary mode lines end in \n as on other systems
    wchar_t **wide = CommandLineToArgvW(GetCommandLineW(), argc);
    char **words = wide ? calloc((size_t)*argc + 1, sizeof *words) : NULL;
    bool good = words != NULL;
    for (int i = 0; good && i < *argc; i++) {
        words[i] = narrow(wide[i]);
        good = words[i] != NULL;
    }
    LocalFree(wide);
    *argv = words;
    return good;
}

// ---------------------------------------------------------------------------------------- terminal

bool os_is_terminal(os_stream stream)
{
    // the values of os_stream are the file descriptors 0, 1 and 2 of the standard streams
    return _isatty((int)stream) != 0;
}

int os_columns(void)
{
    CONSOLE_SCREEN_BUFFER_INFO info;
    HANDLE console = GetStdHandle(STD_OUTPUT_HANDLE);
    return GetConsoleScreenBufferInfo(console, &info) ? info.srWindow.Right - info.srWindow.Left + 1
                                                      : 0;
}

double os_seconds(void)
{
    LARGE_INTEGER now, frequency;
    QueryPerformanceCounter(&now);
    QueryPerformanceFrequency(&frequency);
    return (double)now.QuadPart / (double)frequency.QuadPart;
}

double os_cpu_seconds(void)
{
    FILETIME created, ended, system, user;
    if (!GetProcessTimes(GetCurrentProcess(), &created, &ended, &system, &user))
        return 0;
    return 1e-7 * (4294967296.0 * ((double)system.dwHighDateTime + user.dwHighDateTime) +
                   (double)system.dwLowDateTime + user.dwLowDateTime);
}

void os_tell_progress(const char *stage, double fraction)
{
    (void)stage;
    (void)fraction;
}

// ----------------------------------------------------------------------------------------- signals

enum { INTERRUPT = 2, BROKEN_PIPE = 13 }; // numbers that these signals have in POSIX

static volatile LONG caught;

// Windows calls this function in a separate thread when the user presses Ctrl-C or closes the
// console. The second such event ends the process.
static BOOL WINAPI on_event(DWORD event)
{
    (void)event;
    return InterlockedExchange(&caught, INTERRUPT) == 0;
}

void os_catch_signals(void)
{
    SetConsoleCtrlHandler(on_event, TRUE);
}

int os_signal(void)
{
    return (int)caught;
}

void os_without_signals(void (*work)(void *user), void *user)
{
    work(user);
}

int os_reader_gone(int error)
{
    return error == EPIPE ? 128 + BROKEN_PIPE : 0;
}

// ------------------------------------------------------------------------------------------ memory

size_t os_physical_memory(void)
{
    MEMORYSTATUSEX status = {.dwLength = sizeof status};
    return GlobalMemoryStatusEx(&status) && status.ullTotalPhys <= SIZE_MAX
               ? (size_t)status.ullTotalPhys
               : 0;
}

double os_peak_memory(void)
{
    PROCESS_MEMORY_COUNTERS counters;
    return GetProcessMemoryInfo(GetCurrentProcess(), &counters, sizeof counters)
               ? (double)counters.PeakWorkingSetSize
               : 0;
}

// ------------------------------------------------------------------------------- files and folders

// Sets errno from Windows' last error; returns false.
static bool failed(void)
{
    switch (GetLastError()) {
    case ERROR_FILE_NOT_FOUND:
    case ERROR_PATH_NOT_FOUND:
        errno = ENOENT;
        break;
    case ERROR_ALREADY_EXISTS:
    case ERROR_FILE_EXISTS:
        errno = EEXIST;
        break;
    default:
        errno = EACCES;
        break;
    }
    return false;
}

os_kind os_kind_of(const char *path)
{
    wchar_t wide[ROOM];
    if (!widen(path, wide))
        return OS_UNREACHABLE;
    DWORD attributes = GetFileAttributesW(wide);
    if (attributes != INVALID_FILE_ATTRIBUTES)
        return attributes & FILE_ATTRIBUTE_DIRECTORY ? OS_FOLDER : OS_FILE;
    failed();
    return errno == ENOENT ? OS_NOTHING : OS_UNREACHABLE;
}

// Only creating a file shows whether the access lists of Windows allow it.
bool os_is_writable(const char *folder)
{
    return os_kind_of(folder) == OS_FOLDER;
}

bool os_list_folder(const char *path, void (*name)(void *user, const char *name), void *user)
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

// Programs can set every time that Windows keeps of a file, so that only the content tells whether
// the file is unchanged.
bool os_stamp_of(const char *path, os_stamp *stamp)
{
    wchar_t wide[ROOM];
    WIN32_FILE_ATTRIBUTE_DATA data;
    *stamp = (os_stamp){0};
    if (!widen(path, wide))
        return false;
    if (!GetFileAttributesExW(wide, GetFileExInfoStandard, &data))
        return failed();
    if (data.dwFileAttributes & FILE_ATTRIBUTE_DIRECTORY) {
        errno = EISDIR;
        return false;
    }
    stamp->size = (uint64_t)data.nFileSizeHigh << 32 | data.nFileSizeLow;
    stamp->modified = (int64_t)((uint64_t)data.ftLastWriteTime.dwHighDateTime << 32 |
                                data.ftLastWriteTime.dwLowDateTime);
    return true;
}

FILE *os_open_file(const char *path)
{
    wchar_t wide[ROOM];
    return widen(path, wide) ? _wfopen(wide, L"rb") : NULL;
}

bool os_make_folder(const char *path)
{
    wchar_t wide[ROOM];
    return widen(path, wide) && (CreateDirectoryW(wide, NULL) || failed());
}

void os_remove_folder(const char *path)
{
    wchar_t wide[ROOM];
    if (widen(path, wide))
        RemoveDirectoryW(wide);
}

FILE *os_create_file(const char *path)
{
    wchar_t wide[ROOM];
    return widen(path, wide) ? _wfopen(wide, L"wb") : NULL;
}

void os_remove_file(const char *path)
{
    wchar_t wide[ROOM];
    if (widen(path, wide))
        DeleteFileW(wide);
}

bool os_replace(const char *from, const char *to)
{
    wchar_t wide_from[ROOM], wide_to[ROOM];
    if (!widen(from, wide_from) || !widen(to, wide_to))
        return false;
    return MoveFileExW(wide_from, wide_to, MOVEFILE_REPLACE_EXISTING) || failed();
}
