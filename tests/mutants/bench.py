# mutants/bench.py  plants one mutant in a copy of the project, compiles and tests it
import contextlib
import os
import re
import shlex
import shutil
import signal
import subprocess
import tempfile
import threading
from pathlib import Path

import kept
import mutants
from mutants import ROOT, source

LIMIT, BASELINE_LIMIT = 120, 80  # seconds of CPU of a mutant's tests, and of the same without it
COMPILER = shlex.split(os.environ.get('CXX', '')) + shlex.split(os.environ.get('FLAGS', ''))
FAST = '-O0' if 'clang' in ''.join(COMPILER[:1]) else '-Og'  # the level that compiles and runs a test soonest


class Bench:
    """Copies of the project, in which mutants are planted."""

    def __init__(self, of_test):
        (ROOT / 'build').mkdir(exist_ok=True)
        self.top = Path(tempfile.mkdtemp(prefix='mutants.', dir=ROOT / 'build'))
        self.tree, self.of_test, self.baselines, self.running = self.top / 'tree', of_test, {}, set()
        self.locks = {test: threading.Lock() for test in of_test}
        self.tree.mkdir()
        subprocess.run(['cp', '-R', *kept.PROJECT, self.tree], cwd=ROOT, check=True)
        commands = [[level, '-x', 'c++-header', '-o', f'{self.top}/std{level}.h.gch', 'tests/std.h'] for level in (FAST, '-O1')]
        for words in commands + [[FAST, '-c', '-o', self.top / 'main.o', 'tests/main.cpp']]:
            subprocess.run([*COMPILER, *words], cwd=ROOT, check=True)

    def execute(self, folder, seconds, *words):
        """Exit status of a command, or timeout; what it leaves running ends with it.  Its memory is what it writes: Node.js
        reserves more address space than there is."""
        limits = f'ulimit -d 8000000 && ulimit -S -t {seconds} && exec "$@"'
        with open(folder / 'log', 'wb') as log:
            process = subprocess.Popen(['sh', '-c', limits, '-', *words], cwd=folder, stdin=subprocess.DEVNULL, stdout=log,
                                       stderr=log, start_new_session=True)
        self.running.add(process.pid)
        with contextlib.suppress(subprocess.TimeoutExpired):
            process.wait(5 * seconds)
        status = process.poll()
        self.running.discard(process.pid)
        kill(process.pid)
        process.wait()
        return 'timeout' if status in (None, -signal.SIGXCPU, -signal.SIGKILL) else status

    def build(self, folder, level, test, programs, wrong={}):
        """Copies the project but for {file: its wrong text}; whether the test and its programs compile."""
        subprocess.run(['cp', '-al', self.tree, folder], check=True)
        (folder / 'build').mkdir()
        if wrong and (pages := self.top / f'{test}{level}/build/web').exists():
            subprocess.run(['cp', '-a', pages, folder / 'build'], check=True)  # make knows what the mutant makes old
        for file, text in wrong.items():
            (folder / file).unlink()
            (folder / file).write_text(text)
            shutil.copymode(self.tree / file, folder / file)
        for output, cpp, words in [('test', source('tests', test), ['-include', f'{self.top}/std{level}.h', self.top / 'main.o']),
                                   *[(f'build/{p}', source('src', p), []) for p in programs]]:
            if wrong and kept.included(cpp).isdisjoint(map(Path, wrong)):
                os.link(self.top / f'{test}{level}' / output, folder / output)  # the same as without the mutant
            elif self.execute(folder, 600, *COMPILER, level, *words, '-o', output, cpp) != 0:
                return False
        return True

    def run(self, folder, case, seconds):
        """green, red (at the first failed check), or what else happened."""
        status = self.execute(folder, seconds, './test', '-aa=1', *([f'-tc={case}'] if case else []))
        last = (folder / 'log').read_text(errors='replace').rstrip().split('\n')[-1]
        if status in (0, 'timeout'):
            return status or 'green'
        if status == 1 and re.fullmatch(r'\d+ passed, \d+ failed', last):
            return 'no such test case' if last == '0 passed, 0 failed' else 'red'
        return 'crash' if status < 0 or status > 128 else f'exit status {status}'

    def baseline(self, test):
        """The error of a test without a mutant, or nothing; and its level of optimisation.  The first of its mutants finds
        them; the others wait."""
        with self.locks[test]:
            if test in self.baselines:
                return self.baselines[test]
            those, wrong = self.of_test[test], []
            cases = sorted({m.case for m in those})
            # The compiler takes most of the time, unless a test computes much, or a program that it runs.
            for level, seconds in ((FAST, 10), ('-O1', BASELINE_LIMIT)):
                folder = self.top / f'{test}{level}'
                if not self.build(folder, level, test, sorted({p for m in those for p in m.program.split()})):
                    wrong = [f'{test} does not compile, see {folder}/log']
                    break
                states = [(case, self.run(folder, case, seconds)) for case in (cases[:1] if '' in cases else cases)]
                wrong = [f'without a mutant: {test} {case}: {state}' for case, state in states if state != 'green']
                if not wrong:
                    break
            self.baselines[test] = '; '.join(wrong), level
            return self.baselines[test]

    def verdict(self, m):
        folder, (state, level) = self.top / m.name, self.baseline(m.test)
        if not state:
            wrong = mutants.planted(m, (self.tree / m.file).read_text())
            built = self.build(folder, level, m.test, m.program.split(), {m.file: wrong})
            state = self.run(folder, m.case, LIMIT) if built else f'does not compile, see {folder}/log'
        verdicts = {'red': 'killed', 'crash': 'killed by a crash', 'timeout': 'killed by a timeout', 'green': 'SURVIVED'}
        if m.equivalent:
            verdicts = {'green': 'equivalent', 'red': f'ERROR: seen by {m.test}, so not equivalent'}
        verdict = verdicts.get(state, f'ERROR: {state}')
        if verdict.startswith(('killed', 'equivalent')):
            shutil.rmtree(folder, ignore_errors=True)
        return verdict


def kill(group):
    with contextlib.suppress(ProcessLookupError):
        os.killpg(group, signal.SIGKILL)
