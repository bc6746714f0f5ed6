#!/bin/sh
# A Slurm cluster of two nodes on this machine: contrib/slurm bakes 64 environments in eight shards while a node dies.
# Everything is baked, to the bytes of one machine, and nothing twice but what the lost shard had not recorded.
#   cluster.sh KILN
# Exits with 77 where the cluster cannot be started, after a sentence that says why.
set -eu
here=$(cd "$(dirname "$0")/../.." && pwd)
KILN=$1
export KILN
ENVIRONMENTS=64
SHARDS=8
work=$(mktemp -d)
pids=

# mine PATTERN: the processes whose command lines name this test's folder and match the pattern.
mine() { pgrep -f -- "$work/.*$1" || true; }
parent() { ps -o ppid= -p "$1" 2>/dev/null || true; }

finish() {
    for pid in $pids; do
        kill -TERM "$pid" 2>/dev/null || true
    done
    for pid in $pids; do
        for wait in 1 2 3 4 5 6 7 8 9 10; do
            kill -0 "$pid" 2>/dev/null || break
            [ "$wait" != 10 ] || kill -KILL "$pid" 2>/dev/null || true
            sleep 0.1
        done
    done
    # Jobs outlive their daemon.
    for pid in $(mine ' --shard '); do
        kill -KILL "$(parent "$pid")" "$pid" 2>/dev/null || true
    done
    cd /
    rm -rf "$work"
}
trap finish EXIT
trap 'exit 1' HUP INT TERM

