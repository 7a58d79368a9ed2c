# course/grade.py  15  grades what students handed in
"""grade.py [--weeks 1-3] [--seed N] [--jobs N] [--out FOLDER] SUBMISSIONS

Every folder or archive in SUBMISSIONS is what one student handed in, or part of it.  Of it only the
regions of the exercises are taken.  Each is put alone into the solution, then all together; both are
compiled and run in bubblewrap, and judged by numbers that come over a pipe.  Writes grade.md and
grade.json into FOLDER/students/NAME, and FOLDER/grades.csv, moodle.csv and canvas.csv; FOLDER is
SUBMISSIONS-grades unless it is said.  A student with a grade.json of the same submission, seed and
solution is not graded again: a grading that was stopped resumes.
"""
import argparse
import concurrent.futures
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
import submission
from region import canonical, region, without_comments
from starter import Plan
from submission import Problem
from workshop import Broken, Workshop, digest_of

WASTE = 100  # seconds of processor time of a submission that its endless loops may use up
SHORT = 40   # tokens: code as short as that may equal the public solution by chance


class Student:
    """One submission: its regions, or what is wrong with them, and their verdicts."""

    def __init__(self, handed_in, shop, numbers):
        self.name, self.number, self.shop, self.numbers = handed_in.name, handed_in.number, shop, numbers
        self.verdicts, self.texts, self.original, self.wasted, self.public = {}, {}, {}, 0, {}
        self.lock = threading.Lock()
        files = submission.read(handed_in.paths, list(dict.fromkeys(shop.solutions[n][0] for n in numbers)))
        for number in numbers:
            self.take(number, files)
        if sum(self.public.values()) < SHORT:
            self.public = {}
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
        if code == canonical('\n'.join(solution.solution)):
            self.public[number] = code.count(' ') + 1
        try:
            self.texts[number] = replace(self.original[number], text=without_comments(self.original[number]))
        except Problem as problem:
            self.verdicts[number] = verdict('refused', str(problem))

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
                'exercises': parts}

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
                'look': reports.plain('equals the public solution' if number in self.public else reports.look(found)), 'compiler': messages, 'together': together['state'] if together else ''}


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


def grade_all(words, out):
    """Every student who is not graded yet; the table after each, so that it holds all that is known."""
    shop = Workshop(words.cache, seed_of(words, out))
    numbers = [e.number for e in Plan(words.weeks or weekly()).open if e.number in shop.solutions]
    if not numbers:
        raise Broken('no exercise of these weeks has a region, answers and a judge')
    say('the solution and its stubs are judged first')
    shop.prepare(words.jobs)
    work = out / '.work'
    shutil.rmtree(work, ignore_errors=True)
    work.mkdir()
    work.chmod(0o755)
    with scratch_in(work) as scratch:
        worth = shop.weigh(words.jobs, scratch)
    handed_in = submission.submissions(words.submissions)
    say(f'{reports.counted(len(handed_in), "submission")}, {reports.counted(len(numbers), "exercise")}, seed {shop.seed}')
    grades, began, fresh = [], time.monotonic(), 0
    with concurrent.futures.ThreadPoolExecutor(words.jobs) as pool:
        for count, one in enumerate(handed_in, 1):
            student = Student(one, shop, numbers)
            folder = str(out / 'students' / one.name)
            grade = reports.load(folder)
            if not grade or grade.get('key') != student.key:
                start = time.monotonic()
                with scratch_in(work) as scratch:
                    grade = student.grade(pool, scratch, worth)
                reports.save(folder, grade)
                fresh += 1
                now = time.monotonic()
                left = (now - began) / fresh * (len(handed_in) - count)
                say(f'{count} of {len(handed_in)}  {grade["student"]}: {reports.points(grade["sum"])} of {grade["of"]} points, '
                    f'{now - start:.1f} s; {duration(left)} left')
            grades.append(grade)
    reports.tables(str(out), numbers, grades)
    flagged = sum(bool(reports.flags(g)) for g in grades)
    say(f'{out}/grades.csv: {reports.counted(len(grades), "student")}, {fresh} graded now'
        + (f'; {flagged} to look at: see the last column' if flagged else ''))
    if any(not g['number'] for g in grades):
        say(reports.without_number(grades))


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
    parser.add_argument('--cache', type=pathlib.Path, default=regions.ROOT / 'build/grade')
    parser.add_argument('submissions')
    words = parser.parse_args()
    if not os.path.isdir(words.submissions):
        raise Broken(f'{words.submissions} is no folder of submissions: unpack what Moodle or Canvas gave you')
    sandbox.demand()
    out = (words.out or pathlib.Path(words.submissions.rstrip('/') + '-grades')).resolve()
    out.mkdir(parents=True, exist_ok=True)
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
