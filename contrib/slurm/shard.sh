#!/bin/sh
# A task of the job array that submit.sh submits: bakes one shard with the cores and the memory of the task, and writes
# the report of kiln batch. A task that is begun again has a report of its own.
#   shard.sh SHARDS REPORTS LIST [OPTION...]
set -eu
shards=$1
report=$2/shard-$SLURM_ARRAY_TASK_ID.${SLURM_RESTART_COUNT:-0}.jsonl
shift 2
[ -z "${SLURM_MEM_PER_NODE:-}" ] || set -- "$@" --memory $((SLURM_MEM_PER_NODE * 3 / 4))
exec "${KILN:-kiln}" batch "$@" --shard "$SLURM_ARRAY_TASK_ID/$shards" --threads "${SLURM_CPUS_ON_NODE:-1}" \
    --keep-going --json >"$report"
