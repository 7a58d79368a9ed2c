# course/starter_check.py  8  does the starter keep its promises?
"""starter_check.py [--full] [--draw WORD]

1. The solution: every exercise is judged right.
2. The stub of each exercise alone: its judge says that the stub is still there, and no other exercise is
   wrong but those that need it.  --draw: of other weeks that could be, one is drawn for each stub.  And each
   exercise is right beside stubs of all that comes later, as a grader builds it.
3. Regions compile in any combination, without a warning, by this compiler: each alone, all, and 50 random
   subsets in which every pair is met as stub and stub, stub and solution, solution and solution.  --full:
   each pair alone as well.
4. The starter holds no line of a solution that is open or yet to come, builds and draws without a network,
   and says of every exercise that it is open.
"""
import argparse
import itertools
import os
import pathlib
import random
import re
import shutil
import subprocess
import sys
import tempfile

import regions
import starter
import trial
from regions import ROOT

failures = []


def fail(text):
    failures.append(text)
    print(f'WRONG  {text}', flush=True)


def weeks_that_see(name):
    """Weeks whose answers are compiled from a file, by what the compiler wrote of them."""
    found = []
    for path in sorted((ROOT / f'build/course{trial.SUFFIX}').glob('answers_*.d')):
        if re.search(r'(^|\s)' + re.escape(name) + r'(\s|$)', path.read_text()):
            found.append(path.stem.removeprefix('answers_'))
    return found


def needs_of(exercises):
    """What each needs, directly or not: number -> set."""
    direct = {e.number: set(e.needs) for e in exercises}
    def all_of(number):
        return set().union(*({n} | all_of(n) for n in direct.get(number, ())))
    return {n: all_of(n) for n in direct}


# ---- 1, 2: verdicts ------------------------------------------------------------------------------

def judged(stubs, weeks, numbers, solved=None):
    """State of each exercise of some weeks, where these are stubs, and the programs; text: it does not compile.

    A program that is that of the solution, bit for bit, is judged as that was.
    """
    with trial.Trial(trial.with_stubs(stubs)) as t:
        states, programs = {}, {}
        for week in weeks:
            if not t.build(week):
                return t.log[:300]
            programs[week] = (t.folder / f'answers_{week}').read_bytes()
            for n in (n for n in numbers if n.split('.')[0] == week):
                if solved and programs[week] == solved[1][week]:
                    states[n] = solved[0][n]
                    continue
                said = t.judge(n, '--mistakes', str(ROOT / 'tests/course/mistakes.txt'))
                states[n] = said['state'], said['line']
        return states, programs


def check_verdicts(exercises, found, draw):
    numbers = [e.number for e in exercises]
    needs = needs_of(exercises)
    solved = judged(set(), sorted({n.split('.')[0] for n in numbers}), numbers)
    if isinstance(solved, str):
        return fail(f'the solution does not compile: {solved}')
    for n, (state, line) in solved[0].items():
        if state != 'right':
            fail(f'the solution of {n} is judged: {line}')

    def of_stub(n):
        own, weeks = n.split('.')[0], weeks_that_see(found[n][0])
        others = [w for w in weeks if w != own]
        if draw and others:
            weeks = [own, random.Random(draw + n).choice(others)]
        return n, judged({n}, weeks, numbers, solved)
    for n, states in trial.in_parallel(of_stub, numbers):
        if isinstance(states, str):
            fail(f'with the stub of {n}: {states}')
            continue
        states = states[0]
        if states.get(n, ('',))[0] != 'open':
            fail(f'the stub of {n} is judged: {states.get(n, ("", "not at all"))[1]}')
        others = [m for m, (state, _) in states.items() if state != 'right' and m != n and n not in needs[m]]
        for m in others:
            fail(f'the stub of {n} turns {m} red: {states[m][1]}')
        print(f'{n}: open, others right', flush=True) if not others else None

    def before_the_rest(n):
        return n, judged(set(numbers[numbers.index(n) + 1:]), [n.split('.')[0]], [n], solved)
    for n, states in trial.in_parallel(before_the_rest, numbers):
        if isinstance(states, str) or states[0][n][0] != 'right':
            fail(f'{n}, and stubs of all that comes later: {states if isinstance(states, str) else states[0][n][1]}')


# ---- 3: combinations -----------------------------------------------------------------------------

def subsets(numbers, seed, count=50):
    """Random halves in which every pair is met in all of its four states."""
    chance = random.Random(seed)
    while True:
        chosen = [{n for n in numbers if chance.random() < 0.5} for _ in range(count)]
        if all(any((a in s, b in s) == state for s in chosen)
               for a, b in itertools.combinations(numbers, 2)
               for state in itertools.product((False, True), repeat=2)):
            return chosen


