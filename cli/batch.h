// The state of kiln batch: what is to be baked (batch_lines.c and batch_jobs.c), what was baked
// before (batch_record.c), the threads and the memory (batch_pool.c, batch_memory.c), and what is
// printed (batch_report.c).
#ifndef KILN_CLI_BATCH_H
#define KILN_CLI_BATCH_H

#include "bake.h"
#include "os.h"
#include "os_thread.h"

#include <stdatomic.h>

// ------------------------------------------------------------------------------------------- texts

/// Memory for texts and arrays that live as long as the batch.
typedef struct batch_store {
    struct batch_piece *piece; ///< the piece that is being filled, which links to the full ones
} batch_store;

/// Returns `size` bytes with the alignment of pointers, or NULL if memory runs out.
void *batch_keep(batch_store *store, size_t size);
char *batch_keep_text(batch_store *store, const char *text, size_t length);
void batch_store_free(batch_store *store);

// ------------------------------------------------------------------------------------------- lines

/// One option of bake with its text.
typedef struct batch_setting {
    int option; ///< index of the row in bake_options
    const char *text;
} batch_setting;

/// A line of a manifest, or the command line: inputs, and options of bake.
typedef struct batch_line {
    cli_command command; ///< the command bake, with the place of the line for error messages
    const char **input;
    int input_count;
    batch_setting *setting; ///< in the order of bake_options, each option at most once
    int setting_count;
} batch_line;

typedef struct batch_lines {
    batch_line **line;
    size_t count, room;
} batch_lines;

/// Adds a line for the words of the command line, with the options in `also`.
int batch_add_words(batch_store *store, const char **words, int count,
                    const char *const also[CLI_MAX_OPTIONS], batch_lines *lines);
/// Adds the lines of a manifest, a file or "-" for standard input. Options that a line does not
/// have are taken from `also`. Returns CLI_GO or CLI_FAILED.
int batch_add_manifest(batch_store *store, const char *path,
                       const char *const also[CLI_MAX_OPTIONS], batch_lines *lines);
/// Text of an option of the line, NULL for an absent option.
const char *batch_line_text(const batch_line *line, int option);

// -------------------------------------------------------------------------------------------- jobs

enum { BATCH_PATHS = 4 }; ///< options of bake that name a file to write

typedef enum batch_outcome {
    BATCH_WAITS,  ///< not begun, or stopped by a signal
    BATCH_KEPT,   ///< the files of an earlier run are what a bake would write
    BATCH_DUE,    ///< is to be baked; only in a dry run
    BATCH_BAKED,  ///< the files were written
    BATCH_FAILED, ///< an error message was printed
} batch_outcome;

/// One environment: the inputs of one bake, and the files to write.
typedef struct batch_job {
    const batch_line *line;
    const char **input;
    int input_count;
    const char *path[BATCH_PATHS]; ///< paths to write, by the order of the options; NULL for none
    batch_outcome outcome;
    double weight; ///< measure of the work, for the estimate of the time that is left
    /// files that were read and written, each with a NUL behind it and a second NUL at the end;
    /// NULL until they are known
    const char *read, *written;
} batch_job;

/// A folder whose pictures are inputs: a picture that is added to the folder becomes a job.
typedef struct batch_folder {
    struct batch_folder *below;
    const char *path;
} batch_folder;

typedef struct batch_jobs {
    batch_job *job;
    size_t count, room;
    batch_folder *folder; ///< folders that were listed, linked
} batch_jobs;

/// Makes jobs of lines: folders and patterns of names become one job for each picture. Returns
/// CLI_GO or an exit code.
int batch_make_jobs(batch_store *store, const batch_lines *lines, batch_jobs *jobs);
/// Checks that no file is written by two jobs, or written by one and read by another.
int batch_check_files(const batch_jobs *jobs);
/// Fills in a bake with the options of a job and checks them. `b` must not be moved afterwards.
int batch_job_bake(const batch_job *job, bake *b);
/// Returns the number that bakes with equal plans share (bake.plan_key).
uint64_t batch_plan_key(const batch_job *job);
/// Calls file(user, PATH) for each file that the job reads, in a fixed order: files of a pattern or
/// a folder of faces are found by listing the folder. Returns false if memory runs out.
bool batch_list_inputs(const batch_job *job, void (*file)(void *user, const char *path),
                       void *user);

// ----------------------------------------------------------------------------------------- records

/// Why an environment is baked, or is not.
typedef enum batch_reason {
    BATCH_UNCHANGED,
    BATCH_NO_RECORD,
    BATCH_OTHER_VERSION,
    BATCH_OTHER_OPTIONS,
    BATCH_OTHER_INPUT,
    BATCH_OTHER_OUTPUT,
    BATCH_ALWAYS,
} batch_reason;

/// A file that was read or written, as its record describes it.
typedef struct batch_file {
    char *path;
    os_stamp stamp;
    uint64_t hash;
    bool is_known; ///< stamp and hash are those of the file as it is now
} batch_file;

typedef struct batch_files {
    batch_file *file;
    int count, room;
    bool failed; ///< memory ran out, or a file cannot be described
} batch_files;

/// What a bake was made from, and what it wrote.
typedef struct batch_record {
    char path[4096]; ///< where the record is kept; "" where it cannot be kept
    char *head;      ///< version and options, as text
    batch_files in, out;
} batch_record;

