# course/sandbox.py  12  compiles and runs what students wrote: no network, no files, no processes
#
# Both sides are bubblewrap's namespaces with limits by prlimit.  The compiler sees the system's
# headers and libraries, the tree that it compiles, and a folder for its output.  The program, linked
# statically, sees an empty file system and may ask the kernel for memory, the time, and to read and
# write its pipes: a list of what is allowed (seccomp), so that whatever is not on it fails.
import os
import platform
import re
import shutil
import signal
import struct
import subprocess
import threading
import time
from dataclasses import dataclass

PACKAGE = 'bubblewrap'
MEMORY = 1 << 29         # bytes of a running program
COMPILER_MEMORY = 3 << 29
OUTPUT = 1 << 26         # bytes of a file that the compiler writes
TEMPORARY = 1 << 28      # bytes of its temporary files together

# Calls of a static program that computes and talks over pipes.  execve is bubblewrap's last call,
# wait4 that of its process 1; both find nothing else to start or to wait for.  None sleeps by the clock: what
# takes long takes processor time, or the judge loses patience.
ALLOWED = {
    'x86_64': (0xC000003E, [0, 1, 3, 5, 8, 9, 10, 11, 12, 13, 14, 15, 20, 24, 25, 28, 32, 33, 39, 59, 60, 61, 72, 96, 98,
                            131, 158, 186, 201, 202, 204, 218, 228, 229, 231, 234, 262, 273, 302, 318, 334]),
    'aarch64': (0xC00000B7, [23, 24, 25, 57, 62, 63, 64, 66, 79, 80, 93, 94, 96, 98, 99, 113, 114, 123, 124, 131, 132, 134,
                             135, 139, 165, 169, 172, 178, 214, 215, 216, 221, 222, 226, 233, 260, 261, 278, 293]),
}


class Missing(Exception):
    """Why no program can be confined on this machine."""


@dataclass(frozen=True)
class Built:
    ok: bool
    messages: str   # what the compiler said
    ended: str      # '' or how it was stopped
    seconds: float  # by the clock


# ---- What the machine must have ------------------------------------------------------------------

def demand():
    """Raises Missing unless programs can be confined here; tries it."""
    if platform.system() != 'Linux' or platform.machine() not in ALLOWED:
        raise Missing(f'no sandbox for {platform.system()} on {platform.machine()}: grade on Linux, x86_64 or aarch64')
    for program, package in (('bwrap', PACKAGE), ('prlimit', 'util-linux'), ('timeout', 'coreutils')):
        if not shutil.which(program):
            raise Missing(f"{program} is missing: install {package} (apt install {package}); what students wrote is never "
                          "compiled or run without it")
    tried = subprocess.run([*prefix(), *system_files(), '/usr/bin/env'], env=environment(), text=True,
                           stdin=subprocess.DEVNULL, capture_output=True)
    if tried.returncode != 0:
        raise Missing(f"""{tried.stderr.strip() or f'bwrap: exit status {tried.returncode}'}
{PACKAGE} is installed, but may not make namespaces here. Do one of these:
  on Debian         sudo sysctl kernel.unprivileged_userns_clone=1
  on Ubuntu 24.04   sudo sysctl kernel.apparmor_restrict_unprivileged_userns=0, or load an AppArmor profile for
                    {shutil.which('bwrap')} that has the line "userns,"
  anywhere          grade as root, or in a container that may make namespaces (docker run --privileged)""")


def environment():
    return {'PATH': '/usr/bin:/bin', 'LC_ALL': 'C', 'ORACLE_PICTURES': ''}


def prefix():
    """No network, no other processes, no rights, no environment; ends with the process that started it."""
    return [shutil.which('bwrap'), '--unshare-all', '--die-with-parent', '--new-session', '--clearenv',
            '--cap-drop', 'ALL', '--uid', '65534', '--gid', '65534', '--hostname', 'sandbox']


def limits(cpu, memory, output):
    """Of every process: seconds, bytes of memory, bytes of a file."""
    return ['prlimit', f'--cpu={cpu}:{cpu + 1}', f'--as={memory}', f'--fsize={output}', '--core=0', '--nofile=64',
            '--memlock=0', '--msgqueue=0', '--']


