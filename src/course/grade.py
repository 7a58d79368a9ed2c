# course/grade.py  15  grades what students handed in
"""grade.py [--weeks 1-3] [--seed N] [--jobs N] [--out FOLDER] [--sandbox user] SUBMISSIONS

Every folder or archive in SUBMISSIONS is what one student handed in, or part of it.  Of it only the
regions of the exercises are taken.  Each is put alone into the solution, then all together; both are
compiled and run in a sandbox, and judged by numbers that come over a pipe.  Writes grade.md and
grade.json into FOLDER/students/NAME, FOLDER/class.md, grades.csv, moodle.csv and canvas.csv, and the
regions of all into FOLDER/jplag; FOLDER is SUBMISSIONS-grades unless it is said.  A student with a grade.json of the same submission, seed and
solution is not graded again: a grading that was stopped resumes.
"""
import argparse
import concurrent.futures
import contextlib
import fcntl
import os
import pathlib
import secrets
import shutil
import sys
import tempfile
import threading
import time
from dataclasses import replace

import regions
import reports
import sandbox
import similar
import submission
from region import canonical, region, without_comments
from starter import Plan
from submission import Problem
from workshop import Broken, Workshop, digest_of

WASTE = 100  # seconds of processor time of a submission that its endless loops may use up


class Student:
    """One submission: its regions, or what is wrong with them, and their verdicts."""

    def __init__(self, handed_in, shop, numbers):
        self.name, self.number, self.shop, self.numbers = handed_in.name, handed_in.number, shop, numbers
        self.verdicts, self.texts, self.original, self.wasted = {}, {}, {}, 0
        self.lock = threading.Lock()
        files = submission.read(handed_in.paths, list(dict.fromkeys(shop.solutions[n][0] for n in numbers)))
        for number in numbers:
            self.take(number, files)
        self.key = digest_of([shop.key, str(shop.seed), self.name,
                              *(f'{n} {self.original[n].text if n in self.original else self.verdicts[n]}' for n in numbers)])

    def take(self, number, files):
        """Their region, if it is one that may be compiled."""
        file, solution = self.shop.solutions[number]
        try:
            if isinstance(files[file], Problem):
                raise files[file]
            self.original[number] = region(files[file], number, file)
        except Problem as problem:
            self.verdicts[number] = verdict('missing', str(problem))
            return
        code = canonical(self.original[number].text)
        if code == canonical('\n'.join(solution.stub)):
            self.verdicts[number] = verdict('open')
            return
        try:
            self.texts[number] = replace(self.original[number], text=without_comments(self.original[number]))
        except Problem as problem:
            self.verdicts[number] = verdict('refused', str(problem))

    def written(self):
        """Their own regions, whatever they are worth: exercise -> text."""
        return {n: r.text for n, r in self.original.items() if self.verdicts.get(n, {}).get('state') != 'open'}

    def judge(self, number, texts, scratch):
        """One judgement, unless too much time was wasted before."""
        with self.lock:
            if self.wasted > WASTE:
                return verdict('not judged', f'others of the submission had to be stopped, after {self.wasted} s in all')
        try:
            found = self.shop.judged(number, texts, scratch)
        except OSError as error:
            return verdict('not judged', f'on this machine: {error}')
        with self.lock:
            self.wasted += found.get('wasted', 0)
        return found

    def grade(self, pool, scratch, worth):
        """Each exercise alone, then all that may be compiled together, with stubs where nothing was handed in."""
        alone = {n: pool.submit(self.judge, n, self.shop.with_later_stubs(n, self.texts[n]), scratch) for n in self.texts}
        alone = {n: future.result() for n, future in alone.items()}
        fit = {n: self.texts[n] for n in self.texts if alone[n]['state'] in ('right', 'wrong')}
        whole = {**{n: self.shop.stub(n) for n in self.numbers if n not in self.texts}, **fit}
        together = {n: pool.submit(self.judge, n, whole, scratch) for n in fit}
        together = {n: future.result() for n, future in together.items()}
        self.shop.forget(scratch)
        self.verdicts.update(alone)
        parts = {n: self.part(n, together.get(n), worth[n]) for n in self.numbers}
        return {'student': reports.plain(self.name), 'number': self.number, 'key': self.key, 'seed': self.shop.seed, 'course': self.shop.key,
                'sum': round(sum(p['points'] for p in parts.values()), 6), 'of': sum(p['of'] for p in parts.values()),
                'sandbox': sandbox.told(), 'exercises': parts}

    def part(self, number, together, worth):
        """What the reports say of an exercise."""
        exercise, found = self.shop.exercises[number], self.verdicts[number]
        items = [{'what': reports.plain(i['what']), 'kind': i['kind'], 'right': i['right'], 'costs': i['costs'],
                  'seen': reports.plain(i['seen'])}
                 for i in found['items']]
        messages = []
        if found['state'] == 'not compiled':
            messages = reports.own_messages(found['compiler'], self.original[number]) or [
                'no error lies in your own lines: is a brace, a bracket or a semicolon missing, or one too many?']
        return {'title': exercise.title, 'points': round(exercise.points * reports.share(found, *worth), 6),
                'of': exercise.points, 'state': found['state'], 'line': reports.headline(number, found), 'items': items,
                'mistake': reports.plain(found['says']) if found.get('named') else '', 'look': reports.plain(reports.look(found)),
                'compiler': messages, 'together': together['state'] if together else ''}


def verdict(state, says=''):
    return {'state': state, 'says': says, 'items': []}


