# keep/farm.sh  1  a picture in parts on many machines: plans it, renders one part, merges all
#
#   bash src/keep/farm.sh plan --folder FOLDER -o FILE [options] -- OPTIONS OF PENUMBRA SCENE
#   bash src/keep/farm.sh part FOLDER NUMBER [THREADS]   renders a part; resumes its film if there is one
#   bash src/keep/farm.sh merge FOLDER                   merges the parts, or lists those that are missing
#
# farm_slurm.sh and farm_parallel.sh call these three; their --help lists the options.  Any other engine can
# call them, too.  FOLDER holds all files of a farm: farm.plan (the picture and its parts), part-N.film and
# part-N.log, N from 1.
set -u
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)

fail() { echo "farm: $*" >&2; exit 2; }

# A path that means the same in every folder.
absolute() { case $1 in /*) printf '%s' "$1" ;; *) printf '%s/%s' "$PWD" "$1" ;; esac; }

# Values of a key of the plan, one per line.
planned() { sed -n "s/^$2 //p" "$1/farm.plan"; }  # FOLDER KEY

film() { printf '%s/part-%04d.film' "$1" "$2"; }  # FOLDER NUMBER
log()  { printf '%s/part-%04d.log' "$1" "$2"; }

# The head of a film is text, up to an empty line.
finished() {  # FOLDER NUMBER
    [ -e "$(film "$1" "$2")" ] && [ "$(LC_ALL=C sed -n '/^$/q; s/^complete //p' "$(film "$1" "$2")")" = yes ]
}

# Numbers of unfinished parts, one per line.
unfinished() {  # FOLDER
    for number in $(seq "$(count_of_parts "$1")"); do finished "$1" "$number" || echo "$number"; done
}
count_of_parts() { planned "$1" part | wc -l; }  # FOLDER

# ---- The plan -----------------------------------------------------------------------------------

# Part I of N of 0 .. COUNT - 1, as FIRST-LAST.
range() { echo "$(($3 * $1 / $2))-$(($3 * ($1 + 1) / $2 - 1))"; }  # I N COUNT

# Lines of the plan: bands from the top, each with all seeds.
parts() {  # HEIGHT BANDS SEEDS
    local band seed
    for ((band = 0; band < $2; ++band)); do
        for ((seed = 0; seed < $3; ++seed)); do
            printf 'part --rows %s%s\n' "$(range "$band" "$2" "$1")" "$([ "$3" = 1 ] || echo " --seed $seed")"
        done
    done
}

count() {  # OPTION VALUE
    case $2 in '' | 0* | *[!0-9]*) fail "$1 '$2' is not a number of 1 or more" ;; esac
}

# An engine with its own options reads one, and returns 0.
engine_option() { return 1; }

# Reads a farm's words into global variables.
read_words() {
    folder='' bands=1 seeds=1 program=$here/../../build size='' spp=''
    outputs=() options=()
    while [ $# -gt 0 ] && [ "$1" != -- ]; do
        [ $# -gt 1 ] || fail "$1: needs a value"
        case $1 in
            --folder) folder=$(absolute "$2") ;;
            --bands) count "$1" "$2"; bands=$2 ;;
            --seeds) count "$1" "$2"; seeds=$2 ;;
            --build) program=$2 ;;
            -o | --output) outputs+=(-o "$(absolute "$2")") ;;
            --stats) outputs+=("$1" "$(absolute "$2")") ;;
            *) engine_option "$1" "$2" || fail "$1: not a farm option; options of penumbra follow --" ;;
        esac
        shift 2
    done
    [ $# -gt 1 ] || fail "missing -- OPTIONS OF PENUMBRA SCENE"
    shift
    while [ $# -gt 1 ]; do
        case $1 in --*=*) set -- "${1%%=*}" "${1#*=}" "${@:2}" ;; esac
        [ "$1" != --samples ] || set -- --spp "${@:2}"
        case $1 in
            --rows | --keep | --threads | -o | --output | --stats) fail "$1: the farm sets it for every part" ;;
            --seed) [ "$seeds" = 1 ] || fail "$1: --seeds $seeds sets it for every part" ;;
            --size) size=$2 ;;
            --spp) spp=$2 ;;
        esac
        options+=("$1"); shift
    done
    scene=$(absolute "$1")
    program=$(cd "$program" 2>/dev/null && pwd) || fail "--build: no such folder"
    check_words
    check_render
}

check_words() {
    local at='^[1-9][0-9]*x[1-9][0-9]*$' which
    [ -n "$folder" ] || fail "--folder FOLDER is missing: one that all machines share"
    [[ $size =~ $at ]] || fail "--size WxH is missing after --"
    count --spp "$spp"
    [ "$bands" -le "${size#*x}" ] || fail "--bands $bands: the picture has ${size#*x} rows"
    [ ${#outputs[@]} -gt 0 ] || fail "-o FILE is missing"
    for ((which = 0; which < ${#outputs[@]}; which += 2)); do
        case ${outputs[which]}${outputs[which + 1]} in
            -o*.pfm | -o*.png | -o*.hdr | --stats*) ;;
            *) fail "-o ${outputs[which + 1]}: must end in .png, .pfm or .hdr" ;;
        esac
        [ -d "$(dirname "${outputs[which + 1]}")" ] || fail "${outputs[which + 1]}: there is no such folder"
    done
    for which in penumbra merge; do
        [ -x "$program/$which" ] || fail "$program/$which: build it first: make programs"
    done
    case "$folder ${outputs[*]} ${options[*]} $scene" in *$'\n'*) fail "a word contains a line break" ;; esac
}

# Renders one sample of one row, so that wrong options fail here and not on a hundred machines.
check_render() {
    local words=("${options[@]}") i
    for ((i = 0; i < ${#words[@]}; ++i)); do [ "${words[i]}" != --spp ] || words[i + 1]=1; done
    mkdir -p "$folder" && rm -f "$folder/check.film" || exit 1
    "$program/penumbra" "${words[@]}" --rows 0-0 --keep "$folder/check.film" --quiet "$scene" || exit
    # The plan holds a checksum of the scene, not only its name.
    sum=$(LC_ALL=C sed -n '/^$/q; s/^scene //p' "$folder/check.film" 2>/dev/null)
    rm -f "$folder/check.film"
}

# Writes the plan into the folder, unless the same plan is there.
write_plan() {
    local plan
    plan=$(echo "penumbra farm 2"
           printf 'build %s\n' "$program"
           printf 'option %s\n' "${options[@]}"
           printf 'scene %s\n' "$scene"
           printf 'sum %s\n' "$sum"
           printf 'output %s\n' "${outputs[@]}"
           parts "${size#*x}" "$bands" "$seeds")
    if [ -e "$folder/farm.plan" ]; then
        [ "$plan" = "$(cat "$folder/farm.plan")" ] ||
            fail "$folder: holds the parts of another picture: choose another --folder"
        return
    fi
    printf '%s\n' "$plan" >"$folder/farm.plan.new" && mv "$folder/farm.plan.new" "$folder/farm.plan" || exit 1
}

# The comment at the head of a script, from its command on.
usage() { sed -n '3,/^[^#]/ { s/^# \{0,1\}//p; }' "$1"; }

# ---- One part -----------------------------------------------------------------------------------

# Runs penumbra to its end, and returns its exit status.  Passes on signals to stop, so that it writes its
# film.  `stopped` names the last signal.
stopped=''
render() {  # FOLDER NUMBER THREADS
    local words child='' status=0 caught
    mapfile -t words < <(planned "$1" option)
    pass() {
        stopped=$1 caught=1
        echo "farm: stopping after signal $1" >&2
        [ -z "$child" ] || kill -TERM "$child" 2>/dev/null
    }
    for signal in TERM INT HUP USR1; do trap "pass $signal" "$signal"; done
    [ ! -e "$(film "$1" "$2")" ] || echo "farm: resuming from its film" >&2
    # shellcheck disable=SC2046  # a part consists of options without blanks
    "$(planned "$1" build)/penumbra" "${words[@]}" $(planned "$1" part | sed -n "$2p") --threads "$3" \
        --keep "$(film "$1" "$2")" "$(planned "$1" scene)" &
    child=$!
    [ -z "$stopped" ] || kill -TERM "$child"
    # A signal ends the wait, not penumbra.
    while caught='' status=0; wait "$child" 2>/dev/null || status=$?; [ -n "$caught" ]; do :; done
    [ "$status" -le 128 ] || [ -n "$stopped" ] || echo "farm: signal $((status - 128)) ended penumbra" >&2
    return "$status"
}

# ---- The merge ----------------------------------------------------------------------------------

merge() {  # FOLDER
    local words films=() missing number
    missing=$(unfinished "$1")
    for number in $missing; do
        echo "farm: $(film "$1" "$number"): not finished ($(planned "$1" part | sed -n "${number}p")):" \
            "$(tail -n 1 "$(log "$1" "$number")" 2>/dev/null)" >&2
    done
    if [ -n "$missing" ]; then
        echo "farm: $(echo "$missing" | wc -l) of $(count_of_parts "$1") parts are missing; no picture was written." \
            "Run the same command again to render only these" >&2
        return 1
    fi
    for number in $(seq "$(count_of_parts "$1")"); do films+=("$(film "$1" "$number")"); done
    mapfile -t words < <(planned "$1" output)
    "$(planned "$1" build)/merge" "${words[@]}" "${films[@]}"
}

[ "${BASH_SOURCE[0]}" = "$0" ] || return 0
case "${1-} $#" in
    plan*) shift; read_words "$@"; write_plan ;;
    'part 3' | 'part 4') render "$2" "$3" "${4:-$(nproc)}" >>"$(log "$2" "$3")" 2>&1 ;;
    'merge 2') merge "$2" ;;
    *) usage "$0"; exit 2 ;;
esac
