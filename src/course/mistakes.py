# course/mistakes.py  7  writes tests/course/mistakes.txt: by which answers known mistakes are told
"""mistakes.py [--only PART]

A known mistake is a mutant (tests/mutants/) with three more lines in its head:
    exercise: 2.2
    says: what it is, in the student's terms
    read: a heading of the sheet
Each is planted, alone, and the judge's probes are asked; so is each stub.  Refused are mistakes that the
judge takes for right, those with the answers of the solution or of another, and headings that no sheet has.  --only: of the others
the lines stay as they are.
"""
import argparse
import re
import sys

import regions
import starter
import trial
import mutants
from regions import ROOT

TABLE = ROOT / 'tests/course/mistakes.txt'
HEAD = '''# exercise, mutant ("stub": what the starter has), what it is, where to read, answers to the judge's probes
# Written by make mistakes.
'''


class Known:
    """A mutant that is a known mistake, or the stub of an exercise."""

    def __init__(self, exercise, name, says, read, files):
        self.exercise, self.name, self.says, self.read, self.files = exercise, name, says, read, files

    def row(self, fingerprint):
        return '\t'.join([self.exercise, self.name, self.says, self.read, ' '.join(fingerprint)])


def known_mistakes(number=None):
    """All of them in the order of the course, stubs first; of one exercise."""
    found = regions.solution_files()
    known = []
    for n in found:
        known.append(Known(n, 'stub', 'the stub is still there', '', trial.with_stubs({n})))
    for m in mutants.everything().values():
        if not m.exercise:
            continue
        if m.exercise not in found:
            raise regions.Malformed(f'{m.name}: there is no exercise {m.exercise}')
        for key in ('says', 'read'):
            if not m.head.get(key) or '\t' in m.head[key]:
                raise regions.Malformed(f'{m.name}: {key}: is missing')
        original = (ROOT / m.file).read_text()
        wrong = mutants.planted(m, original)
        within(m.name, m.file, original, wrong, m.exercise)
        known.append(Known(m.exercise, m.name, m.says, m.read, {m.file: wrong}))
    order = [e.number for e in regions.exercises()]
    known = [k for k in known if number in (None, k.exercise)]
    return sorted(known, key=lambda k: (order.index(k.exercise), k.name != 'stub', k.name))


def within(mutant, name, original, wrong, number):
    """A mistake changes its exercise's region, and nothing else."""
    def others(text):
        return regions.rewrite(text, name, lambda r: [] if r.number == number else None)
    if others(original) != others(wrong):
        raise regions.Malformed(f'{mutant}: changes more than the region of {number}')


def check_heading(known):
    sheet = starter.sheet_of(known.exercise.split('.')[0])
    if known.read and sheet and not re.search(r'^##+ (?:[\w.]+ )?' + re.escape(known.read) + '$', sheet.read_text(), re.M):
        raise regions.Malformed(f'{known.name}: {sheet.name} has no heading "{known.read}"')


def fingerprint(known):
    """(known, its answers, what is wrong with it)"""
    with trial.Trial(known.files) as t:
        if not t.build(known.exercise.split('.')[0]):
            return known, None, 'does not compile: ' + t.log[:400]
        said = t.judge(known.exercise)
        if said['state'] == 'right':
            return known, None, 'is judged right'
        if said['state'] == 'silent':
            return known, None, 'is silent: ' + said['says']
        numbers = said['fingerprint']
    # Its name must not depend on who has solved earlier weeks.
    week = known.exercise.split('.')[0]
    if week in '3R':
        with trial.Trial({**trial.in_another_style(week), **known.files}) as t:
            if not t.build(week) or not alike(t.judge(known.exercise)['fingerprint'], numbers):
                return known, None, 'has other answers beside another solution of other weeks'
    return known, numbers + (said['of_stub'] if known.name == 'stub' else []), ''


def alike(some, others):
    """Whether a judge takes these answers for equal."""
    def same(a, b):
        return a == b or abs(float(a) - float(b)) <= 1e-8 * max(1, abs(float(b)))
    return len(some) == len(others) and all(same(a, b) for a, b in zip(some, others))


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument('--only', default='')
    only = parser.parse_args().only
    everything = known_mistakes()
    chosen = [k for k in everything if k.exercise.startswith(only)]
    names = {(k.exercise, k.name) for k in everything} - {(k.exercise, k.name) for k in chosen}
    lines = {}
    for line in TABLE.read_text().splitlines():
        fields = line.split('\t')
        if len(fields) == 5 and (fields[0], fields[1]) in names:
            lines[fields[0], fields[1]] = line
    right = {n: trial.answers_of_solution(n) for n in sorted({k.exercise for k in chosen})}
    failed = 0
    for known, numbers, wrong in trial.in_parallel(fingerprint, chosen):
        try:
            check_heading(known)
        except regions.Malformed as error:
            wrong = wrong or str(error)
        if wrong:
            print(f'{known.exercise} {known.name}: {wrong}', file=sys.stderr)
            failed += 1
            continue
        row = known.row(numbers)
        if numbers == right[known.exercise]:
            print(f'{known.exercise}: {known.name} has the answers of the solution', file=sys.stderr)
            failed += 1
        for other, line in lines.items():
            if other[0] == known.exercise and line.split('\t')[4] == row.split('\t')[4]:
                print(f'{known.exercise}: {known.name} and {other[1]} have the same answers', file=sys.stderr)
                failed += 1
        lines[known.exercise, known.name] = row
        print(f'{known.exercise} {known.name}', flush=True)
    order = [(k.exercise, k.name) for k in everything]
    TABLE.write_text(HEAD + ''.join(lines[key] + '\n' for key in order if key in lines))
    counts = [sum(k.exercise == e.number and k.name != 'stub' for k in everything) for e in regions.exercises()]
    print(f'{sum(counts)} known mistakes of {sum(c > 0 for c in counts)} exercises, at least {min(counts)} of each')
    return 1 if failed else 0


if __name__ == '__main__':
    try:
        sys.exit(main())
    except (regions.Malformed, mutants.Malformed) as error:
        sys.exit(f'mistakes: {error}')
