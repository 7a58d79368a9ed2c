# farm/ssh.sh  hosts for ssh: one sshd each, on the loopback, with keys of their own
#
# Each host is this machine at another port: ssh is the only connection between its parts and the test.

made_run_sshd=''
sshd_of() { echo "$work/ssh/$1"; }  # NAME

start_ssh() {  # NAME...
    local name folder port
    mkdir -p "$work/ssh"
    # As root, sshd requires a folder that its package makes at boot.
    if [ "$(id -u)" = 0 ] && [ ! -e /run/sshd ]; then mkdir /run/sshd && made_run_sshd=yes; fi
    [ -e "$work/ssh/key" ] || ssh-keygen -q -t ed25519 -N '' -f "$work/ssh/key"
    for name; do
        folder=$(sshd_of "$name") port=$(port_that_is_free)
        mkdir -p "$folder"
        ssh-keygen -q -t ed25519 -N '' -f "$folder/host"
        cat >"$folder/sshd_config" <<END
ListenAddress 127.0.0.1
Port $port
HostKey $folder/host
PidFile $folder/pid
AuthorizedKeysFile $work/ssh/key.pub
PermitRootLogin yes
PasswordAuthentication no
KbdInteractiveAuthentication no
UsePAM no
StrictModes no
END
        "$(command -v sshd)" -f "$folder/sshd_config" -E "$folder/log" || return 1
        cat >>"$work/ssh/config" <<END
Host $name
    HostName 127.0.0.1
    Port $port
    User $(id -un)
    IdentityFile $work/ssh/key
    IdentitiesOnly yes
    StrictHostKeyChecking no
    UserKnownHostsFile $work/ssh/known
    LogLevel ERROR
END
        await 20 "sshd of $name" ssh -F "$work/ssh/config" "$name" true
    done
}

stop_ssh() {
    local pid
    for pid in "$work"/ssh/*/pid; do [ ! -e "$pid" ] || kill "$(cat "$pid")"; done
    [ -z "$made_run_sshd" ] || rmdir /run/sshd
}