/// Begins the record of a job: finds its path, its options and its inputs.
void batch_record_begin(batch_record *record, const batch_job *job);
/// Compares the record on disk with the options and with the files as they are now, and rewrites it
/// where only the files' times changed, unless `only_look`. On BATCH_UNCHANGED `out` is filled in.
batch_reason batch_record_compare(batch_record *record, bool only_look);
/// Forgets the outputs, before they are baked.
void batch_record_restart(batch_record *record);
/// Computes the checksums of the inputs, before they are baked.
void batch_record_inputs(batch_record *record);
/// Adds a file that the bake writes; `user` is the record (bake.watch).
void batch_record_watch(void *user, const char *path, const void *bytes, size_t size);
/// Writes the record after the bake, unless an input has changed meanwhile.
void batch_record_write(batch_record *record);
void batch_record_free(batch_record *record);

// -------------------------------------------------------------------------------------------- pool

typedef struct batch batch;

/// Blocks that were released and wait to be used again. Fresh memory costs a page fault for every
/// 4 kB, which is a fifth of the time of a bake.
typedef struct batch_heap {
    os_mutex mutex;
    batch *batch;
    struct batch_block *free[512]; ///< lists of free blocks by the class of their size
    size_t held, peak;             ///< bytes in use now, and the most since batch_heap_mark
} batch_heap;

void batch_heap_begin(batch_heap *heap, batch *all);
/// Gives the free blocks back to the system.
void batch_heap_trim(batch_heap *heap);
void batch_heap_end(batch_heap *heap);
/// Sets the peak to what is in use now.
void batch_heap_mark(batch_heap *heap);
/// Functions of kiln_context_def; `user` is a batch_heap.
void *batch_allocate(void *user, size_t size);
void batch_release(void *user, void *memory, size_t size);

/// A thread that bakes one environment after the other.
typedef struct batch_worker {
    batch *batch;
    os_thread thread;
    batch_heap heap;
    kiln_context *context;
    cli_work *work; ///< work of the bake in progress, or NULL
    bake_plan plan;
    bool keeps; ///< the plan and free blocks of the last bake are kept for the next one
} batch_worker;

/// A loop of the library whose indices other threads may take.
typedef struct batch_loop {
    struct batch_loop *below;
    void (*task)(void *data, int index);
    void *data;
    int count;
    atomic_int next;
    int helpers; ///< threads that work on the loop besides the one that began it
} batch_loop;

/// The most memory that jobs of one kind and one size of input have used.
typedef struct batch_need {
    uint64_t key;
    int width, height;
    size_t bytes;
} batch_need;

enum { BATCH_NEEDS = 64 };

struct batch {
    // values of the options
    const char *shard_text, *depfile, *stamp;
    int threads, memory;
    bool dry_run, keep_going, force, json, quiet;

    cli_arguments arguments;
    batch_store store;
    batch_lines lines;
    batch_jobs jobs;
    int shard, shard_count; ///< shard number from 0, and the number of shards

    os_mutex mutex;       ///< guards the fields below, except the atomic ones
    os_condition changed; ///< signalled when a job ends, a loop begins or memory is released
    os_condition ended;   ///< signalled when a thread ends
    batch_worker *worker;
    int worker_count, alive; ///< threads that were started, and those that have not ended
    size_t next;             ///< index of the job that is begun next
    int busy;                ///< number of workers that have a job
    bool stopped;            ///< no further job is begun, because one failed
    batch_loop *loop;
    atomic_int idle;    ///< number of workers that could help with a loop
    atomic_int folders; ///< number of folders that were created for outputs

    size_t limit;            ///< bytes that all contexts together may hold
    atomic_size_t held;      ///< bytes that they hold now, with free blocks
    size_t promised;         ///< bytes that the bakes in progress may come to need
    int baking;              ///< number of bakes in progress
    int keepers;             ///< number of workers that keep memory for their next bake
    bool alone;              ///< one bake has all the memory for itself
    unsigned ticket, served; ///< bakes wait for memory in the order of their tickets
    batch_need need[BATCH_NEEDS];
    int need_count;

    os_mutex output; ///< guards what is printed and the fields below
    double began, cpu_began, drawn;
    bool on_terminal;
    size_t done;                ///< number of jobs that have ended
    double weight, done_weight; ///< of all jobs, and of those that have ended
    double worked_weight;       ///< of those that were baked
};

/// Starts the workers, which call `run` for each job, and waits until they have ended. Calls `tick`
/// ten times a second meanwhile. Returns CLI_GO or CLI_FAILED.
int batch_pool_run(batch *all, void (*run)(batch_worker *worker, batch_job *job),
                   void (*tick)(batch *all));
/// Waits until a bake that may need `bytes` fits into the memory, or until nothing else is baked if
/// `alone`. batch_pool_leave ends the bake.
void batch_pool_enter(batch_worker *worker, size_t bytes, bool alone);
void batch_pool_leave(batch_worker *worker, size_t bytes, bool alone);
/// The memory that a bake of an input of this size may need, and what a bake has needed.
size_t batch_pool_need(batch *all, uint64_t key, int width, int height, size_t guess);
void batch_pool_needed(batch *all, uint64_t key, int width, int height, size_t bytes);

// ------------------------------------------------------------------------------------------ report

/// Holds the output of other threads back, clears the progress line, and releases them
/// (cli_work.hold).
void batch_hold(void *user, bool begins);
/// Draws the progress line if it is due.
void batch_draw(batch *all);
/// Counts a job that has ended, and prints what became of it unless its bake has printed the
/// result. `reason` says why a job is due; `problem` is the error message of a job that failed.
void batch_report_job(batch *all, const batch_job *job, batch_reason reason, const char *problem);
/// Prints the result of a bake (bake.report) as one line of JSON.
void batch_report_bake(bake *b);
/// Prints the summary. Returns the exit code.
int batch_report_end(batch *all);
/// Writes the files of --depfile and --stamp. Returns CLI_GO or CLI_FAILED.
int batch_write_depfile(const batch *all);

#endif
