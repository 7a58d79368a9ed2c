# course/plant.py  9  a student's copy of the project with one wrong line in it: find the bug
"""plant.py --mutant NAME|random [--weeks 1-5] [--seed WORD] [--no-pictures] FOLDER

Writes FOLDER/N/ and FOLDER/N.tar.gz, N being the next number: the project with all exercises solved, and
one mutant of tests/mutants/ in it.  FOLDER/N.key, which is not for students, says which.  In the copy are
no judges, since the one that is red would say where to look: there is what the pictures ought to be, and
a test that the student writes.  random: one of the known mistakes of these weeks' exercises.

Refused are mutants that the copy does not hold, that no test can see, that do not compile, and that make
the compiler warn: it would say where.
"""
import argparse
import difflib
import os
import pathlib
import random
import re
import shutil
import subprocess
import sys

import regions
import starter
import trial
import mutants
from regions import ROOT

README = '''# Find the bug

One line of this renderer is wrong; everything else is right.

    make                 # draws every scene into out/
    make check           # pictures beside the expected ones (out/check/), and your test

1. Where does it show?  `make check` draws a picture for each week, beside the expected one and their
   difference.  Not every bug shows in a picture.
2. Write a test into `tests/course/hunt.cpp` that fails in this copy and would pass without the bug.
   You may change the whole file; `tests/oracle/README.md` says what the oracle can do.
3. Say in its first line where the bug is: `// FOUND src/folder/file.h:LINE`.

Hand in `tests/course/hunt.cpp`.  Points: the file, the line (within two lines), a test that fails with the bug
and passes without it.
'''


class Refused(Exception):
    """Why this mutant is no exercise."""


def candidates(plan):
    """Mutants to draw from: known mistakes of the open weeks that the copy holds, but for tests."""
    return [m for m in mutants.everything().values()
            if m.exercise in {e.number for e in plan.open} and m.file != 'src/course/my_tests.h']


def formatted(text, name):
    """Formatted like this project, if clang-format is there: a line of another shape would be conspicuous."""
    if not shutil.which('clang-format'):
        return text
    done = subprocess.run(['clang-format', f'--assume-filename={ROOT / name}'], input=text, cwd=ROOT,
                          capture_output=True, text=True)
    return done.stdout if done.returncode == 0 else text


def plant(mutant, folder):
    """The wrong lines in place of the right ones; (first, last) of the copy's lines that changed."""
    if 'equivalent' in mutant.head:
        raise Refused('it is equivalent: no test can see it')
    path = folder / mutant.file
    if not path.exists():
        raise Refused(f'the copy does not hold {mutant.file}')
    right = path.read_text()
    try:
        wrong = mutants.planted(mutant, right)
    except mutants.Malformed as error:
        raise Refused(str(error))
    if formatted(right, mutant.file) == right:
        wrong = formatted(wrong, mutant.file)
    if any(len(line) > 100 for line in wrong.split('\n')):
        raise Refused('its lines are longer than others: install clang-format')
    if wrong == right:
        raise Refused('it changes nothing but spaces')
    path.write_text(wrong)
    changes = [c for c in difflib.SequenceMatcher(None, right.split('\n'), wrong.split('\n'), False).get_opcodes()
               if c[0] != 'equal']
    return changes[0][3] + 1, max(changes[-1][4], changes[0][3] + 1)


def compile_all(folder):
    """Every header of the copy, with all warnings; src/web has another file system."""
    names = sorted(str(p.relative_to(folder / 'src')) for p in (folder / 'src').rglob('*.h') if p.parent.name != 'web')
    text = ''.join(f'#include "{name}"\n' for name in names)
    done = subprocess.run([*trial.CXX, '-std=c++20', '-march=native', '-ffp-contract=off', '-fno-math-errno', '-DREAL=double',
                           '-Wall', '-Wextra', '-Wpedantic', '-Wshadow', '-fsyntax-only', '-Isrc', '-x', 'c++', '-'],
                          input=text, cwd=folder, capture_output=True, text=True)
    if done.returncode:
        raise Refused('it does not compile: ' + done.stderr[:300])
    if done.stderr:
        raise Refused('the compiler warns of it: ' + done.stderr[:300])


