# farm/packages.sh  the system packages that farms need: installed if missing, and removed at the end

farm_packages="slurmctld slurmd slurm-client munge parallel openssh-server openssh-client"
farm_commands="slurmctld slurmd sbatch munged parallel sshd ssh"
installed=''

missing_commands() { for command in $farm_commands; do command -v "$command" >/dev/null || echo "$command"; done; }
packages_there() { dpkg-query --show --showformat='${db:Status-Abbrev} ${Package}\n' | sed -n 's/^i. *//p' | sort; }

# Services of new packages must not start: Debian reads this file.
no_services() {  # COMMAND...
    local policy=/usr/sbin/policy-rc.d ours='' status=0
    if [ ! -e "$policy" ]; then
        ours=yes
        printf '#!/bin/sh\nexit 101\n' | $as tee "$policy" >/dev/null && $as chmod 755 "$policy"
    fi
    "$@" || status=$?
    [ -z "$ours" ] || $as rm -f "$policy"
    return $status
}

as=''
install_packages() {
    PATH=$PATH:/usr/sbin:/sbin
    if [ "$(id -u)" != 0 ] && command -v sudo >/dev/null && sudo -n true 2>/dev/null; then as='sudo -n'; fi
    [ -n "$(missing_commands)" ] || return 0
    local install="apt-get install -y --no-install-recommends $farm_packages" before
    if ! command -v apt-get >/dev/null || { [ "$(id -u)" != 0 ] && [ -z "$as" ]; }; then
        echo "farm: missing:" $(missing_commands)"; run: sudo $install" >&2
        return 1
    fi
    echo "installing $farm_packages"
    before=$(packages_there)
    export DEBIAN_FRONTEND=noninteractive
    no_services $as $install >/dev/null 2>&1 || { $as apt-get update && no_services $as $install; } >/dev/null ||
        { echo "farm: apt-get failed; run: sudo $install" >&2; return 1; }
    installed=$(comm -13 <(echo "$before") <(packages_there))
    [ -z "$(missing_commands)" ] || { echo "farm: installed, but missing:" $(missing_commands) >&2; return 1; }
}

remove_packages() {
    [ -n "$installed" ] || return 0
    if [ -n "${KEEP-}" ]; then echo "left, as KEEP=1 says:" $installed; return; fi
    echo "removing" $installed
    no_services $as apt-get purge -y $installed >/dev/null 2>&1 || echo "farm: could not remove" $installed >&2
}
