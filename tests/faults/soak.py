#!/usr/bin/env python3
# faults/soak.py  renders while a call fails or the power is cut: each file is right, or what it was
"""soak.py [--seconds S] [--seed N] [--first M] [--runs K] [--each] PENUMBRA

Renders small pictures of scenes/, each with one fault of disk.cpp at a random call, until the time is
up, or K times.  --seed N --first M --runs 1 repeats run M.  --each fails every call of two small
renders instead, in every way.

Errors are: a file that is neither the old one nor right; exit status 0 without all files, another
status without a message or without a reason; temporary files that a run leaves without being killed,
or that the next one does not remove; a film that does not resume to the same picture.
"""
import argparse
import collections
import itertools
import json
import os
import random
import signal
import subprocess
import sys
import tempfile
import time

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
FAULTS = ['open EIO', 'write EIO', 'write ENOSPC', 'write SHORT', 'write EINTR', 'fsync EIO', 'fsync EINTR', 'rename EIO',
          'close EIO', 'close EINTR', 'unlink EIO', 'power CUT']
FILES, FILM = ('a.pfm', 'b.png', 's.json'), 'c.film'
OUTPUTS = ['-o', 'a.pfm', '-o', 'b.png', '--stats', 's.json', '--keep', FILM]
OF_THE_CLOCK = {'seconds', 'cpu_seconds', 'mrays_per_second', 'seconds_to_half_d_rel', 'peak_memory_bytes', 'threads'}
SCENES = ['atelier', 'cornell', 'cornell36', 'cornell36obj', 'cornellglossy', 'coursework', 'cube', 'extremes', 'furnace',
          'lanterns', 'materials', 'panel', 'penumbra']


class Wrong(Exception):
    pass


def library(folder):
    """Compiles disk.cpp and returns its path."""
    made = os.path.join(folder, 'disk.so')
    subprocess.run([*(os.environ.get('CXX') or 'c++').split(), '-std=c++20', '-O1', '-shared', '-fPIC', '-o', made,
                    os.path.join(ROOT, 'tests/faults/disk.cpp'), '-ldl'], check=True)
    return made