# ---- The work ------------------------------------------------------------------------------------

def duration(seconds):
    minutes = int(seconds) // 60
    return f'{seconds:.0f} s' if minutes < 2 else f'{minutes} min' if minutes < 120 else f'{minutes // 60} h {minutes % 60} min'


def say(text):
    print(text, file=sys.stderr, flush=True)


def seed_of(words, out):
    """The given one; that of a grading that was stopped; or a fresh one."""
    path = out / 'seed'
    if words.seed is None:
        try:
            return int(path.read_text())
        except (OSError, ValueError):
            words.seed = secrets.randbelow(1 << 62)
    reports.write(str(path), f'{words.seed}\n')
    return words.seed


@contextlib.contextmanager
def opened(words, seed, work):
    """(the workshop, the exercises of these weeks, their worth, a room for what is built)."""
    shop = Workshop(words.cache, seed)
    numbers = [e.number for e in Plan(words.weeks or weekly()).open if e.number in shop.solutions]
    if not numbers:
        raise Broken('no exercise of these weeks has a region, answers and a judge')
    say('the solution and its stubs are judged first')
    with sandbox.room(work) as room:
        shop.prepare(words.jobs, numbers, room)
        with scratch_in(room) as scratch:
            worth = shop.weigh(words.jobs, numbers, scratch)
        yield shop, numbers, worth, room


def grade_all(words, out):
    """Every student who is not graded yet; then the tables."""
    with opened(words, seed_of(words, out), out / '.work') as (shop, numbers, worth, room):
        students = [Student(one, shop, numbers) for one in submission.submissions(words.submissions)]
        say(f'{reports.counted(len(students), "submission")}, {reports.counted(len(numbers), "exercise")}, seed {shop.seed}')
        grades, began, fresh = [], time.monotonic(), 0
        with concurrent.futures.ThreadPoolExecutor(words.jobs) as pool:
            for count, student in enumerate(students, 1):
                folder = str(out / 'students' / student.name)
                grade = reports.load(folder)
                if not grade or grade.get('key') != student.key:
                    start = time.monotonic()
                    with scratch_in(room) as scratch:
                        grade = student.grade(pool, scratch, worth)
                    reports.save(folder, grade)
                    fresh += 1
                    now = time.monotonic()
                    left = (now - began) / fresh * (len(students) - count)
                    say(f'{count} of {len(students)}  {grade["student"]}: {reports.points(grade["sum"])} of {grade["of"]} points, '
                        f'{now - start:.1f} s; {duration(left)} left')
                grades.append(grade)
    conclude(out, shop, numbers, students, grades)
    flagged = sum(bool(reports.flags(g)) for g in grades)
    say(f'{out}/grades.csv: {reports.counted(len(grades), "student")}, {fresh} graded now'
        + (f'; {flagged} to look at: see the last column' if flagged else ''))
    if sandbox.told():
        say(sandbox.told())
    if any(not g['number'] for g in grades):
        say(reports.without_number(grades))


def conclude(out, shop, numbers, students, grades):
    """What is said of all students together."""
    solutions = {n: ('\n'.join(shop.solutions[n][1].solution), '\n'.join(shop.solutions[n][1].stub)) for n in numbers}
    written = {s.name: s.written() for s in students}
    for student, likes in zip(grades, similar.likenesses(written, solutions).values()):
        student['equal'] = {n: reports.plain(like) for n, like in likes.items()}
    similar.write_for_jplag(out / 'jplag', written, solutions)
    reports.tables(str(out), numbers, grades)
    reports.write(str(out / 'class.md'), reports.class_page(numbers, grades))


def weekly():
    """The weeks of the course, without its projects."""
    return ','.join(dict.fromkeys(e.week for e in regions.exercises() if e.week.isdigit()))


class scratch_in:
    """A folder for what one submission builds, removed at the end."""
    def __init__(self, work):
        self.work = work

    def __enter__(self):
        self.path = tempfile.mkdtemp(dir=self.work)
        os.chmod(self.path, 0o755)
        return self.path

    def __exit__(self, *_):
        shutil.rmtree(self.path, ignore_errors=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split('\n', 1)[0])
    parser.add_argument('--weeks')
    parser.add_argument('--seed', type=int)
    parser.add_argument('--jobs', type=int, default=os.cpu_count() or 2)
    parser.add_argument('--out', type=pathlib.Path)
    parser.add_argument('--sandbox', choices=['namespaces', 'user'], default='')
    parser.add_argument('--cache', type=pathlib.Path, default=regions.ROOT / 'build/grade')
    parser.add_argument('submissions')
    words = parser.parse_args()
    if not os.path.isdir(words.submissions):
        raise Broken(f'{words.submissions} is no folder of submissions: unpack what Moodle or Canvas gave you')
    sandbox.demand(words.sandbox)
    out = (words.out or pathlib.Path(words.submissions.rstrip('/') + '-grades')).resolve()
    out.mkdir(parents=True, exist_ok=True)
    sandbox.closed([regions.ROOT, words.cache, words.submissions, out])
    with open(out / '.lock', 'w') as lock:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            raise Broken(f'another grading is writing into {out}') from None
        grade_all(words, out)


if __name__ == '__main__':
    try:
        main()
    except sandbox.Missing as error:
        say(f'grade: {error}')
        sys.exit(2)
    except (Broken, regions.Malformed) as error:
        sys.exit(f'grade: {error}')
    except KeyboardInterrupt:
        sys.exit('grade: stopped; the same command resumes')