die() {
    printf 'FAILED: %s\n' "$*"
    squeue -a 2>/dev/null || true
    sinfo 2>/dev/null || true
    tail -n 20 "$work"/log/* 2>/dev/null || true
    exit 1
}
cannot() {
    printf 'The cluster cannot be started here, so nothing was tested: %s\n' "$*"
    exit 77
}
# until_true SECONDS COMMAND...: waits until a command succeeds.
until_true() {
    tries=$(($1 * 10))
    shift
    until "$@" >"$work/tried" 2>&1; do
        tries=$((tries - 1))
        [ $tries -gt 0 ] || return 1
        sleep 0.1
    done
}

for program in munged slurmctld slurmd sbatch squeue scontrol; do
    command -v $program >/dev/null || cannot "$program is missing"
done
[ "$(id -u)" = 0 ] || cannot "the daemons of Slurm run as root"

# The daemons, with keys, sockets, ports and states of their own.
mkdir -p "$work/log" "$work/munge" "$work/state"
chmod 711 "$work"
chmod 755 "$work/munge"
dd if=/dev/urandom of="$work/munge/key" bs=128 count=1 2>/dev/null
chmod 400 "$work/munge/key"
munged --force --foreground --socket="$work/munge/socket" --key-file="$work/munge/key" --pid-file="$work/munge/pid" \
    --seed-file="$work/munge/seed" --log-file="$work/log/munged" >"$work/log/munged.out" 2>&1 &
pids="$!"
until_true 10 test -S "$work/munge/socket" || cannot "munged: $(cat "$work/log/munged.out")"

port=$((20000 + $$ % 20000))
cat >"$work/slurm.conf" <<CONF
ClusterName=kiln
SlurmctldHost=$(uname -n)(127.0.0.1)
SlurmctldPort=$port
SlurmUser=root
AuthType=auth/munge
AuthInfo=socket=$work/munge/socket
CredType=cred/munge
StateSaveLocation=$work/state
SlurmdSpoolDir=$work/spool.%n
SlurmctldPidFile=$work/ctld.pid
SlurmdPidFile=$work/%n.pid
SlurmctldLogFile=$work/log/slurmctld
SlurmdLogFile=$work/log/%n
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/linear
SchedulerType=sched/backfill
SchedulerParameters=bf_interval=1,sched_interval=1,sched_min_interval=100000
SlurmdParameters=config_overrides
SlurmdTimeout=4
MessageTimeout=2
KillWait=1
InactiveLimit=0
MinJobAge=300
ReturnToService=2
JobRequeue=1
MailProg=/bin/true
NodeName=n1 NodeAddr=127.0.0.1 NodeHostname=$(uname -n) Port=$((port + 1)) CPUs=1 State=UNKNOWN
NodeName=n2 NodeAddr=127.0.0.1 NodeHostname=$(uname -n) Port=$((port + 2)) CPUs=1 State=UNKNOWN
PartitionName=all Nodes=n1,n2 Default=YES MaxTime=INFINITE State=UP
CONF
SLURM_CONF=$work/slurm.conf
export SLURM_CONF
slurmctld -D -f "$SLURM_CONF" >"$work/log/ctld.out" 2>&1 &
pids="$pids $!"
until_true 15 scontrol ping || cannot "slurmctld: $(tail -n 3 "$work/log/slurmctld" "$work/log/ctld.out")"
slurmd -D -N n1 -f "$SLURM_CONF" >"$work/log/n1.out" 2>&1 &
pids="$pids $!"
slurmd -D -N n2 -f "$SLURM_CONF" >"$work/log/n2.out" 2>&1 &
second=$!
pids="$pids $second"
both_idle() { [ "$(sinfo -h -o %D -t idle)" = 2 ]; }
until_true 20 both_idle || cannot "slurmd: $(sinfo; tail -n 3 "$work/log/n1" "$work/log/n2")"

# The library: a list of 64 environments, and what one machine makes of it.
cd "$work"
mkdir in out want
number=0
while [ $number -lt $ENVIRONMENTS ]; do
    "$KILN" sky -o in/$number.exr --size 32 --elevation $((number + 5)) --azimuth $((5 * number)) -q
    echo "{\"input\": \"$work/in/$number.exr\", \"output\": \"$work/FOLDER/$number.ktx2\", \"exposure\": -8, \"size\": 128, \"format\": \"bc6h\"}"
    number=$((number + 1))
done >list
sed 's/FOLDER/want/' list >want.jsonl
sed 's/FOLDER/out/' list >out.jsonl
"$KILN" batch want.jsonl -q || die "one machine"

jobs=$("$here/contrib/slurm/submit.sh" $SHARDS reports "$work/out.jsonl") || die "submit.sh"
array=${jobs% *}
merge=${jobs#* }
# A shard on the second node has baked something and is not at its end: now the node dies, the daemon with everything
# that it runs.
report=
in_the_middle() {
    task=$(squeue -h -r -j "$array" -w n2 -t running -o %K)
    report=reports/shard-$task.0.jsonl
    baked=$(grep -c '"outcome": "baked"' "$report")
    [ "$baked" -ge 1 ] && [ "$baked" -le 5 ]
}
until_true 60 in_the_middle || die "no shard was seen in the middle of its work on the second node"
# Between the daemon and the shard is the step.
family=$second
for pid in $(mine " --shard $task/"); do
    family="$family $pid $(parent "$pid")"
done
# shellcheck disable=SC2086 # several processes
kill -KILL $family
lost=$(grep -c '"outcome": "baked"' "$report")
echo "the second node died while it baked shard $task of $SHARDS, $lost of $((ENVIRONMENTS / SHARDS)) environments baked"
[ "$lost" -lt $((ENVIRONMENTS / SHARDS)) ] || die "the shard had ended before the node died"

ended() { [ -z "$(squeue -h -j "$array,$merge")" ]; }
died=$(date +%s)
# Slurm finds that the node is dead, and lets a job that is begun again wait for two minutes, which are cut short here.
waits() { squeue -h -r -j "$array" -t pending -o %r | grep -q BeginTime; }
until_true 60 waits || die "the lost shard is not begun again"
scontrol update "JobId=${array}_$task" StartTime=now || die "the lost shard cannot begin now"
until_true 90 ended || die "the jobs do not end"
echo "everything ended $(($(date +%s) - died)) s after that"
[ "$(sinfo -h -n n2 -o %t)" = "down*" ] || die "the second node is not down"
cat reports/summary.txt
grep -q "^$ENVIRONMENTS environments in $SHARDS shards: " reports/summary.txt || die "other counts than $ENVIRONMENTS"
grep -q ' 0 failed; ' reports/summary.txt || die "an environment failed"
! grep -q 'have not ended' reports/summary.txt || die "a shard has not ended"
[ -s "reports/shard-$task.1.jsonl" ] || die "Slurm has not begun the lost shard again"

# The bytes, and how often each environment was baked: those of the lost shard once more at most, which is the one that
# was being written.
diff -r -x .kiln want out || die "other bytes than one machine's"
cat reports/shard-*.jsonl | sed -n 's/^{"outcome": "baked".*"path": "\([^"]*\)".*/\1/p' | sort >baked
[ "$(sort -u baked | wc -l)" = $ENVIRONMENTS ] || die "$(sort -u baked | wc -l) environments were baked"
uniq -d baked >twice
[ "$(wc -l <twice)" -le 1 ] || die "baked twice: $(cat twice)"
while read -r path; do
    grep -q "$path" "$report" || die "$path was baked twice, which was not in the lost shard"
done <twice
kept=$(sed -n 's/.*"kept": \([0-9]*\).*/\1/p' "reports/shard-$task.1.jsonl")
[ "$kept" -ge $((lost - 1)) ] || die "the lost shard kept $kept of $lost environments"
echo "shard $task began again, kept $kept environments and baked the others; $(wc -l <twice) was baked twice"
# Once more: there is nothing to bake, and the reports say so.
"$here/contrib/slurm/submit.sh" $SHARDS again "$work/out.jsonl" >again.txt
array=$(cut -d ' ' -f 1 again.txt)
merge=$(cut -d ' ' -f 2 again.txt)
until_true 60 ended || die "the second round does not end"
grep -q "^$ENVIRONMENTS environments in $SHARDS shards: 0 baked, 0 failed" again/summary.txt || die "$(cat again/summary.txt)"
echo "64 environments on two nodes, one of which died: the bytes of one machine"