def system_files():
    """What a compiler needs of the system, to be read."""
    words = ['--setenv', 'PATH', '/usr/bin', '--setenv', 'LC_ALL', 'C']
    for folder in ('bin', 'include', 'lib', 'lib32', 'lib64', 'libexec'):
        if os.path.isdir(f'/usr/{folder}'):
            words += ['--ro-bind', f'/usr/{folder}', f'/usr/{folder}']
    for folder in ('bin', 'lib', 'lib32', 'lib64'):
        if os.path.islink(f'/{folder}'):
            words += ['--symlink', os.readlink(f'/{folder}'), f'/{folder}']
        elif os.path.isdir(f'/{folder}'):
            words += ['--ro-bind', f'/{folder}', f'/{folder}']
    if os.path.isdir('/etc/alternatives'):
        words += ['--ro-bind', '/etc/alternatives', '/etc/alternatives']
    return words


# ---- Compiling -----------------------------------------------------------------------------------

def compile_command(tree, out, command, cpu, headers=None):
    """The command, seeing the folders `tree` as /tree and `headers` as /headers, to be read, and `out` as /out."""
    return [*limits(cpu, COMPILER_MEMORY, OUTPUT), *prefix(), *system_files(),
            '--size', str(TEMPORARY), '--tmpfs', '/tmp', '--dev', '/dev', '--ro-bind', tree, '/tree', '--bind', out, '/out',
            *(['--ro-bind', headers, '/headers'] if headers else []),
            '--remount-ro', '/', '--chdir', '/tree', '--', *command]


def build(tree, out, command, cpu=20, headers=None):
    """Runs a compiler on untrusted text.  No more than 64 kB of what it says is kept."""
    began = time.monotonic()
    process = subprocess.Popen(compile_command(tree, out, command, cpu, headers), env=environment(),
                               stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                               start_new_session=True)
    alarm = Alarm(process, 3 * cpu + 5)
    with process.stderr:
        said = process.stderr.read(1 << 16).decode('utf-8', 'replace')
        while process.stderr.read(1 << 16):
            pass
    status = process.wait()
    ended = alarm.cancel() or how_it_ended(status, said, cpu)
    return Built(status == 0 and not ended, said, ended, time.monotonic() - began)


def how_it_ended(status, said, cpu):
    """Which limit a compiler met, by its last words."""
    if status in (-signal.SIGXCPU, 128 + signal.SIGXCPU, -signal.SIGKILL, 128 + signal.SIGKILL) or \
            'CPU time limit exceeded' in said or 'Killed signal' in said:
        return f'the compiler was stopped after {cpu} s'
    if re.search('out of memory|Cannot allocate memory|bad_alloc', said):
        return f'the compiler needed more than {COMPILER_MEMORY >> 20} MB'
    if re.search('File size limit exceeded|File too large|No space left', said):
        return f'the program would have more than {OUTPUT >> 20} MB'
    return ''


class Alarm:
    """Kills a process group after so many seconds by the clock."""
    def __init__(self, process, seconds):
        self.process, self.seconds, self.said = process, seconds, ''
        self.timer = threading.Timer(seconds, self.ring)
        self.timer.daemon = True
        self.timer.start()

    def ring(self):
        self.said = f'the compiler was stopped after {self.seconds} s'
        try:
            os.killpg(self.process.pid, signal.SIGKILL)
        except ProcessLookupError:
            pass

    def cancel(self):
        self.timer.cancel()
        return self.said


# ---- Running -------------------------------------------------------------------------------------

def filter_program():
    """Berkeley packet filter: another machine's calls kill, calls of the list pass, others are not permitted."""
    machine, calls = ALLOWED[platform.machine()]
    load, equal, give = 0x20, 0x15, 0x06
    code = [(load, 0, 0, 4), (equal, 1, 0, machine), (give, 0, 0, 0x80000000), (load, 0, 0, 0)]
    code += [(equal, len(calls) - i, 0, call) for i, call in enumerate(calls)]
    code += [(give, 0, 0, 0x00050001), (give, 0, 0, 0x7FFF0000)]
    return b''.join(struct.pack('=HBBI', *line) for line in code)


def run_command(program, rules, cpu):
    """Runs a statically linked program; what it reads and writes are its three pipes.

    rules is a file with filter_program(), opened anew at every start.
    """
    confined = [*limits(cpu, MEMORY, 0), *prefix(), '--ro-bind', program, '/answers', '--remount-ro', '/',
                '--chdir', '/', '--seccomp', '9', '--', '/answers']
    # Whatever else the judge has open is closed.
    script = 'rules=$1; shift; exec "$@" 3<&- 4<&- 5<&- 6<&- 7<&- 8<&- 9<"$rules" 2>/dev/null'
    return ['/bin/sh', '-c', script, 'sandbox', rules, *confined]
