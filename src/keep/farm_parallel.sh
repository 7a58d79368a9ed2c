# keep/farm_parallel.sh  2  renders a picture in parts by GNU parallel, here or on other machines
#
#   bash src/keep/farm_parallel.sh --folder FOLDER -o FILE [options] -- OPTIONS OF PENUMBRA SCENE
#
#     --folder FOLDER   for the parts and their logs; all machines see it under this name
#     -o FILE           the picture, .pfm or .png; may be repeated
#     --stats FILE      what was measured, as JSON
#     --bands N         cut the picture into N bands of rows                                       1
#     --seeds N         render each band by N seeds, each with --spp samples                         1
#     --hosts FILE      machines, one per line, as ssh knows them (parallel's --sshloginfile)   this one
#     --slots N         parts at a time on each machine, which share its processors                1
#     --retries N       how often a part is begun that is killed                                     3
#     --build FOLDER    where penumbra and merge are                                 build/, beside src/
#
# OPTIONS OF PENUMBRA include --size and --spp.  The same command again resumes unfinished parts.
# Exit status: 0 the picture is there, 1 parts are missing, 2 an option cannot be used.
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
        # A part that gets a signal to stop has a minute to write its film.  Parts that were killed, or that lost
        # their machine, are restarted.  The merge reports parts that penumbra itself refused.
        unfinished "$folder" | parallel --jobs "$slots" --retries "$retries" --termseq TERM,60000,KILL,25 "${words[@]}" \
            "$(printf '%q ' bash "$here/farm.sh" part "$folder") {} \$(((\$(nproc) + $slots - 1) / $slots)) || [ \$? -le 128 ]"
        merge "$folder"
        ;;
esac
