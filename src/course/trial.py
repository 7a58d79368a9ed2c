# course/trial.py  2  the solution with some files replaced: compiled, asked, judged
"""For programs that make runs: it sets CXX and FLAGS."""
import concurrent.futures
import json
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import tempfile

import regions
from regions import ROOT

sys.path.insert(0, str(ROOT / 'tests/mutants'))  # mutants.py

CXX = shlex.split(os.environ.get('CXX', 'g++'))
FLAGS = shlex.split(os.environ.get('FLAGS', '-std=c++20 -march=native -ffp-contract=off -fno-math-errno -pthread '
                                            '-DREAL=double -Isrc'))
SUFFIX = os.environ.get('SUFFIX', '')
JOBS = os.cpu_count() or 2


def judge_of(exercise):
    """The judge's program, which make has built."""
    return ROOT / f'build/course{SUFFIX}/judge_{exercise.split(".")[0]}'


def answers_of_solution(exercise):
    """Its answers to the judge's probes, by the program that make has built."""
    with tempfile.NamedTemporaryFile(suffix='.json') as report:
        subprocess.run([str(judge_of(exercise)), '--json', report.name, exercise, '--',
                        str(judge_of(exercise)).replace('judge_', 'answers_')], capture_output=True, check=False)
        return json.loads(pathlib.Path(report.name).read_text())['fingerprint']


class Trial:
    """A folder in which files, {path: text}, take the place of those of the same name."""

    def __init__(self, files):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix='trial.', dir=ROOT / 'build'))
        self.log = ''
        for name, text in files.items():
            path = self.folder / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        shutil.rmtree(self.folder, ignore_errors=True)

    def compile(self, source, *options):
        """Whether a .cpp file compiles; self.log says why not."""
        here = self.folder / source if (self.folder / source).exists() else ROOT / source
        words = [*CXX, f'-I{self.folder}/src', f'-I{self.folder}/tests', *[f for f in FLAGS if f not in ('-MMD', '-MP')],
                 '-Itests', *options, str(here)]
        done = subprocess.run(words, cwd=ROOT, capture_output=True, text=True)
        self.log = done.stderr
        return done.returncode == 0

    def build(self, week):
        return self.compile(f'tests/course/answers_{week}.cpp', '-O1', '-w', '-o', str(self.folder / f'answers_{week}'))

    def judge(self, exercise, *options):
        """What the judge says of an exercise: its JSON."""
        report = self.folder / f'{exercise}.json'
        done = subprocess.run([str(judge_of(exercise)), '--json', str(report), *options, exercise, '--',
                               str(self.folder / f'answers_{exercise.split(".")[0]}')],
                              capture_output=True, text=True)
        if done.returncode == 2:
            raise RuntimeError(f'{exercise}: {done.stderr}')
        result = json.loads(report.read_text())
        result['line'] = done.stdout.split('\n', 1)[0]
        return result


def with_regions(lines):
    """Files of src in which exercises have these lines, {number: lines}, and the others are solved: {path: text}."""
    names = {regions.solution_files()[n][0] for n in lines}
    return {name: regions.rewrite((ROOT / name).read_text(), name, lambda r: lines.get(r.number)) for name in sorted(names)}


def with_stubs(numbers):
    """The same with stubs."""
    return with_regions({n: regions.solution_files()[n][1].stub for n in numbers})


def in_another_style(but):
    """Weeks other than this one as someone else has solved them, and as right, each below a line "@@ NUMBER"."""
    _, *parts = re.split(r'^@@ (.*)\n', (ROOT / 'tests/course/styles').read_text(), flags=re.M)
    return with_regions({n: text.splitlines() for n, text in zip(parts[::2], parts[1::2]) if n.split('.')[0] != but})


def in_parallel(work, items):
    """work(item) of each, in their order, on all cores."""
    with concurrent.futures.ThreadPoolExecutor(JOBS) as pool:
        yield from pool.map(work, items)
