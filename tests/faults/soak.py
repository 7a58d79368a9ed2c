#!/usr/bin/env python3
# faults/soak.py  renders under faults: a picture is bit-identical, or absent with a message
"""soak.py [--seconds S | --each] [--seed N] [--only KIND] [--run N] [--jobs N] PENUMBRA

Renders small pictures of scenes/ under random faults until the time is up.  All random choices depend
on the seed and the run's number; the arrival of signals does not.  --run N repeats only that run.
--each fails every call of one small render instead, in every way, one at a time.

Errors are: a file that is neither the old one nor right; exit status 0 without all files, or another
status without a message; death by a signal that was not sent; temporary files that a run leaves
without being killed, or that the next run does not remove; a film that does not resume to the same
picture; a damaged film that is not refused.  build/faults/wrong-N keeps the files of errors.
"""
import argparse
import collections
import json
import os
import random
import re
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import threading
import time

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
BUILD = os.path.join(ROOT, 'build', 'faults')
OLD = b'old'
ENDLESS = 10 ** 9  # samples
OF_THE_CLOCK = {'seconds', 'cpu_seconds', 'mrays_per_second', 'seconds_to_half_d_rel', 'peak_memory_bytes',
                'threads', 'stopped_by', 'interrupted'}
ENDS = {signal.SIGINT: 130, signal.SIGTERM: 143, signal.SIGHUP: 129}


def library():
    """Compiles disk.cpp and returns its path."""
    source, made = os.path.join(ROOT, 'tests/faults/disk.cpp'), os.path.join(BUILD, 'disk.so')
    os.makedirs(BUILD, exist_ok=True)
    if not os.path.exists(made) or os.path.getmtime(made) < os.path.getmtime(source):
        part = '%s.%d' % (made, os.getpid())
        compiler = os.environ.get('CXX') or next(c for c in ('g++', 'c++', 'clang++') if shutil.which(c))
        subprocess.run([*compiler.split(), '-std=c++20', '-O1', '-shared', '-fPIC', '-o', part,
                        source, '-ldl'], check=True)
        os.rename(part, made)
    return made


def read(path):
    try:
        with open(path, 'rb') as f:
            return f.read()
    except FileNotFoundError:
        return None


def write(path, content):
    with open(path, 'wb') as f:
        f.write(content)


# ---- Runs ----------------------------------------------------------------------------------------

class Conditions:
    """The faults and signals that a run suffers."""
    def __init__(self, faults=(), signals=(), memory=None, largest=None):
        self.faults = list(faults)    # words of disk.cpp
        self.signals = list(signals)  # (seconds after the last one, signal)
        self.memory = memory          # kB of address space
        self.largest = largest        # kB of a file

    def sent(self, what):
        return any(s == what for _, s in self.signals)


class Outcome:
    def __init__(self, status, killed_by, err, faults, seconds):
        self.status, self.killed_by, self.err, self.faults, self.seconds = status, killed_by, err, faults, seconds
        told = re.findall(r': (\S+) samples? per pixel, .*', err)
        self.samples = float(told[-1]) if told else None

    def __str__(self):
        return 'exit status %s, signal %s; faults: %s\n%s' % (self.status, self.killed_by, self.faults, self.err)