def write_copy(plan, folder):
    """The project, solved; a place for a test, and no judges."""
    shutil.rmtree(folder, ignore_errors=True)
    starter.write_sources(plan, folder)
    starter.write_rest(plan, folder)
    starter.write(folder / 'README.md', README)
    # Without judges there is nothing to report.
    starter.write(folder / 'Makefile', re.sub(r'\nreport:.*\n\t.*\n', '', (folder / 'Makefile').read_text()))
    tests = ROOT / 'tests'
    for name in ('oracle/oracle.h', 'oracle/README.md', 'course/hunt.cpp'):
        starter.write(folder / 'tests' / name, (tests / name).read_text())
    for name, source in (('check', 'hunt'), ('picture', 'picture')):
        starter.write(folder / 'tests/course' / name, (tests / 'course' / source).read_text(), True)
    keep = starter.rows((tests / 'course/pictures.txt').read_text(), lambda key: key.split('.')[0] in plan.weeks)
    starter.write(folder / 'tests/course/pictures.txt', keep)


def pictures(folder):
    """How far each picture of the copy is from the expected one: what make check says there."""
    environment = {k: v for k, v in os.environ.items() if k not in ('MAKEFLAGS', 'MAKELEVEL', 'FLAGS', 'SUFFIX')}
    try:
        done = subprocess.run(['make', '-s', 'check'], cwd=folder, env=environment, capture_output=True, text=True, timeout=600)
        if done.stderr.strip():
            raise Refused('the copy says what it should not: ' + done.stderr[:300])
        return [line.strip() for line in done.stdout.splitlines() if 'picture' in line]
    except subprocess.TimeoutExpired:
        raise Refused('its pictures take more than 10 minutes')
    finally:
        for rest in ('build', 'out'):
            shutil.rmtree(folder / rest, ignore_errors=True)


def key_of(mutant, lines, shown):
    rows = [('mutant', mutant.name), ('file', mutant.file), ('lines', '{}-{}'.format(*lines)),
            ('what', mutant.what), ('exercise', mutant.exercise),
            ('seen by', mutant.test)] + [('pictures', line) for line in shown]
    return ''.join(f'{name}: {value}\n' for name, value in rows if value)


def make_copy(mutant, plan, folder, suffix=None):
    """The copy and its key; nothing is left of what is refused.  Without a suffix, without pictures."""
    try:
        write_copy(plan, folder)
        lines = plant(mutant, folder)
        compile_all(folder)
        shown = []
        if suffix is not None:
            starter.draw_expected(plan, folder, suffix)
            shown = pictures(folder)
    except BaseException:
        shutil.rmtree(folder, ignore_errors=True)
        raise
    starter.pack(folder)
    pathlib.Path(f'{folder}.key').write_text(key_of(mutant, lines, shown))


def next_number(folder):
    numbers = [int(p.name.split('.')[0]) for p in folder.glob('*') if re.match(r'\d+(\.key|\.tar\.gz)?$', p.name)]
    return max(numbers, default=0) + 1


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument('--mutant', required=True)
    parser.add_argument('--weeks', default='1-5')
    parser.add_argument('--seed')
    parser.add_argument('--no-pictures', action='store_true')
    parser.add_argument('folder', type=pathlib.Path)
    words = parser.parse_args()
    plan = starter.Plan(words.weeks, solved=True)
    suffix = None if words.no_pictures else os.environ.get('DRAW_SUFFIX', '-plain')
    if words.mutant == 'random':
        chosen = candidates(plan)
        (random.Random(words.seed) if words.seed else random.SystemRandom()).shuffle(chosen)
    else:
        chosen = [m for name, m in mutants.everything().items() if name == words.mutant]
    top = words.folder.resolve()
    copy = top / str(next_number(top))
    why = f'there is no mutant {words.mutant}' if words.mutant != 'random' else 'there is none to draw from'
    for mutant in chosen:
        try:
            make_copy(mutant, plan, copy, suffix)
            print(f'{words.folder}/{copy.name}, {copy.name}.tar.gz: for a student; {copy.name}.key says what it is')
            return 0
        except Refused as refused:
            why = f'{mutant.name}: {refused}'
    print(f'plant: {why}', file=sys.stderr)
    return 1


if __name__ == '__main__':
    try:
        sys.exit(main())
    except (regions.Malformed, mutants.Malformed) as error:
        sys.exit(f'plant: {error}')