def check_combinations(exercises, found, full):
    numbers = [e.number for e in exercises]
    names = sorted({found[n][0].removeprefix('src/') for n in numbers})
    text = ''.join(f'#include "{name}"\n' for name in names)
    sets = [{n} for n in numbers] + [set(numbers)] + subsets(numbers, ' '.join(numbers))
    if full:
        sets += [set(pair) for pair in itertools.combinations(numbers, 2)]

    def compiles(stubs):
        with trial.Trial({'all.cpp': text, **trial.with_stubs(stubs)}) as t:
            return stubs, t.compile('all.cpp', '-fsyntax-only', '-Itests'), t.log
    count = 0
    for stubs, good, log in trial.in_parallel(compiles, sets):
        count += 1
        if not good or 'warning' in log:
            fail(f'stubs {" ".join(sorted(stubs))}: {log[:300]}')
    print(f'{count} combinations of stubs and solutions compile')


# ---- 4: the starter ------------------------------------------------------------------------------

def squeezed(text):
    """Code without comments and spaces."""
    return '\n'.join(re.sub(r'\s+', '', line.split('//')[0]) for line in text.split('\n'))


def solution_lines(found, numbers):
    """Lines of solutions that are nowhere else in src, nor in stubs or the oracle: squeezed text -> exercise.

    The head of a counting loop tells nothing."""
    elsewhere = squeezed((ROOT / 'tests/oracle/oracle.h').read_text())
    for path in sorted((ROOT / 'src').rglob('*.h')) + sorted((ROOT / 'src').rglob('*.cpp')):
        name = str(path.relative_to(ROOT))
        elsewhere += squeezed(regions.rewrite(path.read_text(), name, lambda r: r.stub if r.number in numbers else None))
    return {line: n for n in numbers for line in squeezed('\n'.join(found[n][1].solution)).split('\n')
            if len(line) >= 16 and line not in elsewhere and not re.fullmatch(r'for\(int\w+=0;\w+<\d+;\+\+\w+\)\{', line)}


def check_leaks(found, folder, numbers):
    lines = solution_lines(found, numbers)
    for path in (p for p in sorted(folder.rglob('*')) if p.is_file() and p.suffix not in ('.pfm', '.png')):
        text = path.read_text()
        squeezed_text = re.sub(r'\s+', '', text)
        for line, n in lines.items():
            if line in squeezed_text:
                fail(f'{path.relative_to(folder)} holds a line of the solution of {n}: {line}')
        if regions.BEGIN.search(text) or regions.END.search(text):
            fail(f'{path.relative_to(folder)} has a mark of the solution')
    shown = {n for n in numbers if n not in lines.values()}
    if shown:
        fail(f'no line by which a leak of {" ".join(sorted(shown))} would be known')
    print(f'{len(lines)} lines of {len(set(lines.values()))} solutions are not in the starter')


def offline():
    """Words before a command that take the network away; none if bubblewrap is missing."""
    return ['bwrap', '--dev-bind', '/', '/', '--unshare-net'] if shutil.which('bwrap') else []


def check_starter(exercises, found):
    weeks = list(dict.fromkeys(e.week for e in exercises))
    with tempfile.TemporaryDirectory(dir=ROOT / 'build') as temporary:
        for part in (['1'], ['2', '3'], weeks):
            words = ','.join(w for w in part if w in weeks)
            if not words:
                continue
            plan = starter.Plan(words)
            folder = pathlib.Path(temporary) / words.replace(',', '-')
            starter.make_starter(plan, folder)
            numbers = {e.number for e in exercises if e.week not in plan.solved_weeks}
            check_leaks(found, folder, numbers)
        environment = {k: v for k, v in os.environ.items() if k not in ('MAKEFLAGS', 'MAKELEVEL', 'FLAGS')}
        def make(*words):
            return subprocess.run([*offline(), 'make', *words], cwd=folder, capture_output=True, text=True, env=environment)
        done = make('out/cornell36.png', 'ARGS=--spp 1')
        if done.returncode or 'warning' in done.stderr or not (folder / 'out/cornell36.png').exists():
            fail(f'the starter does not draw: {done.stdout[-300:]}{done.stderr[-300:]}')
        said = make('check').stdout
        for n in (e.number for e in exercises):
            line = re.search(rf'^{re.escape(n)} .*$', said, re.M)
            if not line or not re.search(r': (open: the stub|waits for)', line[0]):
                fail(f'the starter says of {n}: {line[0] if line else "nothing"}')
    print('the starter builds and draws' + (' without a network' if offline() else ' (no bubblewrap: the network was there)'))


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument('--full', action='store_true')
    parser.add_argument('--draw', default='')
    words = parser.parse_args()
    exercises, found = regions.exercises(), regions.solution_files()
    for e in exercises:
        if e.number not in found or found[e.number][0] != f'src/{e.file}':
            fail(f'{e.number}: no region in src/{e.file}')
        elif len(found[e.number][1].solution) > 30:
            fail(f'{e.number}: more than 30 lines')
    exercises = [e for e in exercises if e.number in found]
    check_verdicts(exercises, found, words.draw)
    check_combinations(exercises, found, words.full)
    check_starter(exercises, found)
    print(f'{len(exercises)} exercises, {len(failures)} wrong')
    return 1 if failures else 0


if __name__ == '__main__':
    try:
        sys.exit(main())
    except regions.Malformed as error:
        sys.exit(f'starter-check: {error}')
