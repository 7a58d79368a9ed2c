# farm/cases.sh  the cases of farms; the first line of each is its description

size=${SIZE:-128x96} spp=${SPP:-512} scene=${SCENE:-$here/scenes/cornell36.scene}
resumed='^farm: resuming from its film'
. src/keep/farm.sh  # functions for a folder's parts

# The picture that a farm renders; $whole is that of one render.  Replications are fixed: adaptive ones
# of a band depend only on its own rows.
picture_of() {  # SAMPLES
    picture=(--size "$size" --replications 2 --spp "$1" "$scene") whole=$work/whole-$1.pfm
    [ -e "$whole" ] || "$build/penumbra" -o "$whole" --quiet "${picture[@]}"
}
# Each of four bands takes longer than ten seconds, when a film is first written.
longer() { picture_of $((16 * spp)); }

# ---- By Slurm -----------------------------------------------------------------------------------

# Submits the farm; $job is the array, $merge_job the job after it.
by_slurm() {  # OPTION...
    local status=0
    bash src/keep/farm_slurm.sh --folder "$folder" --build "$build" -o "$folder.pfm" "$@" -- "${picture[@]}" \
        >"$folder.out" 2>"$folder.err" || status=$?
    job=$(sed -n 's/^farm: job \([0-9]*\) renders.*/\1/p' "$folder.out")
    merge_job=$(sed -n 's/.*job \([0-9]*\) merges.*/\1/p' "$folder.out")
    [ -n "$merge_job" ] || { bad "submitting: exit status $status"; sed 's/^/        /' "$folder.err" >&2; }
    return $status
}

merged() { await "${1:-900}" "the merge, job $merge_job" ended "$merge_job"; }
merge_failed() { [ "$(state_of "$merge_job")" = FAILED ] || bad "the merge: $(state_of "$merge_job")"; }

# Prints a part that runs and has a film, but is not complete.
in_mid_run() {
    local number
    for number in $(parts_in "$job" RUNNING); do
        [ -n "$(process_of "$number")" ] && [ -e "$(film "$folder" "$number")" ] || continue
        ! finished "$folder" "$number" || continue
        part=$number
        return 0
    done
    return 1
}
await_mid_run() { await 120 'a part has a film and runs on' in_mid_run; }

process_of() { pgrep -f -- "penumbra .*--keep $(film "$folder" "$1")"; }  # NUMBER
kill_part() { kill -9 "$(process_of "$1")" || bad "part $1 does not run"; }

case_slurm_whole() {
    : "bands by a job array, merged by the job behind it"
    by_slurm --bands 6 --stats "$folder.json" || return
    merged && is_right "$folder.pfm"
    [ -e "$folder.json" ] || bad "no statistics"
}

case_slurm_seeds() {
    : "bands by several seeds"
    by_slurm --bands 2 --seeds 3 --cpus 2 || return
    local seed
    for seed in 0 1 2; do
        "$build/penumbra" --quiet --keep "$work/$seed.film" -o "$work/$seed.pfm" --seed $seed "${picture[@]}"
    done
    whole=$work/seeds.pfm
    "$build/merge" --quiet -o "$whole" "$work"/[012].film
    merged && is_right "$folder.pfm"
}

case_slurm_requeued() {
    : "parts are taken from the node in mid-run (scontrol requeue), and go on from their films"
    longer
    by_slurm --bands 4 || return
    local went_on=()
    for time in 1 2; do
        await_mid_run && scontrol requeue "${job}_$part" || return
        await 60 "part $part waits" eval '! [ "$(process_of $part)" ]' || return
        went_on+=("$part")
    done
    merged && is_right "$folder.pfm"
    for part in "${went_on[@]}"; do says "$(log "$folder" "$part")" "$resumed"; done
}

case_slurm_killed() {
    : "penumbra is killed in mid-run (kill -9), three times"
    longer
    by_slurm --bands 4 || return
    local killed=()
    for time in 1 2 3; do
        await_mid_run && kill_part "$part" || return
        killed+=("$part")
        await 60 "part $part queues again" queued_again "$time" || return
    done
    merged && is_right "$folder.pfm"
    for part in "${killed[@]}"; do says "$(log "$folder" "$part")" "$resumed"; done
}
queued_again() { [ "$(cat "$folder"/part-*.log | grep -c '^farm: requeues this part')" = "$1" ]; }  # TIMES

case_slurm_killed_for_good() {
    : "one part is killed as often as it runs: the merge names it; the same command again renders it alone"
    longer
    by_slurm --bands 4 --retries 1 || return
    await_mid_run || return
    local victim=$part
    for time in 1 2; do
        await 60 "part $victim runs" eval '[ "$(process_of $victim)" ]' && sleep 1 && kill_part "$victim" || return
        await 30 "part $victim has ended" eval '! [ "$(process_of $victim)" ]' || return
    done
    merged && merge_failed
    is_absent "$folder.pfm"
    says "$folder/merge.log" "part-000$victim.film: not finished (--rows "
    says "$folder/merge.log" '1 of 4 parts are missing'
    by_slurm --bands 4 || return
    says "$folder.out" "renders parts $victim,"
    merged && is_right "$folder.pfm"
}

