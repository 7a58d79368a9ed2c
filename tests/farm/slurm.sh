# farm/slurm.sh  a Slurm of one node on this machine: start, queries, faults, stop
#
# $slurm holds everything: configuration, state, spool, key, logs.  It listens only on the loopback,
# runs as the test's user, and needs neither systemd nor control groups.

port_that_is_free() {
    local port
    while port=$((RANDOM % 20000 + 20000)); (: <>"/dev/tcp/127.0.0.1/$port") 2>/dev/null; do :; done
    echo "$port"
}

slurm_configuration() {
    local host user port
    host=$(uname -n) user=$(id -un) port=$(port_that_is_free)
    cat <<END
ClusterName=farm
SlurmctldHost=${host%%.*}(127.0.0.1)
SlurmUser=$user
SlurmdUser=$user
SlurmctldPort=$port
SlurmdPort=$((port + 1))
AuthType=auth/munge
# A job that is queued again waits until its old credential has expired, by default 120 seconds.
AuthInfo=socket=$slurm/munge/socket,cred_expire=5
StateSaveLocation=$slurm/state
SlurmdSpoolDir=$slurm/spool
SlurmctldPidFile=$slurm/slurmctld.pid
SlurmdPidFile=$slurm/slurmd.pid
SlurmctldLogFile=$slurm/slurmctld.log
SlurmdLogFile=$slurm/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerParameters=bf_interval=2,sched_interval=2
PreemptType=preempt/partition_prio
PreemptMode=REQUEUE
ReturnToService=2
SlurmdTimeout=10
KillWait=20
MinJobAge=300
SlurmdParameters=config_overrides
NodeName=farm NodeHostname=${host%%.*} NodeAddr=127.0.0.1 CPUs=2
PartitionName=farm Nodes=farm Default=YES MaxTime=INFINITE State=UP PriorityTier=1
PartitionName=urgent Nodes=farm MaxTime=INFINITE State=UP PriorityTier=2
END
}

start_node() { slurmd -N farm; }

start_slurm() {
    mkdir -p "$slurm/state" "$slurm/spool" && mkdir -m 755 "$slurm/munge" || return 1
    (umask 077 && head -c 128 /dev/urandom >"$slurm/munge.key")
    munged --force --key-file="$slurm/munge.key" --socket="$slurm/munge/socket" --pid-file="$slurm/munge/pid" \
        --log-file="$slurm/munge/log" --seed-file="$slurm/munge/seed" 2>"$slurm/munge/errors" || return 1
    slurm_configuration >"$slurm/slurm.conf" || return 1
    export SLURM_CONF=$slurm/slurm.conf
    slurmctld && start_node && await 60 'the node is idle' node_is idle
}

stop_slurm() {
    [ -n "${SLURM_CONF-}" ] || return 0
    local daemons
    free_slurm
    daemons=$(cat "$slurm/slurmd.pid" "$slurm/slurmctld.pid" "$slurm/munge/pid" 2>/dev/null)
    kill $daemons 2>/dev/null
    await 30 'the daemons have ended' have_ended $daemons || kill -9 $daemons
}
have_ended() { local pid; for pid; do case $(ps -o stat= -p "$pid") in '' | Z*) ;; *) return 1 ;; esac; done; }  # PID...

# Ends what a case left running.
free_slurm() {
    scancel --user="$(id -un)" 2>/dev/null
    await 40 'no job runs' no_job_runs
    [ -e "$slurm/slurmd.pid" ] && ! have_ended "$(cat "$slurm/slurmd.pid")" || start_node
    node_is idle || scontrol update nodename=farm state=resume 2>/dev/null
    await 60 'the node is idle' node_is idle
}
no_job_runs() { [ -z "$(squeue --noheader --states=running,completing 2>/dev/null)" ]; }

node_is() { [ "$(sinfo --noheader --Node --format=%T --partition=farm)" = "$1" ]; }

# Numbers of the array's parts in a state: RUNNING, PENDING, COMPLETED, FAILED, CANCELLED ...
parts_in() {  # JOB STATE
    squeue --noheader --array --states=all --job "$1" --format='%K %T' | awk -v state="$2" '$2 == state { print $1 }'
}
state_of() { squeue --noheader --states=all --job "$1" --format=%T; }  # JOB
ended() {  # JOB
    case $(state_of "$1") in COMPLETED | FAILED | CANCELLED | TIMEOUT | NODE_FAIL) ;; *) return 1 ;; esac
}
