// The memory that Linux's control groups allow this process.
#ifndef KILN_CLI_CGROUP_H
#define KILN_CLI_CGROUP_H

#include <stddef.h>

/// Returns the smallest memory limit in bytes of the control groups that this process is in, or 0
/// where no group limits the memory or the system has no such groups. `root` stands before every
/// path that is read: "" for the system's own files.
size_t cgroup_memory_limit(const char *root);

#endif