case_slurm_damaged() {
    : "a part fails for good, for its film is damaged: the merge names it; without the file it is rendered"
    mkdir "$folder" && head -c 5000 /dev/urandom >"$(film "$folder" 3)"
    by_slurm --bands 4 || return
    merged && merge_failed
    is_absent "$folder.pfm"
    says "$folder/merge.log" 'part-0003.film: not finished (--rows 48-71)'
    rm "$(film "$folder" 3)"
    by_slurm --bands 4 || return
    says "$folder.out" 'renders parts 3,'
    merged && is_right "$folder.pfm"
}

case_slurm_node_lost() {
    : "the node dies with all that runs on it, and comes back: parts go on from their films"
    longer
    by_slurm --bands 4 || return
    await_mid_run || return
    local lost=$part number stepds=''
    for number in $(parts_in "$job" RUNNING); do stepds+=" $(pgrep -f "^slurmstepd: \[$(id_of "$number")")"; done
    kill -9 "$(cat "$slurm/slurmd.pid")" $stepds
    kill -9 $(pgrep -f "farm_slurm.sh part $folder") $(pgrep -f -- "--keep $folder/")
    await 60 'Slurm knows' node_is 'down*' || return
    start_node
    merged && is_right "$folder.pfm"
    says "$(log "$folder" "$lost")" "$resumed"
    says_not "$(log "$folder" "$lost")" 'requeues this part'  # by itself
}
id_of() { scontrol show job "${job}_$1" | sed -n 's/^JobId=\([0-9]*\).*/\1/p'; }  # NUMBER

case_slurm_drained() {
    : "the node is drained: parts that run end, the others wait; it is resumed, and they finish"
    longer
    by_slurm --bands 6 || return
    await_mid_run || return
    scontrol update nodename=farm state=drain reason=test
    await 120 'what runs has ended' node_is drained || return
    local waiting
    waiting=$(parts_in "$job" PENDING)
    [ -n "$waiting" ] || bad 'no part waits: give them more samples'
    sleep 5
    [ "$(parts_in "$job" PENDING)" = "$waiting" ] || bad 'a part began on a drained node'
    ! ended "$merge_job" || bad 'the merge did not wait'
    scontrol update nodename=farm state=resume
    merged && is_right "$folder.pfm"
}

case_slurm_preempted() {
    : "urgent jobs take the processors from parts, which write their films and go on later"
    longer
    by_slurm --bands 4 || return
    await_mid_run || return
    sbatch --partition=urgent --cpus-per-task=2 --output=/dev/null --wrap 'sleep 3' >/dev/null
    await 60 "part $part waits" eval '! [ "$(process_of $part)" ]' || return
    merged && is_right "$folder.pfm"
    says "$(log "$folder" "$part")" "$resumed"
    says_not "$(log "$folder" "$part")" 'requeues this part'  # by itself
}

case_slurm_cancelled() {
    : "cancelled parts stay so; the merge says which; the same command again goes on from their films"
    longer
    by_slurm --bands 4 || return
    await_mid_run || return
    (by_slurm --bands 4) 2>/dev/null && bad 'a second farm began in the folder'
    says "$folder.err" 'is still running'
    scancel "$job"
    merged && merge_failed
    is_absent "$folder.pfm"
    says "$folder/merge.log" "part-000$part.film: not finished"
    by_slurm --bands 4 || return
    merged && is_right "$folder.pfm"
    says "$(log "$folder" "$part")" "$resumed"
}

case_slurm_time_limit() {
    : "a part comes to its limit of time: it stops before, queues again, and goes on"
    longer
    by_slurm --bands 1 --sbatch --time=1 --grace 50 || return
    await_mid_run || return
    # No machine is fast enough to complete it by then.
    local process
    process=$(process_of 1)
    kill -STOP "$process"
    await 90 'Slurm warns of the limit' grep -q '^farm: stopping after signal USR1' "$(log "$folder" 1)"
    kill -CONT "$process"
    merged && is_right "$folder.pfm"
    says "$(log "$folder" 1)" '^farm: requeues this part'
    says "$(log "$folder" 1)" "$resumed"
}

case_slurm_full_disk() {
    : "the folder's disk is full: parts fail, the merge names them; with room again the same command ends it"
    small_disk 64k && folder=$disk/farm || return 0
    by_slurm --bands 4 || return
    merged
    is_absent "$folder.pfm"
    more_disk 64m
    by_slurm --bands 4 || return
    merged && is_right "$folder.pfm"
    release_disk
}

case_slurm_refused() {
    : "what cannot be submitted is refused before anything is"
    (by_slurm --bands 97) 2>/dev/null && bad '97 bands of 96 rows'
    says "$folder.err" 'the picture has 96 rows'
    (by_slurm --sbatch --partition=none) 2>/dev/null && bad 'a partition that does not exist'
    (picture=(--sampler dice "${picture[@]}") && by_slurm) 2>/dev/null && bad 'no such sampler'
    says "$folder.err" 'dice'
    [ -z "$(squeue --noheader)" ] || bad 'jobs were submitted'
}

# ---- By GNU parallel ----------------------------------------------------------------------------

by_parallel() {  # OPTION...
    bash src/keep/farm_parallel.sh --folder "$folder" --build "$build" -o "$folder.pfm" "$@" -- "${picture[@]}" \
        >"$folder.out" 2>"$folder.err"
}
parallel_in_mid_run() {
    local film
    for film in "$folder"/part-*.film; do
        [ -e "$film" ] || continue
        part=${film##*-} && part=$((10#${part%.film}))
        [ -n "$(process_of "$part")" ] && ! finished "$folder" "$part" && return 0
    done
    return 1
}

case_parallel_whole() {
    : "bands on local slots"
    by_parallel --bands 5 --slots 2 || bad "exit status $?"
    is_right "$folder.pfm"
}

case_parallel_killed() {
    : "penumbra is killed in mid-run (kill -9), twice"
    longer
    by_parallel --bands 4 --slots 2 & local farm=$!
    local killed=() process
    for time in 1 2; do
        await 120 'a part has a film and runs on' parallel_in_mid_run || return
        killed+=("$part") process=$(process_of "$part")
        kill -9 "$process" && await 20 'it has ended' have_ended "$process" || return
    done
    wait "$farm" || bad "exit status $?"
    is_right "$folder.pfm"
    for part in "${killed[@]}"; do says "$(log "$folder" "$part")" "$resumed"; done
}

case_parallel_stopped() {
    : "the farm is stopped (SIGTERM), then killed; each time the same command goes on from the films"
    longer
    local signal
    for signal in TERM KILL; do
        by_parallel --bands 4 --slots 2 & local farm=$!
        await 120 'a part has a film and runs on' parallel_in_mid_run || return
        kill -s "$signal" $(pgrep -f "parallel .*$folder") "$farm"
        wait "$farm" 2>/dev/null && bad 'it went on'
        is_absent "$folder.pfm"
        [ "$signal" = TERM ] || kill -9 $(pgrep -f -- "--keep $folder/") 2>/dev/null
        await 30 'no part runs' eval '! pgrep -f -- "--keep $folder/" >/dev/null' || return
    done
    by_parallel --bands 4 --slots 2 || bad "exit status $?"
    is_right "$folder.pfm"
    says "$(log "$folder" "$part")" "$resumed"
}

case_parallel_ssh() {
    : "two machines by ssh, of which one is lost in mid-run: its parts go on upon the other"
    longer
    start_ssh one two || { bad "sshd does not start"; return; }
    printf '1/ssh -F %s %s\n' "$work/ssh/config" one "$work/ssh/config" two >"$work/hosts"
    by_parallel --bands 6 --hosts "$work/hosts" & local farm=$!
    await 120 'a part has a film and runs on' parallel_in_mid_run || return
    local lost
    lost=$(descendants "$(cat "$(sshd_of one)/pid")")
    kill -9 "$(cat "$(sshd_of one)/pid")" $lost
    rm "$(sshd_of one)/pid"
    wait "$farm" || { bad "exit status $?"; cat "$folder.err"; }
    is_right "$folder.pfm"
    [ -n "$lost" ] || bad 'nothing ran on the machine that was lost'
}
descendants() { local child; for child in $(pgrep -P "$1"); do echo "$child"; descendants "$child"; done; }

case_parallel_damaged() {
    : "a part fails for good: it is named, and no picture is written; then it is rendered alone"
    mkdir "$folder" && head -c 5000 /dev/urandom >"$(film "$folder" 2)"
    by_parallel --bands 4 --slots 2 && bad 'exit status 0'
    is_absent "$folder.pfm"
    says "$folder.err" 'part-0002.film: not finished (--rows 24-47)'
    rm "$(film "$folder" 2)"
    local before
    before=$(cat "$(film "$folder" 1)" | cksum)
    by_parallel --bands 4 --slots 2 || bad "exit status $?"
    [ "$before" = "$(cat "$(film "$folder" 1)" | cksum)" ] || bad 'part 1 was written again'
    is_right "$folder.pfm"
}

case_parallel_full_disk() {
    : "the folder's disk is full: parts are named; with room again the same command ends it"
    small_disk 64k && folder=$disk/farm || return 0
    by_parallel --bands 4 --slots 2 2>/dev/null && bad 'exit status 0'
    is_absent "$folder.pfm"
    more_disk 64m
    by_parallel --bands 4 --slots 2 || bad "exit status $?"
    is_right "$folder.pfm"
    release_disk
}

# ---- A disk that fills --------------------------------------------------------------------------

small_disk() {
    mkdir -p "$disk" && $as mount -t tmpfs -o "size=$1,mode=777" farm "$disk" 2>/dev/null && return
    echo '    left out: only root may mount a small disk'
    return 1
}
more_disk() { $as mount -o "remount,size=$1" "$disk"; }
release_disk() { ! mountpoint -q "$disk" || $as umount "$disk"; }
