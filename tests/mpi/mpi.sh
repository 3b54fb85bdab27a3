#!/bin/sh
# mpi.sh CASE PROGRAM MPI_PROGRAM: bakes with mpirun. Exit status 77: skipped, with a reason.
set -eu
case=$1 program=$2 shared=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
mkdir cache
export AFTERGLOW_CACHE="$work/cache" OMP_WAIT_POLICY=passive

command -v mpirun >/dev/null || { echo "skipped: no mpirun"; exit 77; }
mpirun --version 2>/dev/null | grep -q 'Open MPI' || { echo "skipped: mpirun is not that of Open MPI"; exit 77; }
# Containers run as root and have fewer cores than ranks. Neither matters outside of tests.
options='--allow-run-as-root --map-by slot:OVERSUBSCRIBE'
# Without ssh there is no other machine to start ranks on, which Open MPI looks for.
export OMPI_MCA_plm_rsh_agent=false PRTE_MCA_plm_ssh_agent=false
ranks() { # COUNT WORDS…
    count=$1
    shift
    # shellcheck disable=SC2086 # a list of words
    timeout 240 mpirun $options -n "$count" "$shared" "$@"
}
# shellcheck disable=SC2086
timeout 60 mpirun $options -n 2 true 2>messages || { cat messages; echo "skipped: mpirun cannot start two processes here"; exit 77; }

fail() {
    echo "$*"
    [ ! -f messages ] || cat messages
    exit 1
}
says() { grep -q -- "$1" messages || fail "no message says: $1"; }
sentences() { # COUNT: of the program, which are not notes of mpirun
    [ "$(grep -c '^afterglow: ' messages)" = "$1" ] || fail "not $1 sentences"
}
same() { cmp "$1" "$2" || fail "$1 and $2 differ"; }

# Some seconds of work in tasks of tens of milliseconds.
long='@cornell --gi radiosity:density=10,probes=true -o long.safetensors --quiet'
alone() {
    # shellcheck disable=SC2086
    "$program" bake $long --force
    mv long.safetensors wanted.safetensors
}
# Waits until the journal of the file $2 has $1 bytes, a minute at most.
wait_for_results() {
    i=0
    journal=${2:-long.safetensors}.checkpoint.tasks
    while [ $i -lt 600 ]; do
        [ ! -f "$journal" ] || [ "$(wc -c <"$journal")" -lt "$1" ] || return 0
        sleep 0.1
        i=$((i + 1))
    done
    fail "no results came"
}
# The process of a rank: its environment tells.
process_of() {
    for folder in /proc/[0-9]*; do
        [ "$(readlink "$folder/exe" 2>/dev/null)" = "$(readlink -f "$shared")" ] || continue
        tr '\0' '\n' <"$folder/environ" >environment 2>/dev/null || continue
        grep -qxF "AFTERGLOW_CACHE=$work/cache" environment || continue
        ! grep -qx "OMPI_COMM_WORLD_RANK=$1" environment || echo "${folder#/proc/}"
    done
}
finished_tasks() { sed -n 's/.*checkpoint: \([0-9]*\) of [0-9]* tasks are finished/\1/p' messages; }
# The next run has what was on disk, and its file is that of one process.
resumes() {
    # shellcheck disable=SC2086
    ranks 2 bake ${long% --quiet} --verbose >/dev/null 2>messages || fail "the next run failed"
    [ "$(finished_tasks)" -gt 0 ] || fail "the next run did not continue"
    same wanted.safetensors long.safetensors
    [ ! -e long.safetensors.checkpoint ] && [ ! -e long.safetensors.checkpoint.tasks ] || fail "a checkpoint is left"
}

ranks 2 --version >version 2>messages || fail "no version"
[ "$(wc -l <version)" = 1 ] || fail "not only rank 0 prints"

case $case in
same_bytes)
    bake() { # NAME WORDS…
        name=$1
        shift
        "$program" bake "$@" --force --quiet -o "$name-0.safetensors"
        for count in 1 2 3 4; do
            ranks $count bake "$@" --force --quiet -o "$name-$count.safetensors" 2>messages || fail "$name with $count ranks failed"
            same "$name-0.safetensors" "$name-$count.safetensors"
        done
    }
    bake radiosity @cornell --gi radiosity:density=2
    bake prt @cornell --gi prt:density=1,rays=64
    "$program" bake @cornell --gi radiosity:density=3 --lightmap maps-0 --spp 16 --quiet
    for count in 1 2 3 4; do
        rm -rf cache
        mkdir cache
        ranks $count bake @cornell --gi radiosity:density=3 --lightmap maps-$count --spp 16 --quiet 2>messages ||
            fail "the light map with $count ranks failed"
        same maps-0/irradiance.exr maps-$count/irradiance.exr
        same maps-0/scene.glb maps-$count/scene.glb
    done
    # The samples of a reference, of tiles that the image cuts.
    "$program" reference @cornell --size 50x37 --spp 20 --quiet -o image-0.exr
    for count in 1 2 3 4; do
        ranks $count reference @cornell --size 50x37 --spp 20 --quiet -o image-$count.exr 2>messages ||
            fail "the reference with $count ranks failed"
        same image-0.exr image-$count.exr
        [ ! -e image-$count.exr.checkpoint ] && [ ! -e image-$count.exr.checkpoint.tasks ] || fail "a checkpoint is left"
    done
    # From the cache, which only rank 0 reads.
    ranks 2 bake @cornell --gi radiosity:density=3 --lightmap maps-5 --spp 16 2>messages || fail "the cached light map failed"
    same maps-0/irradiance.exr maps-5/irradiance.exr
    "$program" bake @cornell --gi radiosity:density=6 --lightmap pages-0 --spp 4 --page 64 --quiet
    rm -rf cache
    mkdir cache
    ranks 3 bake @cornell --gi radiosity:density=6 --lightmap pages-3 --spp 4 --page 64 --quiet 2>messages || fail "the pages failed"
    for file in irradiance.0.exr irradiance.1.exr scene.glb; do same pages-0/$file pages-3/$file; done
    ;;
