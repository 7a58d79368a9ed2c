# course/sandbox.py  12  compiles and runs what students wrote: no network, no files, no processes
#
# Both sides are bubblewrap's namespaces with limits by prlimit.  The compiler sees the system's
# headers and libraries, the tree that it compiles, and a folder for its output.  The program, linked
# statically, sees an empty file system and may ask the kernel for memory, the time, and to read and
# write its pipes: a list of what is allowed (seccomp), so that whatever is not on it fails.
#
# A container may make no namespaces.  Root has a weaker way there: confine(), which is this file run as a
# program, becomes a user who owns nothing and whom no other process has.  What runs has the same limits and
# the same list of calls, in a root directory that holds itself alone.  The compiler sees the system as any user
# does, so all that is secret must be closed to other users: closed() looks.
import contextlib
import ctypes
import os
import pathlib
import platform
import re
import resource
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import threading
import time
from dataclasses import dataclass

PACKAGE = 'bubblewrap'
MEMORY = 1 << 29         # bytes of a running program
COMPILER_MEMORY = 3 << 29
OUTPUT = 1 << 26         # bytes of a file that the compiler writes
TEMPORARY = 1 << 28      # bytes of its temporary files together
PROCESSES = 64           # of a compiler that is another user
MISSING = 127            # exit status: there is no such program

# How programs are confined here: 'namespaces' or 'user'; demand() decides.
way = 'namespaces'

# Calls of a static program that computes and talks over pipes.  execve is bubblewrap's last call,
# wait4 that of its process 1; both find nothing else to start or to wait for.  None sleeps by the clock: what
# takes long takes processor time, or the judge loses patience.
ALLOWED = {
    'x86_64': (0xC000003E, [0, 1, 3, 5, 8, 9, 10, 11, 12, 13, 14, 15, 20, 24, 25, 28, 32, 33, 39, 59, 60, 61, 72, 96, 98,
                            131, 158, 186, 201, 202, 204, 218, 228, 229, 231, 234, 262, 273, 302, 318, 334]),
    'aarch64': (0xC00000B7, [23, 24, 25, 57, 62, 63, 64, 66, 79, 80, 93, 94, 96, 98, 99, 113, 114, 123, 124, 131, 132, 134,
                             135, 139, 165, 169, 172, 178, 214, 215, 216, 221, 222, 226, 233, 260, 261, 278, 293]),
}
# Calls that a compiler without namespaces has no use for: socket, ptrace, setpgid, setsid (by which it would leave the
# group that is killed), unshare, process_vm_readv and _writev, bpf, io_uring_setup.
DENIED = {'x86_64': [41, 101, 109, 112, 272, 310, 311, 321, 425], 'aarch64': [198, 117, 154, 157, 97, 270, 271, 280, 425]}


class Missing(Exception):
    """Why no program can be confined on this machine."""


@dataclass(frozen=True)
class Built:
    ok: bool
    messages: str   # what the compiler said
    ended: str      # '' or how it was stopped
    seconds: float  # by the clock


# ---- What the machine must have ------------------------------------------------------------------

def demand(wanted=''):
    """Decides how programs are confined here, and tries it; Missing, if they cannot be.  wanted: no other way than this."""
    global way
    if platform.system() != 'Linux' or platform.machine() not in ALLOWED:
        raise Missing(f'no sandbox for {platform.system()} on {platform.machine()}: grade on Linux, x86_64 or aarch64')
    for program, package in (('bwrap', PACKAGE), ('prlimit', 'util-linux'), ('timeout', 'coreutils')):
        if not shutil.which(program) and (wanted != 'user' or program == 'timeout'):
            raise Missing(f"{program} is missing: install {package} (apt install {package}); what students wrote is never "
                          "compiled or run without it")
    refusals = {}
    for way in [wanted] if wanted else ['namespaces', 'user']:
        refusals[way] = refusal()
        if not refusals[way]:
            return
    raise Missing(f"""{'; '.join(refusals.values())}
{PACKAGE} is installed, but may not make namespaces here. Do one of these:
  on Debian         sudo sysctl kernel.unprivileged_userns_clone=1
  on Ubuntu 24.04   sudo sysctl kernel.apparmor_restrict_unprivileged_userns=0, or allow it to bubblewrap alone: write
                        abi <abi/4.0>,
                        profile bwrap {shutil.which('bwrap')} flags=(unconfined) {{ userns, }}
                    into /etc/apparmor.d/bwrap, then sudo systemctl reload apparmor
  anywhere          grade as root, or in a container that may make namespaces (docker run --privileged)""")


