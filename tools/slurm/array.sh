#!/bin/sh
# A bake in parts, one for each job of a Slurm array: sbatch --array 0-31 tools/slurm/array.sh SCENE --gi SPEC -o FILE.safetensors
# With --lightmap DIR instead of -o, and with --spp N, a light map. The last job that ends joins the parts.
#SBATCH --job-name=afterglow
#SBATCH --cpus-per-task=16
#SBATCH --time=04:00:00
#SBATCH --requeue
#SBATCH --open-mode=append
# Two minutes before the time limit, to this script.
#SBATCH --signal=B:USR1@120
set -u
count=${SLURM_ARRAY_TASK_COUNT:-1}
part=$((${SLURM_ARRAY_TASK_ID:-0} - ${SLURM_ARRAY_TASK_MIN:-0}))
folder=${AFTERGLOW_PARTS:-afterglow-parts-${SLURM_ARRAY_JOB_ID:-0}}

# Some options belong to the joined bake, those of light to both, all others to the parts.
joined= options=
quoted() { printf "'%s' " "$(printf '%s' "$1" | sed "s/'/'\\\\''/g")"; }
[ $# -gt 0 ] || { echo "usage: sbatch --array 0-N array.sh SCENE [options of afterglow bake]" >&2; exit 2; }
while [ $# -gt 0 ]; do
    words=$(quoted "$1")
    case $1 in
        -o | --lightmap | --export | --report | --light | --sky | --environment)
            words="$words$(quoted "${2:?"$1 has no value"}")"
            ;;
    esac
    case $1 in
        -o | --export | --report) joined="$joined$words" ;;
        --indirect-only | --denoise) joined="$joined$words" ;;
        --lightmap | --light | --sky | --environment | --no-scene-lights)
            joined="$joined$words"
            options="$options$words"
            ;;
        *) options="$options$words" ;;
    esac
    case $1 in
        -o | --lightmap | --export | --report | --light | --sky | --environment) shift ;;
    esac
    shift
done
case $joined in
    *"'-o'"* | *"'--lightmap'"*) ;;
    *)
        echo "array.sh: -o FILE.safetensors or --lightmap DIR is missing" >&2
        exit 2
        ;;
esac
mkdir -p "$folder"

eval "afterglow bake $options --shard $part/$count -o '$folder/$part.safetensors' &"
bake=$!
again=
stop() {
    again=yes
    kill -USR1 $bake
}
trap stop USR1
trap 'kill -USR1 $bake' TERM
while :; do
    wait $bake
    status=$?
    kill -0 $bake 2>/dev/null || break
done
if [ $status -ne 0 ]; then
    [ "$again" != yes ] || scontrol requeue "${SLURM_ARRAY_JOB_ID}_$SLURM_ARRAY_TASK_ID"
    exit $status
fi

# The folder of the join can be made once.
i=0
while [ $i -lt "$count" ]; do
    [ -f "$folder/$i.safetensors" ] || exit 0
    i=$((i + 1))
done
mkdir "$folder/join" 2>/dev/null || exit 0
eval "afterglow bake --merge '$folder'/*.safetensors $joined" || { rmdir "$folder/join"; exit 1; }
rm -r "$folder"
