// Runs the whole command on files that were changed at random: process KILN SEEDS FINDS SECONDS
// [SEED]. KILN is the command, built with sanitizers. SEEDS has whole small files in folders, one
// for each kind. Each run must end within 20 seconds with exit code 0, 1 or 2, without a
// sanitizer's find; a failure must print a sentence of kiln's, and leave no output. The inputs of
// runs that break this are copied to FINDS.
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

enum { MOST_FILES = 4096, MOST_BYTES = 1 << 16, LONGEST_SECONDS = 20, FOUND_CODE = 99 };

typedef struct seed_file {
    char path[512];
    int folder;
} seed_file;

static seed_file files[MOST_FILES];
static int file_count;
static uint64_t random_state;

static void die(const char *what)
{
    fprintf(stderr, "%s: %s\n", what, strerror(errno));
    exit(2);
}

// A number from 0 to `count` - 1 (xorshift64*).
static size_t pick(size_t count)
{
    random_state ^= random_state >> 12;
    random_state ^= random_state << 25;
    random_state ^= random_state >> 27;
    return (size_t)((random_state * 0x2545f4914f6cdd1dU) >> 33) % count;
}

static double seconds_now(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

// ------------------------------------------------------------------------------------------- seeds

static void list_folder(const char *folder, int index)
{
    DIR *entries = opendir(folder);
    for (struct dirent *entry; entries && (entry = readdir(entries));) {
        if (entry->d_name[0] == '.' || file_count == MOST_FILES)
            continue;
        seed_file *file = &files[file_count++];
        snprintf(file->path, sizeof file->path, "%s/%s", folder, entry->d_name);
        file->folder = index;
    }
    if (entries)
        closedir(entries);
}

// Lists the files of the kinds that the command reads.
static void list_seeds(const char *seeds)
{
    static const char *const kinds[] = {"exr", "hdr", "png", "jpeg",      "ktx1",  "ktx2",
                                        "dds", "env", "glb", "harmonics", "table", "input"};
    for (int i = 0; i < (int)(sizeof kinds / sizeof *kinds); i++) {
        char folder[256];
        snprintf(folder, sizeof folder, "%s/%s", seeds, kinds[i]);
        list_folder(folder, i);
    }
    if (!file_count)
        die(seeds);
}

static size_t read_bytes(const char *path, uint8_t bytes[MOST_BYTES])
{
    FILE *file = fopen(path, "rb");
    size_t size = file ? fread(bytes, 1, MOST_BYTES, file) : 0;
    if (file)
        fclose(file);
    return size;
}

static void write_bytes(const char *path, const uint8_t *bytes, size_t size)
{
    FILE *file = fopen(path, "wb");
    if (!file || fwrite(bytes, 1, size, file) != size || fclose(file) != 0)
        die(path);
}

// ----------------------------------------------------------------------------------------- changes

// Puts bytes of another file of the same kind in place.
static void splice(int folder, uint8_t *bytes, size_t size)
{
    static uint8_t other[MOST_BYTES];
    const seed_file *file = &files[pick((size_t)file_count)];
    size_t other_size = file->folder == folder ? read_bytes(file->path, other) : 0;
    if (!other_size)
        return;
    size_t from = pick(other_size), to = pick(size), count = 1 + pick(64);
    count = count < other_size - from ? count : other_size - from;
    count = count < size - to ? count : size - to;
    memcpy(bytes + to, other + from, count);
}

// Makes one change, half of the time in the first 512 bytes, where headers are.
static size_t change(int folder, uint8_t *bytes, size_t size)
{
    static const uint32_t numbers[] = {0,          1,          0xff,       0x7fff,
                                       0xffff,     0x10000,    0x7fffffff, 0x80000000,
                                       0xffffffff, 0x01000000, 16,         32769};
    if (!size)
        return 0;
    size_t head = pick(2) && size > 512 ? 512 : size, at = pick(head);
    uint32_t number = numbers[pick(sizeof numbers / sizeof *numbers)];
    switch (pick(8)) {
    case 0:
        return pick(4) ? size : at; // seldom, or most files would be cut off
    case 1:
        splice(folder, bytes, size);
        return size;
    case 2:
        memcpy(bytes + at, &number, size - at < 4 ? size - at : 4);
        return size;
    case 3: // a byte is left out
        memmove(bytes + at, bytes + at + 1, size - at - 1);
        return size - 1;
    case 4: // a byte is repeated
        if (size < MOST_BYTES)
            memmove(bytes + at + 1, bytes + at, size++ - at);
        return size;
    case 5:
        bytes[at] = (uint8_t)(bytes[at] + (pick(2) ? 1 : -1));
        return size;
    case 6:
        bytes[at] = (uint8_t)pick(256);
        return size;
    default:
        bytes[at] ^= (uint8_t)(1U << pick(8));
        return size;
    }
}

// -------------------------------------------------------------------------------------------- runs

// Arguments of the command; "IN" stands for the input, and a line with "-" reads it from standard
// input.
static const char *const lines[][11] = {
    {"info", "IN"},
    {"info", "IN", "--json"},
    {"info", "-"},
    {"lights", "IN"},
    {"bake", "IN", "-o", "out.ktx2", "--size", "4", "--sh-bands", "2", "--sh", "sh.json"},
    {"bake", "-", "-o", "out.ktx2", "--size", "4", "--json"},
    {"bake", "IN", "-o", "out.exr", "--shape", "octahedron", "--size", "4", "--levels", "1"},
    {"bake", "IN", "-o", "out.dds", "--size", "4", "--layout", "probe", "--negative", "zero"},
    {"bake", "IN", "-o", "out.ktx2", "--size", "4", "--layout", "ball"},
    {"bake", "IN", "-o", "out.ktx2", "--size", "4", "--layout", "strip"},
    {"bake", "IN", "-o", "out.ktx2", "--size", "4", "--sun", "extract"}};
enum { LINES = sizeof lines / sizeof *lines };

static void open_as(int descriptor, const char *path, int flags)
{
    int file = open(path, flags, 0666);
    if (file < 0 || dup2(file, descriptor) < 0)
        _exit(FOUND_CODE - 1);
}

static pid_t start(const char *kiln, int line)
{
    const char *arguments[12] = {kiln};
    for (int i = 0; i < 11 && lines[line][i]; i++)
        arguments[i + 1] = strcmp(lines[line][i], "IN") ? lines[line][i] : "in.bin";
    pid_t child = fork();
    if (child < 0)
        die("fork");
    if (child > 0)
        return child;
    open_as(STDIN_FILENO, "in.bin", O_RDONLY);
    open_as(STDOUT_FILENO, "out.log", O_WRONLY | O_CREAT | O_TRUNC);
    open_as(STDERR_FILENO, "err.log", O_WRONLY | O_CREAT | O_TRUNC);
    execv(kiln, (char *const *)(uintptr_t)arguments);
    _exit(FOUND_CODE - 1);
}

// Returns the exit code, or -1 for a run that a signal ended or that took too long.
static int await(pid_t child)
{
    const struct timespec pause = {.tv_nsec = 2000000};
    int status = 0;
    double begin = seconds_now();
    while (waitpid(child, &status, WNOHANG) == 0) {
        if (seconds_now() - begin > LONGEST_SECONDS) {
            kill(child, SIGKILL);
            waitpid(child, &status, 0);
            return -1;
        }
        nanosleep(&pause, NULL);
    }
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

// Returns what is wrong with a run, or NULL.
static const char *judge(int line, int code)
{
    static char text[MOST_BYTES + 1];
    struct stat unused;
    text[read_bytes("err.log", (uint8_t *)text)] = 0;
    if (code == -1)
        return "a signal ended the run, or the run took too long";
    if (strstr(text, "Sanitizer") || strstr(text, "runtime error"))
        return "a sanitizer has found something";
    if (code < 0 || code > 2)
        return "the exit code is not 0, 1 or 2";
    if (code && strncmp(text, "kiln: ", 6) != 0)
        return "a failure has no sentence";
    bool bakes = !strcmp(lines[line][0], "bake");
    bool wrote = bakes && stat(lines[line][3], &unused) == 0;
    if (bakes && code == 0 && !wrote)
        return "nothing was written";
    if (code && wrote)
        return "a failure left a file";
    return NULL;
}

static void keep(const char *finds, long run, int line, const char *fault, const uint8_t *bytes,
                 size_t size)
{
    char path[1024];
    snprintf(path, sizeof path, "%s/process-%ld-%ld.bin", finds, (long)getpid(), run);
    write_bytes(path, bytes, size);
    printf("%s: %s: kiln", path, fault);
    for (int i = 0; i < 11 && lines[line][i]; i++)
        printf(" %s", lines[line][i]);
    printf("\n");
    strcat(path, ".err");
    static uint8_t said[MOST_BYTES];
    write_bytes(path, said, read_bytes("err.log", said));
}

// Makes one changed file and one run. Returns the exit code, or -1 for a find.
static int run_once(const char *kiln, const char *finds, long run)
{
    static uint8_t bytes[MOST_BYTES + 1];
    const seed_file *file = &files[pick((size_t)file_count)];
    size_t size = read_bytes(file->path, bytes);
    for (size_t i = 1 + pick(4); i > 0; i--)
        size = change(file->folder, bytes, size);
    int line = (int)pick(LINES);
    write_bytes("in.bin", bytes, size);
    int code = await(start(kiln, line));
    const char *fault = judge(line, code);
    if (fault)
        keep(finds, run, line, fault, bytes, size);
    unlink("out.ktx2");
    unlink("out.dds");
    unlink("out.exr");
    unlink("sh.json");
    return fault ? -1 : code;
}

// Makes a path absolute, so that the program may work in another folder.
static char *absolute(const char *path)
{
    char *full = realpath(path, NULL);
    if (!full)
        die(path);
    return full;
}

int main(int argc, char **argv)
{
    if (argc < 5) {
        fprintf(stderr, "usage: %s KILN SEEDS FINDS SECONDS [SEED]\n", argv[0]);
        return 2;
    }
    char work[] = "/tmp/kiln-process-XXXXXX";
    char *kiln = absolute(argv[1]), *seeds = absolute(argv[2]), *finds = absolute(argv[3]);
    random_state = argc > 5 ? strtoull(argv[5], NULL, 10) + 1 : (uint64_t)time(NULL) | 1;
    list_seeds(seeds);
    if (!mkdtemp(work) || chdir(work) != 0)
        die(work);
    setenv("ASAN_OPTIONS", "exitcode=99:allocator_may_return_null=1", 1);
    setenv("UBSAN_OPTIONS", "exitcode=99:halt_on_error=1:print_stacktrace=1", 1);
    double end = seconds_now() + atof(argv[4]);
    long runs = 0, codes[3] = {0}, faults = 0;
    for (; seconds_now() < end; runs++) {
        int code = run_once(kiln, finds, runs);
        if (code < 0)
            faults++;
        else
            codes[code]++;
    }
    printf("process: %ld runs, exit 0: %ld, 1: %ld, 2: %ld; %ld finds\n", runs, codes[0], codes[1],
           codes[2], faults);
    unlink("in.bin");
    unlink("out.log");
    unlink("err.log");
    if (chdir("/") == 0)
        rmdir(work);
    free(kiln);
    free(seeds);
    free(finds);
    return faults > 0;
}