def refusal():
    """Why programs cannot be confined in this way; '': they can."""
    if way == 'user' and os.geteuid() != 0:
        return 'without namespaces, only root can become another user'
    with tempfile.TemporaryDirectory() as folder:
        os.chmod(folder, 0o755)
        trials = [(compile_command(folder, folder, ['/usr/bin/env'], 10), 0)]
        if way == 'user':  # a program that is not there: all that comes before it went well
            trials.append((run_command(f'{folder}/none', '', 10), MISSING))
        for command, right in trials:
            tried = subprocess.run(command, env=environment(), text=True, stdin=subprocess.DEVNULL, capture_output=True)
            if tried.returncode != right:
                return tried.stderr.strip() or f'{command[0]}: exit status {tried.returncode}'
    return ''


def closed(paths):
    """Whoever is another user must not reach these; Missing names one that they can."""
    for path in paths if way == 'user' else []:
        path = pathlib.Path(path).resolve()
        if all(folder.stat().st_mode & 0o001 for folder in (path, *path.parents) if folder.exists()):
            raise Missing(f'without namespaces, what students wrote is compiled by another user, who could read {path}: chmod 700 it')


@contextlib.contextmanager
def room(folder):
    """An empty folder for what is compiled: this one, or, without namespaces, one that other users can pass through."""
    if way == 'user':
        os.umask(0o022)
        folder = tempfile.mkdtemp(prefix='penumbra-grade-')
    else:
        shutil.rmtree(folder, ignore_errors=True)
        os.mkdir(folder)
    os.chmod(folder, 0o755 if way == 'namespaces' else 0o711)
    try:
        yield str(folder)
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def within_reach(folder, room):
    """The folder, or a copy that a compiler who is another user can read."""
    return shutil.copytree(folder, f'{room}/{os.path.basename(folder)}') if way == 'user' else folder


def told():
    """What the reports say of the way."""
    return '' if way == 'namespaces' else 'Confined by the weaker sandbox: another user, limits and seccomp, without namespaces.'


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
    if way == 'user':
        seen = {'/out/': f'{out}/', '/headers/': f'{headers}/'}
        return confining('compile', tree, out, cpu, COMPILER_MEMORY, OUTPUT, *(
            next((place + word[len(name):] for name, place in seen.items() if word.startswith(name)), word) for word in command))
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
    alarm.cancel()
    kill_group(process.pid)  # what it may have left
    ended = alarm.said or how_it_ended(status, said, cpu)
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
        kill_group(self.process.pid)

    def cancel(self):
        self.timer.cancel()


def kill_group(leader):
    try:
        os.killpg(leader, signal.SIGKILL)
    except (ProcessLookupError, PermissionError):
        pass


# ---- Running -------------------------------------------------------------------------------------

LOAD, EQUAL, LEAST, GIVE = 0x20, 0x15, 0x35, 0x06  # of a Berkeley packet filter
PASS, REFUSE, KILL = 0x7FFF0000, 0x00050001, 0x80000000


def filter_program(denied=False):
    """Another machine's calls kill, calls of the list pass, others are not permitted; denied: the other way round."""
    machine, calls = ALLOWED[platform.machine()]
    calls = DENIED[platform.machine()] if denied else calls
    of_list, others = (REFUSE, PASS) if denied else (PASS, REFUSE)
    code = [(LOAD, 0, 0, 4), (EQUAL, 1, 0, machine), (GIVE, 0, 0, KILL), (LOAD, 0, 0, 0)]
    code += [(LEAST, 0, 1, 1 << 30), (GIVE, 0, 0, REFUSE)]  # the same calls by x32's numbers
    code += [(EQUAL, len(calls) - i, 0, call) for i, call in enumerate(calls)]
    code += [(GIVE, 0, 0, others), (GIVE, 0, 0, of_list)]
    return b''.join(struct.pack('=HBBI', *line) for line in code)