class Soak:
    def __init__(self, program, seed, folder):
        self.program, self.seed, self.folder = os.path.abspath(program), seed, folder
        self.disk, self.lock, self.truths = library(), threading.Lock(), {}

    def run(self, words, folder, conditions=Conditions(), draw=0, bare=False):
        """bare: without simulated faults."""
        beside = os.path.join(self.folder, os.path.basename(folder))  # its disk may be full
        log, said = beside + '.log', []
        if os.path.exists(log):
            os.remove(log)
        environment = dict(os.environ)
        if not bare:
            words_of_disk = ['on=' + folder, 'on=' + os.path.join(ROOT, 'scenes'), 'seed=%d' % draw, 'log=' + log,
                             *conditions.faults]
            environment.update(LD_PRELOAD=self.disk, DISK_FAULTS=' '.join(words_of_disk),
                               ASAN_OPTIONS='verify_asan_link_order=0:' + os.environ.get('ASAN_OPTIONS', ''))
        limits = ''
        if conditions.memory and not self.program.endswith('-san'):  # sanitizers reserve terabytes
            limits += 'ulimit -v %d && ' % conditions.memory
        if conditions.largest is not None:
            limits += 'ulimit -f %d && ' % conditions.largest
        start = time.monotonic()
        command = ['bash', '-c', limits + 'exec "$0" "$@"'] if limits else []
        process = subprocess.Popen([*command, self.program, *words], cwd=folder, env=environment, stdin=subprocess.DEVNULL,
                                   stdout=subprocess.PIPE, stderr=subprocess.STDOUT, start_new_session=True)
        listener = threading.Thread(target=lambda: said.append(process.stdout.read()))
        listener.start()
        try:
            for wait, what in conditions.signals:
                try:
                    process.wait(wait)
                    break
                except subprocess.TimeoutExpired:
                    process.send_signal(what)
            process.wait(120)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()
            raise Wrong('it did not end within two minutes')
        finally:
            listener.join()
            process.stdout.close()
        lines = (read(log) or b'').decode('utf-8', 'replace').splitlines()
        faults = collections.Counter(' '.join(line.split(' ', 2)[:2]) for line in lines)
        code = process.returncode
        return Outcome(code if code >= 0 else None, -code if code < 0 else None,
                       said[0].decode('utf-8', 'replace'), faults, time.monotonic() - start)

    def truth(self, picture, samples):
        """{suffix: content} of a run without faults, or None if the options do not allow so many samples."""
        words = picture.words(samples)
        key = tuple(words)
        with self.lock:
            if key in self.truths:
                return self.truths[key]
        with tempfile.TemporaryDirectory(dir=self.folder) as folder:
            outcome = self.run([*words, '--threads', '2', '-o', 'x.pfm', '-o', 'x.png', '--stats', 'x.json'], folder, bare=True)
            if outcome.status not in (0, 2):
                raise Wrong('without faults: %s' % outcome)
            files = {s: read(os.path.join(folder, 'x' + s)) for s in ('.pfm', '.png', '.json')}
            found = files if outcome.status == 0 else None
        with self.lock:
            if len(self.truths) > 2000:
                self.truths.clear()
            self.truths[key] = found
        return found


class Wrong(Exception):
    pass


# ---- Pictures ------------------------------------------------------------------------------------

