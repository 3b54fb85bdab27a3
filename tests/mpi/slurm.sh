#!/bin/sh
# slurm.sh ROOT PROGRAM [MPI_PROGRAM]: the job scripts of tools/slurm, with the variables that Slurm sets and a scontrol that
# writes what it was asked for.
set -eu
scripts=$1/tools/slurm program=$2 shared=${3:-}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
mkdir cache bin
export AFTERGLOW_CACHE="$work/cache" OMP_WAIT_POLICY=passive OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
ln -s "$program" bin/afterglow
[ -z "$shared" ] || ln -s "$shared" bin/afterglow-mpi
printf '#!/bin/sh\necho "$@" >>"%s/requeued"\n' "$work" >bin/scontrol
chmod +x bin/scontrol
export PATH="$work/bin:$PATH"
for script in "$scripts"/*.sh; do
    sh -n "$script"
    grep -q '^#SBATCH --signal=B:USR1@' "$script"
done

fail() {
    echo "$*"
    cat messages
    exit 1
}
scene='@cornell --gi radiosity:density=2'

# The jobs of an array, as they end in any order.
export SLURM_ARRAY_TASK_COUNT=3 SLURM_ARRAY_TASK_MIN=4 SLURM_ARRAY_JOB_ID=77
array() { # WORDS…
    for part in 5 6 4; do
        SLURM_ARRAY_TASK_ID=$part sh "$scripts/array.sh" "$@" 2>messages || fail "part $part failed"
    done
    [ ! -e afterglow-parts-77 ] || fail "the parts are left"
}
# shellcheck disable=SC2086
{
    afterglow bake $scene --quiet -o alone.safetensors
    array $scene -o array.safetensors
    cmp alone.safetensors array.safetensors
    # A light with a blank and a quote in a name would be two words.
    afterglow bake $scene --lightmap alone --spp 8 --quiet --sky 1,2,3 --indirect-only
    array $scene --lightmap 'a folder' --spp 8 --sky 1,2,3 --indirect-only
    cmp alone/irradiance.exr 'a folder/irradiance.exr'
    SLURM_ARRAY_TASK_ID=4 sh "$scripts/array.sh" $scene 2>messages && fail "no output was accepted"
    grep -q 'is missing' messages
}

# Shortly before the time limit.
long='@cornell --gi radiosity:density=20'
# shellcheck disable=SC2086
SLURM_ARRAY_TASK_COUNT=1 SLURM_ARRAY_TASK_ID=4 sh "$scripts/array.sh" $long -o long.safetensors 2>messages &
job=$!
sleep 2
kill -USR1 $job
wait $job && fail "an interrupted part succeeded"
grep -qx 'requeue 77_4' requeued || fail "the part was not queued again"

[ -n "$shared" ] && mpirun --allow-run-as-root -n 1 true 2>/dev/null || { echo "array.sh alone was tried: no MPI"; exit 0; }
rm requeued
# shellcheck disable=SC2086
{
    SLURM_NTASKS=1 SLURM_JOB_ID=78 sh "$scripts/mpi.sh" $scene --force -o mpi.safetensors 2>messages || fail "mpi.sh failed"
    cmp alone.safetensors mpi.safetensors
    SLURM_NTASKS=1 SLURM_JOB_ID=78 sh "$scripts/mpi.sh" $long --force -o long.safetensors 2>messages &
}
job=$!
i=0
while [ ! -f long.safetensors.checkpoint.tasks ] && [ $i -lt 600 ]; do
    sleep 0.1
    i=$((i + 1))
done
kill -USR1 $job
wait $job && fail "an interrupted job succeeded"
grep -qx 'requeue 78' requeued || fail "the job was not queued again"
grep -q 'the same command continues' messages || fail "no sentence"