killed)
    alone
    for rank in 0 2; do
        for bytes in 1 2000000; do
            rm -f long.safetensors*
            # shellcheck disable=SC2086
            ranks 3 bake $long --force >/dev/null 2>messages &
            run=$!
            victim=
            while [ -z "$victim" ] && kill -0 $run; do victim=$(process_of $rank); done
            wait_for_results $bytes
            kill -9 "$victim"
            wait $run && fail "a run whose rank $rank was killed succeeded"
            resumes
        done
    done
    # A reference, whose results go on from the journal, too.
    image='@atrium --size 320x180 --spp 64 -o image.exr'
    # shellcheck disable=SC2086
    "$program" reference ${image%image.exr}wanted.exr --quiet
    # shellcheck disable=SC2086
    ranks 3 reference $image --quiet >/dev/null 2>messages &
    run=$!
    victim=
    while [ -z "$victim" ] && kill -0 $run; do victim=$(process_of 1); done
    wait_for_results 500000 image.exr
    kill -9 "$victim"
    wait $run && fail "a reference whose rank 1 was killed succeeded"
    # shellcheck disable=SC2086
    ranks 2 reference $image --verbose >/dev/null 2>messages || fail "the next reference failed"
    [ "$(finished_tasks)" -gt 0 ] || fail "the next reference did not continue"
    same wanted.exr image.exr
    ;;
signals)
    alone
    for signal in TERM USR1 INT; do
        rm -f long.safetensors*
        # shellcheck disable=SC2086
        mpirun $options -n 3 "$shared" bake $long --force >/dev/null 2>messages &
        run=$!
        wait_for_results 2000000
        kill -$signal $run
        wait $run && fail "a run that was interrupted by SIG$signal succeeded"
        says 'interrupted; the same command continues'
        sentences 1
        resumes
    done
    ;;
full_disk)
    alone
    rm -f long.safetensors*
    # No file of a rank may grow beyond 5 MB; messages by TCP, since shared memory is a file, too.
    # shellcheck disable=SC2086
    timeout 240 mpirun $options --mca btl self,tcp -n 3 sh -c 'ulimit -f 10000; exec "$@"' sh "$shared" bake $long --force >/dev/null 2>messages &&
        fail "a run on a full disk succeeded"
    says 'cannot keep finished tasks in .*: File too large; make room: the same command continues'
    sentences 1
    resumes
    ;;
refused)
    # COUNT OTHERS LAST: the commands of the last rank and of those before it. One program for all: mpirun
    # of Open MPI 5.0.7 crashes where it starts several.
    unlike() {
        # shellcheck disable=SC2086
        timeout 240 mpirun $options -n "$1" sh -c "if [ \$OMPI_COMM_WORLD_RANK = $(($1 - 1)) ]; then $3; else $2; fi" >/dev/null 2>messages
    }
    pair() { unlike 3 "exec '$shared' bake $1" "exec '$shared' bake $2" && fail "unlike ranks were accepted" || true; }
    pair "@cornell --gi radiosity:density=2 -o a.safetensors" "@cornell --gi radiosity:density=3 -o a.safetensors"
    says 'rank 2 was given "radiosity:density=3" where rank 0 was given "radiosity:density=2"'
    sentences 1
    pair "@cornell --gi radiosity:density=2 -o a.safetensors" "@cornell --gi radiosity:density=2 -o a.safetensors --seed 3"
    says 'rank 2 was given "--seed" where rank 0 was given ""'
    sentences 1
    # The same name, other content, as on machines without a common file system.
    mkdir here there
    "$program" bake @cornell --gi radiosity:density=2 --lightmap exported --quiet --spp 1
    "$program" bake @diagonal --gi radiosity:density=2 --lightmap other --quiet --spp 1
    cp exported/scene.glb here/scene.glb
    cp other/scene.glb there/scene.glb
    of_scene="exec '$shared' bake scene.glb --gi radiosity:density=2 -o a.safetensors --quiet"
    unlike 2 "cd '$work/here'; $of_scene" "cd '$work/there'; $of_scene" && fail "unlike scenes were accepted"
    says 'rank 1 has another \(scene\|number of tasks\)'
    # A rank without the file.
    rm there/scene.glb
    unlike 2 "cd '$work/here'; $of_scene" "cd '$work/there'; $of_scene" && fail "a rank without the scene was accepted"
    says 'rank 1: cannot read scene.glb'
    sentences 1
    ranks 2 render @cornell >/dev/null 2>messages && fail "render runs on several ranks"
    says 'cannot run render on 2 ranks: only bake and reference work on several'
    sentences 1
    ranks 2 reference @cornell --resume -o a.exr >/dev/null 2>messages && fail "--resume is shared"
    says 'cannot use --resume with afterglow-mpi'
    sentences 1
    ranks 2 bake @cornell --gi radiosity --shard 0/2 -o a.safetensors >/dev/null 2>messages && fail "parts are shared"
    says 'cannot use --shard with afterglow-mpi'
    sentences 1
    ;;
*) echo "unknown case $case"; exit 1 ;;
esac
