#!/bin/sh
# A bake on all nodes of a Slurm job: sbatch --nodes 8 tools/slurm/mpi.sh SCENE --gi SPEC -o FILE.safetensors
#SBATCH --job-name=afterglow
#SBATCH --ntasks-per-node=1
#SBATCH --exclusive
#SBATCH --time=04:00:00
#SBATCH --requeue
#SBATCH --open-mode=append
# Two minutes before the time limit, to this script.
#SBATCH --signal=B:USR1@120
set -u
[ $# -gt 0 ] || { echo "usage: sbatch mpi.sh SCENE [options of afterglow bake]" >&2; exit 2; }

# One process for each node, with all of its cores.
mpirun -n "${SLURM_NTASKS:-1}" --map-by ppr:1:node afterglow-mpi bake "$@" &
bake=$!

# What is finished is on disk. The job continues with it later.
again=
stop() {
    again=yes
    kill -USR1 $bake
}
trap stop USR1
trap 'kill -TERM $bake' TERM

# A signal ends wait, so it is called until the bake has ended.
while :; do
    wait $bake
    status=$?
    kill -0 $bake 2>/dev/null || break
done
[ "$again" != yes ] || [ $status -eq 0 ] || scontrol requeue "$SLURM_JOB_ID"
exit $status
