#!/bin/sh
# Bakes a list of environments on a Slurm cluster: a job array of shards, and a job that adds up what they report.
#   submit.sh SHARDS REPORTS LIST [OPTION...]
# SHARDS is the number of shards, REPORTS a folder that is made for their reports, LIST a manifest of kiln batch, and the
# options are those of kiln batch. List, pictures and outputs must have the same paths on all nodes. Options of sbatch
# stand in the variable SBATCH_OPTIONS, such as "--cpus-per-task=16 --mem=32G --partition=night"; KILN is the path of the
# command if it is not in PATH. Prints the numbers of the two jobs.
#
# A shard whose node fails is begun again by Slurm, and bakes what it has not baked before. The same call after a failure
# or after a change of the list bakes what is missing or has changed.
set -eu
[ $# -ge 3 ] || { echo "usage: submit.sh SHARDS REPORTS LIST [OPTION...]" >&2; exit 2; }
here=$(cd "$(dirname "$0")" && pwd)
shards=$1
mkdir -p "$2"
reports=$(cd "$2" && pwd)
shift 2
rm -f "$reports"/shard-*.jsonl

# shellcheck disable=SC2086 # several options
array=$(sbatch --parsable --job-name=kiln --requeue --array="1-$shards" --open-mode=append \
    --output="$reports/shard-%a.log" ${SBATCH_OPTIONS:-} "$here/shard.sh" "$shards" "$reports" "$@")
# shellcheck disable=SC2086
merge=$(sbatch --parsable --job-name=kiln-merge --requeue --dependency="afterany:$array" \
    --output="$reports/summary.txt" ${SBATCH_OPTIONS:-} "$here/merge.sh" "$shards" "$reports")
echo "$array $merge"
