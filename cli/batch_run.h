// One environment of kiln batch.
#ifndef KILN_CLI_BATCH_RUN_H
#define KILN_CLI_BATCH_RUN_H

#include "batch.h"

/// Bakes a job, unless its files are what a bake would write, and sets its outcome.
void batch_run_job(batch_worker *worker, batch_job *job);

#endif