def run_command(program, rules, cpu):
    """Runs a statically linked program; what it reads and writes are its three pipes.

    rules is a file with filter_program(), opened anew at every start.
    """
    if way == 'user':
        return confining('run', os.path.dirname(program), '', cpu, MEMORY, 0, '/' + os.path.basename(program))
    confined = [*limits(cpu, MEMORY, 0), *prefix(), '--ro-bind', program, '/answers', '--remount-ro', '/',
                '--chdir', '/', '--seccomp', '9', '--', '/answers']
    # Whatever else the judge has open is closed.
    script = 'rules=$1; shift; exec "$@" 3<&- 4<&- 5<&- 6<&- 7<&- 8<&- 9<"$rules" 2>/dev/null'
    return ['/bin/sh', '-c', script, 'sandbox', rules, *confined]


# ---- Without namespaces --------------------------------------------------------------------------

def confining(*words):
    return [sys.executable, '-IS', os.path.abspath(__file__), *map(str, words)]


def own_user():
    """A number that no other process has; where so high ones are not mapped, one of 4336 that are."""
    user = (1 << 30) + os.getpid()
    with open('/proc/self/uid_map', encoding='ascii') as ranges:
        for first, _, count in (map(int, line.split()) for line in ranges):
            if first <= user < first + count:
                return user
    return 61184 + os.getpid() % 4336


def confine(what, folder, out, cpu, memory, output, *command):
    """Becomes the command, in the folder, as a user of its own; what runs has the folder as its root directory."""
    user = own_user()
    running = what == 'run'
    program = command[0] if running else shutil.which(command[0], path='/usr/bin')
    environ = {} if running else {'PATH': '/usr/bin', 'LC_ALL': 'C', 'TMPDIR': out}
    nowhere = os.open('/dev/null', os.O_WRONLY)
    os.umask(0o022)
    os.chdir(folder)
    if running:
        os.chroot('.')
        os.dup2(nowhere, 2)
    else:
        os.chown(out, user, user)
    os.closerange(3, 1 << 16)
    for limit, most in ((resource.RLIMIT_AS, memory), (resource.RLIMIT_FSIZE, output), (resource.RLIMIT_CORE, 0),
                        (resource.RLIMIT_NOFILE, 64), (resource.RLIMIT_MEMLOCK, 0), (resource.RLIMIT_MSGQUEUE, 0),
                        (resource.RLIMIT_NPROC, PROCESSES)):
        resource.setrlimit(limit, (int(most), int(most)))
    resource.setrlimit(resource.RLIMIT_CPU, (int(cpu), int(cpu) + 1))
    os.setgroups([])
    os.setresgid(user, user, user)
    os.setresuid(user, user, user)
    code = filter_program(denied=not running)
    library = ctypes.CDLL(None, use_errno=True)
    library.prctl.argtypes = [ctypes.c_int, *4 * [ctypes.c_ulong]]
    text = ctypes.create_string_buffer(code, len(code))
    rules = ctypes.create_string_buffer(struct.pack('@HP', len(code) // 8, ctypes.addressof(text)))
    for order in ((1, signal.SIGKILL, 0),   # PR_SET_PDEATHSIG: ends with the process that started it
                  (38, 1, 0),               # PR_SET_NO_NEW_PRIVS
                  (22, 2, ctypes.addressof(rules))):  # PR_SET_SECCOMP, SECCOMP_MODE_FILTER
        if library.prctl(*order, 0, 0) != 0:
            raise OSError(ctypes.get_errno(), f'prctl({order[0]}) is refused')
    for ignored in (signal.SIGPIPE, signal.SIGXFSZ):  # by Python
        signal.signal(ignored, signal.SIG_DFL)
    os.execve(program, command, environ)


if __name__ == '__main__':
    try:
        confine(*sys.argv[1:])
    except FileNotFoundError:
        os._exit(MISSING)
    except OSError as error:
        print(f'sandbox: {error}', file=sys.stderr)
        os._exit(126)