def drawn(rng):
    """The words of a small picture without its samples, how many a film has that goes on, and how many at last."""
    spp, replications = rng.choice([1, 4, 16, 64]), rng.choice(['1', '2', '4', 'adaptive'])
    words = [rng.choice(SCENES), '--size', '%dx%d' % (rng.randint(1, 40), rng.randint(1, 30)), '--seed', str(rng.randrange(3)),
             '--sampler', rng.choice(['sobol', 'halton', 'independent', 'stratified']), '--replications', replications]
    # Weights follow from the first samples, whose number must stay.
    return words, spp if replications == 'adaptive' else -(-spp // 2), spp


def scene_of(words):
    return [os.path.join(ROOT, 'scenes', words[0] + '.scene'), *words[1:]]


def files_of(folder):
    """What is the same in every run."""
    def content(name):
        path = os.path.join(folder, name)
        if not os.path.exists(path):
            return None
        with open(path, 'rb') as f:
            found = f.read()
        try:
            return {k: v for k, v in json.loads(found).items() if k not in OF_THE_CLOCK} if name == 's.json' else found
        except ValueError:
            return found
    return {name: content(name) for name in (*FILES, FILM)}


class Soak:
    def __init__(self, program, folder):
        self.program, self.folder, self.disk, self.truths = os.path.abspath(program), folder, library(folder), {}

    def run(self, words, folder, fault=''):
        """(status, what it printed, whether the fault came)."""
        log = folder + '.log'
        environment = dict(os.environ)
        if fault:
            environment.update(LD_PRELOAD=self.disk, DISK_FAULT='%s %s %s' % (folder, fault, log),
                               ASAN_OPTIONS='verify_asan_link_order=0:' + os.environ.get('ASAN_OPTIONS', ''))
        try:
            done = subprocess.run([self.program, *words], cwd=folder, env=environment, stdin=subprocess.DEVNULL, timeout=120,
                                  stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        except subprocess.TimeoutExpired:
            raise Wrong('it did not end within two minutes')
        came = os.path.exists(log)
        if came:
            os.remove(log)
        return done.returncode, done.stdout.decode('utf-8', 'replace').strip(), came

    def clean(self, words, spp, folder):
        """A run without faults."""
        status, said, _ = self.run([*scene_of(words), '--spp', str(spp), *OUTPUTS], folder)
        if status != 0:
            raise Wrong('without faults: status %d: %s' % (status, said))

    def truth(self, words, spp):
        """The files of a run without faults."""
        key = (*words, spp)
        if key not in self.truths:
            with tempfile.TemporaryDirectory(dir=self.folder) as folder:
                self.clean(words, spp, folder)
                self.truths[key] = files_of(folder)
        return self.truths[key]

    def one_run(self, rng, picture, fault, at, resume):
        """(whether the fault came, the verdict); raises Wrong."""
        words, fewer, spp = picture
        truth = self.truth(words, spp)
        with tempfile.TemporaryDirectory(dir=self.folder) as folder:
            if resume:
                self.clean(words, fewer, folder)
            for name in FILES:
                with open(os.path.join(folder, name), 'wb') as f:
                    f.write(b'old')
                if rng.random() < 0.5:
                    os.remove(f.name)
            before = files_of(folder)
            status, said, came = self.run([*scene_of(words), '--spp', str(spp), '--threads', str(rng.randint(1, 3)), *OUTPUTS], folder,
                                          '%s %d %d' % (fault, at, rng.getrandbits(32)))
            after = files_of(folder)
            for name in FILES:
                if after[name] != truth[name] and (after[name] != before[name] or status == 0):
                    raise Wrong('status %d, and %s is neither right nor what it was' % (status, name))
            if not after[FILM] and (before[FILM] or status == 0):
                raise Wrong('the film is gone')
            if status < 0 and (fault, status) != ('power CUT', -signal.SIGKILL):
                raise Wrong('it died of signal %d' % -status)
            if status > 0 and (status > 2 or not said or not came or fault.split()[1] in ('EINTR', 'SHORT')):
                raise Wrong('status %d: %s' % (status, said))
            if fault not in ('unlink EIO', 'power CUT'):
                expect_no_parts(folder)
            self.clean(words, spp, folder)  # goes on from the film, if there is one
            expect_no_parts(folder)
            again = files_of(folder)
            if any(again[n] != truth[n] for n in ('a.pfm', 'b.png')):
                raise Wrong('the next run has another picture')
            return came, 'right' if status == 0 else 'absent' if status > 0 else 'killed'


def expect_no_parts(folder):
    parts = [n for n in os.listdir(folder) if '.part' in n]
    if parts:
        raise Wrong('it left %s' % parts)


def attempt(tally, name, fault, run):
    """Runs it and returns whether the fault came."""
    try:
        came, verdict = run()
    except Wrong as wrong:
        came, verdict = False, 'wrong'
        print('WRONG, %s (%s): %s' % (name, fault, wrong), flush=True)
    tally[fault].update({'runs': 1, 'bitten': came, verdict: 1})
    return came


def random_runs(soak, tally, seed, seconds, numbers):
    end = time.monotonic() + seconds
    for number in numbers:
        if time.monotonic() > end:
            return
        rng = random.Random('%s/%d' % (seed, number))
        fault = rng.choice(FAULTS + len(FAULTS) * ['power CUT'])  # what a power cut leaves has most forms
        run = rng, drawn(rng), fault, rng.randint(0, 40) if fault == 'power CUT' else rng.randint(1, 8), rng.random() < 0.5
        attempt(tally, 'run %d of seed %s' % (number, seed), fault, lambda: soak.one_run(*run))


def every_call(soak, tally, seed):
    """A small render, and one that goes on from a film."""
    picture = ['cube', '--size', '7x5', '--replications', '2'], 2, 4
    for fault in FAULTS:
        for resume in False, True:
            # When the program has ended, what is lost is drawn several times.
            for number, at in enumerate(itertools.chain(10 * [0] if fault == 'power CUT' else [], itertools.count(1))):
                run = random.Random('%s/%s/%d' % (seed, fault, number)), picture, fault, at, resume
                if not attempt(tally, 'call %d' % at, fault, lambda: soak.one_run(*run)):
                    break


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument('program')
    parser.add_argument('--seconds', type=float, default=600)
    parser.add_argument('--each', action='store_true')
    parser.add_argument('--seed', default=os.environ.get('TEST_SEED') or str(random.SystemRandom().getrandbits(32)))
    parser.add_argument('--first', type=int, default=0)
    parser.add_argument('--runs', type=int)
    options = parser.parse_args()
    if sys.platform != 'linux':
        print('no library is preloaded here as on Linux: not tested')
        return
    print('seed %s' % options.seed, flush=True)
    tally = collections.defaultdict(collections.Counter)
    with tempfile.TemporaryDirectory() as folder:
        soak = Soak(options.program, folder)
        if options.each:
            every_call(soak, tally, options.seed)
        else:
            first = options.first
            random_runs(soak, tally, options.seed, options.seconds,
                        itertools.count(first) if options.runs is None else range(first, first + options.runs))
    tally['all'] = sum(tally.values(), collections.Counter())
    columns = ['runs', 'bitten', 'right', 'absent', 'killed', 'wrong']
    print('%-12s' % 'fault', *('%7s' % c for c in columns))
    for fault in filter(tally.get, [*FAULTS, 'all']):
        print('%-12s' % fault, *('%7d' % tally[fault][c] for c in columns))
    sys.exit(1 if tally['all']['wrong'] or not tally['all']['bitten'] else 0)


if __name__ == '__main__':
    main()
