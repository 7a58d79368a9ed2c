# keep/farm_parallel.sh  2  renders a picture in parts with GNU parallel, here or on other machines
#
#   bash src/keep/farm_parallel.sh --folder FOLDER -o FILE [options] -- OPTIONS OF PENUMBRA SCENE
#
#     --folder FOLDER   holds the parts and their logs; all machines see it under this path
#     -o FILE           the picture (.png, .pfm or .hdr); may be repeated
#     --stats FILE      measurements, as JSON
#     --bands N         cut the picture into N bands of rows                                       1
#     --seeds N         render each band with N seeds, each with --spp samples                     1
#     --hosts FILE      machines, one ssh name per line (parallel's --sshloginfile)         this one
#     --slots N         parts at a time on each machine, which share its processors                1
#     --retries N       how often a killed part is started                                         3
#     --build FOLDER    has penumbra and merge                                   build/, beside src/
#
# OPTIONS OF PENUMBRA must include --size and --spp.  Rerun the command to resume unfinished parts.
# Exit status: 0 the picture is written, 1 parts are missing, 2 an option cannot be used.
. "$(dirname "${BASH_SOURCE[0]}")/farm.sh"

slots=1 retries=3 words=()
engine_option() {
    case $1 in
        --hosts) [ -r "$2" ] || fail "$2: cannot open"; words+=(--sshloginfile "$2") ;;
        --slots | --retries) count "$1" "$2"; printf -v "${1#--}" %s "$2" ;;
        *) return 1 ;;
    esac
}

case ${1-} in
    -h | --help) usage "$0" ;;
    *)
        command -v parallel >/dev/null || fail "no parallel: install GNU parallel"
        read_words "$@"
        write_plan
        # After a signal to stop, a part has a minute to write its film.  Parallel restarts parts that were killed
        # or lost their machine.  The merge reports parts that penumbra itself refused.
        unfinished "$folder" | parallel --jobs "$slots" --retries "$retries" --termseq TERM,60000,KILL,25 "${words[@]}" \
            "$(printf '%q ' bash "$here/farm.sh" part "$folder") {} \$(((\$(nproc) + $slots - 1) / $slots)) || [ \$? -le 128 ]"
        merge "$folder"
        ;;
esac