class Picture:
    def __init__(self, scene, options, spp, sets=None):
        self.scene, self.options, self.spp, self.sets = scene, options, spp, sets  # None: adaptive
        self.timed = False  # --time may end it sooner

    def words(self, samples=None):
        sets = ['--replications', str(self.sets)] if self.sets else []
        return [os.path.join(ROOT, 'scenes', self.scene), *self.options, *sets, '--spp', str(samples or self.spp)]

    def has_all(self, samples):
        """Whether the average number of samples is the requested one; with weights it is about that, of 1 or more each."""
        if not self.sets:
            return samples >= self.spp / 2
        return samples == -(-self.spp // self.sets) * self.sets


SCENES = ['atelier', 'cornell', 'cornell36', 'cornell36obj', 'cornellglossy', 'coursework', 'cube', 'extremes',
          'furnace', 'lanterns', 'materials', 'panel', 'penumbra']


def draw_picture(rng, spp=None, stops_anywhere=False):
    """stops_anywhere: a pixel with n of its samples equals that of a render with n."""
    scene, options = rng.choice(SCENES), ['--size', '%dx%d' % (rng.randint(1, 40), rng.randint(1, 30)),
                                          '--seed', str(rng.randrange(3))]
    spp = spp or rng.choice([1, 2, 4, 9, 16, 25, 64])
    kind = rng.random()
    sampler = rng.choice(['sobol', 'sobol', 'halton', 'independent', 'stratified'])
    if kind < 0.2:
        has_point = b'pointlight' in read(os.path.join(ROOT, 'scenes', scene + '.scene'))
        options += ['--light', 'nee' if has_point else rng.choice(['none', 'nee']), '--sampler', sampler]
    elif kind < 0.3:
        options += ['--view', rng.choice(['normal', 'depth', 'albedo', 'bvh']), '--sampler', sampler]
    else:
        options += ['--sampler', sampler, '--roulette', rng.choice(['0', '0.25', '1'])]
    return Picture(scene + '.scene', options, spp, rng.choice([1, 2, 4] + ([] if stops_anywhere else 5 * [None])))


def same(name, content, truth, exact=True):
    """Whether an output equals that of a run without faults."""
    if not name.endswith('.json'):
        return content == truth[os.path.splitext(name)[1]]
    try:
        a, b = json.loads(content), json.loads(truth['.json'])
    except ValueError:
        return False
    unlike = OF_THE_CLOCK if exact else OF_THE_CLOCK | {'rays'}
    return a.keys() == b.keys() and all(a[k] == b[k] for k in a if k not in unlike)


# ---- Films ---------------------------------------------------------------------------------------

def head_of(film):
    lines = film.split(b'\n\n', 1)[0].decode('utf-8', 'replace').splitlines()
    return dict(line.split(' ', 1) for line in lines if ' ' in line)


def rays_of(film):
    """The rays of a film; fewer than before means lost samples."""
    return int(head_of(film)['rays']) if film else 0


def samples_of(film):
    """The samples per replication, pixel by pixel, in a film of fixed replications."""
    width, height = map(int, head_of(film)['size'].split('x'))
    block = max(1, min(256, width * height // 256))  # as in film.h
    taken = struct.unpack_from('<%dQ' % -(-width * height // block), film, film.index(b'\n\n') + 2)
    return [taken[i // block] for i in range(width * height)]


def truth_of(soak, picture, film):
    """The expected files of an interrupted film: each pixel is that of a render with its samples."""
    samples = samples_of(film)
    if min(samples) == 0:
        return None
    truths = {n: soak.truth(picture, n * picture.sets) for n in set(samples)}
    if len(truths) == 1:
        return truths[samples[0]]
    width = int(head_of(film)['size'].split('x')[0])
    pfm = bytearray(truths[samples[0]]['.pfm'])
    for i, n in enumerate(samples):
        at = len(pfm) - 12 * width * (i // width + 1) + 12 * (i % width)  # rows from the bottom up
        pfm[at:at + 12] = truths[n]['.pfm'][at:at + 12]
    return {'.pfm': bytes(pfm)}  # only the final content of others is known


def parts(folder):
    return [n for n in os.listdir(folder) if '.part' in n]


# ---- One run and its verdict ---------------------------------------------------------------------

def survivable(faults):
    return all(f.split()[1] in ('EINTR', 'SHORT', 'STEP') and not f.startswith('open') for f in faults)


def check_files(soak, picture, folder, names, before, outcome, sent):
    """Returns the right files; raises Wrong if a file is neither right nor the old one."""
    changed = [n for n in names if read(os.path.join(folder, n)) != before.get(n)]
    truth = None
    if changed and sent and outcome.status != 0:
        film = read(os.path.join(folder, 'c.film'))
        truth = truth_of(soak, picture, film) if film else None
    elif changed or outcome.status == 0:
        truth = soak.truth(picture, int(outcome.samples) if picture.timed and outcome.samples else picture.spp)
    right = []
    for name in names:
        now, was = read(os.path.join(folder, name)), before.get(name)
        if now is not None and truth and is_right(name, now, truth, not sent):
            right.append(name)
        elif now != was:
            raise Wrong('%s is neither right nor what it was' % name if now is not None else '%s is gone' % name)
    return right


def is_right(name, content, truth, exact):
    if '.png' in truth or name.endswith('.pfm'):
        return same(name, content, truth, exact)
    return content.endswith(b'}\n' if name.endswith('.json') else b'IEND\xaeB`\x82')


def check_film(soak, picture, folder, before):
    """Checks that a run resumes the film to the same picture, whatever happened."""
    film = read(os.path.join(folder, 'c.film'))
    if film is None:
        if before.get('c.film') is not None:
            raise Wrong('the film is gone')
        return
    spp = picture.spp if picture.spp < ENDLESS else picture.sets * (max(samples_of(film)) + 10)
    outcome = soak.run([*picture.words(spp), '--keep', 'c.film', '-o', 'resumed.pfm'], folder)
    if outcome.status != 0:
        raise Wrong('no run goes on from the film: %s' % outcome)
    if read(os.path.join(folder, 'resumed.pfm')) != soak.truth(picture, spp)['.pfm']:
        raise Wrong('a run that went on from the film has another picture')
    os.remove(os.path.join(folder, 'resumed.pfm'))


def verdict(soak, picture, folder, names, before, conditions, outcome):
    """Returns right, in part, absent or killed; raises Wrong."""
    sent = [s for s in ENDS if conditions.sent(s)]
    if outcome.killed_by is not None:
        cut = outcome.killed_by == signal.SIGKILL and outcome.faults['power CUT']
        if not cut and not conditions.sent(outcome.killed_by):
            raise Wrong('it died of signal %d' % outcome.killed_by)
        if not cut and sent and outcome.killed_by == signal.SIGKILL:
            raise Wrong('it did not end within a minute of %s' % sent)
    right = check_files(soak, picture, folder, names, before, outcome, sent)
    tidy = outcome.killed_by is None and not outcome.faults['unlink EIO'] and not outcome.faults['power CUT']
    if tidy and parts(folder):
        raise Wrong('it left %s' % parts(folder))
    if 'c.film' in os.listdir(folder):
        check_film(soak, picture, folder, before)
    if outcome.killed_by is not None:
        return 'killed'
    if outcome.status == 0:
        if len(right) < len(names):
            raise Wrong('exit status 0 with %s alone' % right)
        if not picture.timed and not picture.has_all(outcome.samples):
            raise Wrong('exit status 0 with other samples than asked for')
        return 'right'
    if outcome.status in [ENDS[s] for s in sent]:
        if len(right) < (len(names) if outcome.samples else 0):
            raise Wrong('interrupted, with %s alone' % right)
        return 'in part' if outcome.samples else 'absent'
    lines = outcome.err.strip().splitlines()
    if outcome.status not in (1, 2, 127) or not lines or len(lines[-1]) < 5:
        raise Wrong('exit status %s without a message' % outcome.status)
    if survivable(outcome.faults) and not conditions.memory and conditions.largest is None and outcome.faults:
        raise Wrong('it did not survive what is no error')
    return 'absent'


def clean_run(soak, picture, folder, names):
    """Checks that the next run removes the temporary files."""
    outs = [w for n in names for w in (('--stats' if n.endswith('.json') else '-o'), n)]
    kept = ['--keep', 'c.film'] if any('c.film' in n for n in os.listdir(folder)) else []
    outcome = soak.run([*picture.words(), *outs, *kept], folder)
    check_files(soak, picture, folder, names, {}, outcome, [])
    if outcome.status != 0 or parts(folder):
        raise Wrong('the next run: %s, and it left %s' % (outcome, parts(folder)))


def kept(soak, picture, folder):
    """Writes c.film with about half the samples."""
    width, height = map(int, picture.options[1].split('x'))
    spp, halves = -(-picture.spp // 2), max(2, min(8, 800 // (width * height)))
    if not picture.sets and spp <= 6 * halves:  # a shorter pilot, of fewer than 4 samples, leads to other weights
        spp = picture.spp
    outcome = soak.run([*picture.words(spp), '-o', 'x.pfm', '--keep', 'c.film'], folder)
    if outcome.status != 0:
        raise Wrong('no film: %s' % outcome)
    os.remove(os.path.join(folder, 'x.pfm'))


def one_run(soak, rng, folder, picture, conditions, names=None, film=None, more=(), resume=False):
    """Returns a verdict and the outcome of a run with random outputs."""
    names = names or rng.choice([['a.pfm'], ['a.png'], ['a.pfm', 'b.png'], ['a.pfm', 'b.png', 's.json'], ['b.png', 's.json']])
    film = rng.random() < 0.4 if film is None else film
    before = {}
    for name in names:
        if rng.random() < 0.5:
            before[name] = OLD
            write(os.path.join(folder, name), OLD)
    words = [*picture.words(), '--threads', str(rng.randint(1, 4)), *more]
    words += [w for n in names for w in (('--stats' if n.endswith('.json') else '-o'), n)]
    if film:
        words += ['--keep', 'c.film']
        if resume or rng.random() < 0.5 and picture.spp < 1000:
            kept(soak, picture, folder)
            before['c.film'] = read(os.path.join(folder, 'c.film'))
    write(folder + '.command', ' '.join([soak.program, *words, '\n', *map(str, (
        conditions.faults, conditions.signals, conditions.memory, conditions.largest))]).encode())
    outcome = soak.run(words, folder, conditions, rng.getrandbits(32))
    write(folder + '.outcome', str(outcome).encode())
    result = verdict(soak, picture, folder, names, before, conditions, outcome)
    if parts(folder) or rng.random() < 0.05:
        if picture.spp < 10000:
            clean_run(soak, picture, folder, names)
    return result, outcome


# ---- Kinds of faults -----------------------------------------------------------------------------

def by_chance(rng, *faults):
    """Draws faults: each at one call, or with some probability at all calls."""
    words = []
    for fault in rng.sample(faults, rng.randint(1, len(faults))):
        words.append('%s@%d' % (fault, rng.randint(1, 8)) if rng.random() < 0.6 else
                     '%s=%.3f' % (fault, rng.choice([0.02, 0.1, 0.5])))
    return words


def run_none(soak, rng, folder):
    return one_run(soak, rng, folder, draw_picture(rng), Conditions())


def run_full_disk(soak, rng, folder):
    """A full disk: simulated with a limit of bytes or, where mounting is allowed, real with one of pages."""
    room = rng.randrange(1, 30000)
    if not soak.mounted or rng.random() < 0.3:
        return one_run(soak, rng, folder, draw_picture(rng), Conditions(['room=%d' % room]))
    real = tempfile.mkdtemp(dir=soak.mounted)
    filler = os.path.join(soak.mounted, 'filler.%d' % threading.get_ident())
    picture, before = draw_picture(rng), {}
    names = ['a.pfm', 'b.png', 's.json'][:rng.randint(1, 3)]
    soak.truth(picture, picture.spp)
    with soak.full:  # one at a time uses the disk
        try:
            if rng.random() < 0.5:
                before['a.pfm'] = OLD
                write(os.path.join(real, 'a.pfm'), OLD)
            free = os.statvfs(real)
            with open(filler, 'wb') as f:
                f.write(b'x' * max(0, free.f_bavail * free.f_frsize - room))
            words = [*picture.words(), *[w for n in names for w in (('--stats' if n.endswith('.json') else '-o'), n)],
                     *(['--keep', 'c.film'] if rng.random() < 0.5 else [])]
            outcome = soak.run(words, real)
            os.remove(filler)
            if outcome.status != 0:
                outcome.faults['write FULL'] += 1
            return verdict(soak, picture, real, names, before, Conditions(largest=1), outcome), outcome
        finally:
            os.path.exists(filler) and os.remove(filler)
            shutil.rmtree(real)


def run_file_limit(soak, rng, folder):
    result, outcome = one_run(soak, rng, folder, draw_picture(rng), Conditions(largest=rng.randrange(0, 12)))
    if 'File too large' in outcome.err:
        outcome.faults['write EFBIG'] += 1
    return result, outcome


def run_read(soak, rng, folder):
    return one_run(soak, rng, folder, draw_picture(rng),
                   Conditions(by_chance(rng, 'read:EIO', 'read:SHORT', 'read:EINTR', 'open:EIO')))


def run_write(soak, rng, folder):
    return one_run(soak, rng, folder, draw_picture(rng),
                   Conditions(by_chance(rng, 'write:EIO', 'write:ENOSPC', 'write:SHORT', 'write:EINTR')))


def run_commit(soak, rng, folder):
    return one_run(soak, rng, folder, draw_picture(rng), Conditions(by_chance(
        rng, 'fsync:EIO', 'fsync:EINTR', 'rename:EIO', 'rename:ENOSPC', 'close:EIO', 'close:EINTR', 'unlink:EIO',
        'open:ENOSPC')))


def run_interrupt(soak, rng, folder):
    what = rng.choice(list(ENDS))
    picture = draw_picture(rng, ENDLESS, stops_anywhere=True)
    result, outcome = one_run(soak, rng, folder, picture, Conditions(signals=[(rng.uniform(0, 0.3), what), (60, signal.SIGKILL)]),
                              film=True)
    outcome.faults[what.name] += 1
    return result, outcome


def run_stop(soak, rng, folder):
    picture = draw_picture(rng, rng.choice([256, 1024]), stops_anywhere=True)
    pauses = [(rng.uniform(0, 0.05), s) for _ in range(rng.randint(1, 4)) for s in (signal.SIGSTOP, signal.SIGCONT)]
    result, outcome = one_run(soak, rng, folder, picture, Conditions(signals=pauses))
    outcome.faults['SIGSTOP'] += 1
    return result, outcome


def run_kill(soak, rng, folder):
    picture = draw_picture(rng, rng.choice([16, 256, 1024]), stops_anywhere=True)
    result, outcome = one_run(soak, rng, folder, picture, Conditions(signals=[(rng.expovariate(20), signal.SIGKILL)]))
    outcome.faults['SIGKILL'] += outcome.killed_by is not None
    return result, outcome


def run_memory(soak, rng, folder):
    picture = draw_picture(rng)  # replaced by a larger one
    size = rng.choice([64, 256, 600])
    picture.options[1] = '%dx%d' % (size, size // rng.choice([1, 2, 4]))
    picture.spp, picture.sets = 1, rng.choice([None, 1, 2, 4])
    result, outcome = one_run(soak, rng, folder, picture, Conditions(memory=int(12000 * 2 ** rng.uniform(0, 4))))
    outcome.faults['memory'] += outcome.status != 0
    return result, outcome


def run_clock(soak, rng, folder):
    picture = draw_picture(rng, rng.choice([64, 256, 1024]), stops_anywhere=True)
    faults = ['real:STEP=0.3', 'steady:STEP=%g' % rng.choice([0.01, 0.2])]
    picture.timed, more = True, ['--time', '%g' % rng.choice([0.05, 20, 1000])]
    return one_run(soak, rng, folder, picture, Conditions(faults), film=False, more=more)


def run_power(soak, rng, folder):
    at = rng.choice([0, rng.randint(1, 30)])
    return one_run(soak, rng, folder, draw_picture(rng), Conditions(['power:CUT@%d' % at]))


def run_mixed(soak, rng, folder):
    faults = by_chance(rng, 'read:SHORT', 'read:EINTR', 'write:SHORT', 'write:EINTR', 'write:EIO', 'fsync:EIO',
                       'rename:EIO', 'unlink:EIO', 'real:STEP', 'steady:STEP', 'power:CUT')
    if rng.random() < 0.5:
        return one_run(soak, rng, folder, draw_picture(rng), Conditions(faults, memory=int(20000 * 2 ** rng.uniform(0, 4))))
    picture = draw_picture(rng, ENDLESS, stops_anywhere=True)
    what = rng.choice([*ENDS, signal.SIGKILL])
    # These faults could leave new files without a film that has their numbers of samples.
    faults = [f for f in faults if not f.startswith(('fsync', 'write:EIO', 'rename', 'unlink', 'power'))]
    return one_run(soak, rng, folder, picture, Conditions(faults, [(rng.uniform(0.02, 0.2), what), (60, signal.SIGKILL)]),
                   names=[rng.choice(['a.pfm', 'a.png'])], film=True)


# ---- Resumed films -------------------------------------------------------------------------------

def of_a_link(rng):
    what = rng.choice([signal.SIGKILL, signal.SIGKILL, signal.SIGKILL, *ENDS])
    faults = [[], [], [], [], ['power:CUT@%d' % rng.randint(1, 12)], ['write:ENOSPC=0.3', 'fsync:EIO=0.3', 'rename:EIO=0.1']]
    return Conditions(rng.choice(faults), [(rng.expovariate(20), what)])


def run_chain(soak, rng, folder):
    """Kills, interrupts and fails a render again and again, and resumes its film each time."""
    picture = draw_picture(rng, 1000, stops_anywhere=True)
    pixels = [int(n) for n in picture.options[1].split('x')]
    picture.spp = min(20000, 100000 // (pixels[0] * pixels[1]) + 100)
    path, all_faults, before = os.path.join(folder, 'c.film'), collections.Counter(), 0
    last = 11  # each adds a few samples: a film is written when it has them
    for link in range(last + 1):
        film = read(path)
        if rays_of(film) < before:
            raise Wrong('the film holds less than before')
        before = rays_of(film)
        conditions = Conditions() if link == last else of_a_link(rng)
        words = [*picture.words(picture.spp * (link + 1) // (last + 1)), '--threads', str(rng.randint(1, 3)), '-o', 'a.pfm', '--keep', 'c.film']
        write(folder + '.command', ' '.join([soak.program, *words, '\n', *conditions.faults, str(conditions.signals)]).encode())
        outcome = soak.run(words, folder, conditions, rng.getrandbits(32))
        write(folder + '.outcome', str(outcome).encode())
        all_faults += outcome.faults
        if outcome.killed_by == signal.SIGKILL and not outcome.faults:
            all_faults['SIGKILL'] += 1
        elif outcome.status in ENDS.values():
            all_faults['interrupted'] += 1
        elif outcome.status == 2:
            raise Wrong('it does not go on: %s' % outcome)
        elif outcome.killed_by is not None and not conditions.sent(outcome.killed_by) and not outcome.faults['power CUT']:
            raise Wrong('it died of signal %d' % outcome.killed_by)
    if outcome.status != 0:
        raise Wrong('at last: %s' % outcome)
    if read(os.path.join(folder, 'a.pfm')) != soak.truth(picture, picture.spp)['.pfm']:
        raise Wrong('in the end the picture is another one')
    if parts(folder):
        raise Wrong('it left %s' % parts(folder))
    outcome.faults = all_faults
    return 'right', outcome


def run_damage(soak, rng, folder):
    """A film that is not as it was written."""
    picture, path = draw_picture(rng), os.path.join(folder, 'c.film')
    kept(soak, picture, folder)
    film = bytearray(read(path))
    how = rng.choice(['bit', 'bits', 'cut', 'longer', 'zeros', 'exchanged', 'of another picture'])
    damaged = bytearray(film)
    at = rng.randrange(len(film))
    if how in ('bit', 'bits'):
        for _ in range(1 if how == 'bit' else rng.randint(2, 100)):
            damaged[rng.randrange(len(film))] ^= 1 << rng.randrange(8)
    elif how == 'cut':
        del damaged[at:]
    elif how == 'longer':
        damaged += bytes(rng.randrange(256) for _ in range(rng.randint(1, 600)))
    elif how == 'zeros':
        damaged[at:at + 512] = bytes(len(damaged[at:at + 512]))
    elif how == 'exchanged':
        half = len(film) // 16 * 8
        damaged = film[half:] + film[:half]
    asked = picture
    if how == 'of another picture':
        asked = Picture(picture.scene, [*picture.options, '--seed', '77'], picture.spp, picture.sets)
    write(path, damaged)
    if damaged == film and how != 'of another picture':  # zeros replaced zeros
        return 'right', Outcome(0, None, '', collections.Counter(), 0)
    outcome = soak.run([*asked.words(), '--keep', 'c.film', '-o', 'a.pfm'], folder)
    write(folder + '.outcome', (how + '\n' + str(outcome)).encode())
    outcome.faults[how] += 1
    if outcome.status != 2 or not outcome.err.strip().splitlines()[-1].startswith('c.film: '):
        raise Wrong('%s: it is not refused by name: %s' % (how, outcome))
    if read(path) != damaged or sorted(os.listdir(folder)) != ['c.film']:
        raise Wrong('%s: the refusal changed files: %s' % (how, os.listdir(folder)))
    return 'absent', outcome


KINDS = {'none': (1, run_none), 'full disk': (2, run_full_disk), 'file limit': (1, run_file_limit), 'read': (2, run_read),
         'write': (3, run_write), 'fsync, rename, close': (3, run_commit), 'Ctrl-C and its like': (2, run_interrupt),
         'stopped for a while': (1, run_stop), 'kill -9': (2, run_kill), 'memory': (2, run_memory), 'clock': (2, run_clock),
         'power': (3, run_power), 'several at once': (3, run_mixed), 'killed and resumed': (1, run_chain),
         'damaged film': (2, run_damage)}


# ---- All of them ---------------------------------------------------------------------------------

class Tally:
    COLUMNS = ['right', 'in part', 'absent', 'killed', 'wrong']

    def __init__(self):
        self.rows, self.faults, self.wrong = collections.defaultdict(collections.Counter), collections.Counter(), []

    def add(self, kind, result, faults):
        self.rows[kind]['runs'] += 1
        self.rows[kind][result] += 1
        self.rows[kind]['bitten'] += any(faults.values())
        self.faults.update(+collections.Counter(faults))

    def show(self):
        print('%-22s %7s %7s %s' % ('fault', 'runs', 'bitten', ' '.join('%7s' % c for c in self.COLUMNS)))
        total = collections.Counter()
        for kind, row in self.rows.items():
            total.update(row)
        rows = sorted(self.rows.items(), key=lambda row: [*KINDS, *EACH].index(row[0]))
        for kind, row in [*rows, ('all', total)]:
            print('%-22s %7d %7d %s' % (kind, row['runs'], row['bitten'], ' '.join('%7d' % row[c] for c in self.COLUMNS)))
        print('faults: ' + ', '.join('%s %d' % f for f in sorted(self.faults.items())))
        return total


def attempt(soak, tally, number, kind=None):
    """Run `number`, in a folder of its own, which stays if it is wrong."""
    rng = random.Random('%s/%d' % (soak.seed, number))
    drawn = rng.choices(list(KINDS), [weight for weight, _ in KINDS.values()])[0]
    kind = kind or drawn
    folder = os.path.join(soak.folder, 'run-%d' % number)
    os.mkdir(folder)
    try:
        result, outcome = KINDS[kind][1](soak, rng, folder)
        with soak.lock:
            tally.add(kind, result, outcome.faults)
    except Wrong as wrong:
        kept = os.path.join(BUILD, 'wrong-%d' % number)
        shutil.rmtree(kept, ignore_errors=True)
        shutil.copytree(folder, os.path.join(kept, 'files'))
        for s in 'command', 'outcome':
            if os.path.exists(folder + '.' + s):
                shutil.copy(folder + '.' + s, os.path.join(kept, s))
        with soak.lock:
            tally.add(kind, 'wrong', {})
            print('WRONG, run %d of seed %s (%s), kept in %s: %s' % (number, soak.seed, kind, kept, wrong), flush=True)
    shutil.rmtree(folder, ignore_errors=True)
    for s in 'command', 'outcome', 'log':
        if os.path.exists(folder + '.' + s):
            os.remove(folder + '.' + s)


def random_runs(soak, tally, options):
    numbers, end = iter(range(options.first, 10 ** 9)), time.monotonic() + options.seconds
    failure = []

    def work():
        try:
            while time.monotonic() < end and not failure:
                with soak.lock:
                    number = next(numbers)
                    if options.runs is not None and number >= options.first + options.runs:
                        return
                attempt(soak, tally, number, options.only)
        except BaseException as e:
            failure.append(e)
            raise
    workers = [threading.Thread(target=work) for _ in range(options.jobs)]
    for w in workers:
        w.start()
    for w in workers:
        w.join()
    if failure:
        sys.exit('soak: the harness failed')


EACH = ['open:EIO', 'read:EIO', 'read:SHORT', 'read:EINTR', 'write:EIO', 'write:ENOSPC', 'write:SHORT', 'write:EINTR',
        'fsync:EIO', 'fsync:EINTR', 'rename:EIO', 'close:EIO', 'close:EINTR', 'unlink:EIO', 'power:CUT']


def every_call(soak, tally):
    """A small render, and one that goes on from a film: each of their calls failed in each way."""
    picture = Picture('cube.scene', ['--size', '7x5'], 4, 2)
    for number, (fault, resume) in enumerate([(f, r) for f in EACH for r in (False, True)]):
        at = 0 if fault.startswith('power') else 1
        while True:
            rng, folder = random.Random('%s/%d/%d' % (soak.seed, number, at)), os.path.join(soak.folder, 'each-%d-%d' % (number, at))
            os.mkdir(folder)
            try:
                result, outcome = one_run(soak, rng, folder, picture, Conditions(['%s@%d' % (fault, at)]),
                                          ['a.pfm', 's.json'] if resume else ['a.pfm', 'b.png', 's.json'], film=True, resume=resume)
            except Wrong as wrong:
                tally.add(fault, 'wrong', {fault: 1})
                print('WRONG, %s@%d: %s' % (fault, at, wrong), flush=True)
                break
            finally:
                shutil.rmtree(folder)
            if not outcome.faults:
                break
            tally.add(fault, result, outcome.faults)
            at += 1


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument('program')
    parser.add_argument('--seconds', type=float, default=600)
    parser.add_argument('--each', action='store_true')
    parser.add_argument('--seed', default=os.environ.get('TEST_SEED'))
    parser.add_argument('--only', choices=KINDS)
    parser.add_argument('--runs', type=int)
    parser.add_argument('--run', type=int)
    parser.add_argument('--jobs', type=int, default=os.cpu_count())
    options = parser.parse_args()
    if sys.platform != 'linux':
        print('no library is preloaded here as on Linux: not tested')
        return
    options.first = 0
    if options.run is not None:
        options.first, options.runs, options.jobs = options.run, 1, 1
    seed = options.seed or str(random.SystemRandom().getrandbits(32))
    tally = Tally()
    os.makedirs(BUILD, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=BUILD) as folder:
        soak = Soak(options.program, seed, folder)
        soak.full, soak.mounted = threading.Lock(), mount(folder)
        print('seed %s%s' % (seed, '' if soak.mounted else '; no disk can be mounted here'), flush=True)
        try:
            if options.each:
                every_call(soak, tally)
            else:
                random_runs(soak, tally, options)
        finally:
            unmount(soak.mounted)
    total = tally.show()
    never = [k for k, row in tally.rows.items() if row['runs'] >= 30 and row['bitten'] == 0 and k != 'none' and
             not (k == 'memory' and options.program.endswith('-san'))]
    if never:
        print('never bitten: ' + ', '.join(never))
    sys.exit(1 if total['wrong'] or never or not total['runs'] else 0)


def mount(folder):
    """A small disk that can be full, or None."""
    disk = os.path.join(folder, 'disk')
    os.mkdir(disk)
    made = subprocess.run(['mount', '-t', 'tmpfs', '-o', 'size=1m', 'tmpfs', disk], capture_output=True)
    return disk if made.returncode == 0 else None


def unmount(disk):
    if disk:
        subprocess.run(['umount', disk], check=True)


if __name__ == '__main__':
    main()
