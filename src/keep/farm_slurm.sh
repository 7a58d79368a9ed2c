# keep/farm_slurm.sh  2  renders a picture as a Slurm job array; a second job merges its parts
#
#   bash src/keep/farm_slurm.sh --folder FOLDER -o FILE [options] -- OPTIONS OF PENUMBRA SCENE
#
#     --folder FOLDER   holds the parts and their logs; all machines see it under this path
#     -o FILE           the picture (.png, .pfm or .hdr); may be repeated
#     --stats FILE      measurements, as JSON
#     --bands N         cut the picture into N bands of rows                                       1
#     --seeds N         render each band with N seeds, each with --spp samples                     1
#     --cpus N          processors and threads per part                                            1
#     --sbatch WORD     for sbatch, e.g. --sbatch --partition=long; may be repeated
#     --grace S         seconds before a time limit when a part stops and requeues itself        120
#     --retries N       how often a killed part requeues itself                                    5
#     --build FOLDER    has penumbra and merge                                   build/, beside src/
#
# OPTIONS OF PENUMBRA must include --size and --spp.  Rerun the command to resume unfinished parts.
# Exit status: 0 the jobs were submitted, 1 they could not be, 2 an option cannot be used.
. "$(dirname "${BASH_SOURCE[0]}")/farm.sh"

cpus=1 grace=120 retries=5 words=()
engine_option() {
    case $1 in
        --sbatch) words+=("$2") ;;
        --cpus | --grace) count "$1" "$2"; printf -v "${1#--}" %s "$2" ;;
        --retries) case $2 in '' | *[!0-9]*) fail "--retries '$2' is not a number" ;; esac; retries=$2 ;;
        *) return 1 ;;
    esac
}

# The command of a job, quoted once for its shell.  Signals reach only that shell, hence exec.
job() { printf 'exec bash'; printf ' %q' "$@"; }

submit() {
    local numbers array merger
    [ ! -e "$folder/farm.job" ] || [ -z "$(squeue --noheader --job "$(cat "$folder/farm.job")" 2>/dev/null)" ] ||
        fail "$folder: job $(cat "$folder/farm.job") is still running: wait, or cancel it with scancel"
    numbers=$(unfinished "$folder" | paste -sd,)
    words=(--parsable --requeue --open-mode=append "${words[@]}")
    if [ -n "$numbers" ]; then
        # USR1, not TERM: Slurm also sends TERM to a cancelled job, which must not requeue.
        array=$(sbatch "${words[@]}" --job-name=penumbra --array="$numbers" --cpus-per-task="$cpus" \
            --signal="B:USR1@$grace" --output="$folder/part-%4a.log" \
            --wrap "$(job "$here/farm_slurm.sh" part "$folder" "$retries")") || exit 1
        echo "$array" >"$folder/farm.job"
        # Not afterok: after a failed part the merge would never run, and never report that part.
        words+=(--dependency="afterany:${array%%;*}")
    fi
    merger=$(sbatch "${words[@]}" --job-name=penumbra-merge --output="$folder/merge.log" \
        --wrap "$(job "$here/farm.sh" merge "$folder")") || exit 1
    echo "farm: ${array:+job $array renders parts $numbers, }job $merger merges: $folder/merge.log"
}

# A part on its node.  It requeues itself after a time limit, or if a process other than Slurm killed it.
# Slurm itself requeues parts after preemption or the failure of a node.
part() {  # FOLDER RETRIES
    local status=0 again=''
    render "$1" "$SLURM_ARRAY_TASK_ID" "${SLURM_CPUS_PER_TASK:-1}" || status=$?
    [ "$status" -gt 128 ] || return "$status"
    sleep 1  # Slurm may signal penumbra first, and then this shell
    case $stopped in
        USR1) again=yes ;;
        '') [ "${SLURM_RESTART_COUNT:-0}" -ge "$2" ] || again=yes ;;
    esac
    if [ -n "$again" ]; then
        echo "farm: requeues this part" >&2
        scontrol requeue "$SLURM_JOB_ID" && sleep 60  # and is ended by Slurm
    fi
    return "$status"
}

case ${1-} in
    -h | --help) usage "$0" ;;
    part) part "$2" "$3" ;;
    *)
        command -v sbatch >/dev/null || fail "no sbatch: this machine has no Slurm"
        read_words "$@"
        case $folder in *[%\\]*) fail "--folder: % and \\ have a special meaning in file names of Slurm" ;; esac
        write_plan
        submit
        ;;
esac
