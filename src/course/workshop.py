# course/workshop.py  13  the solution with a student's regions in it: compiled, run, judged
#
# The judge is compiled from the solution, and never loads a student's code: it asks a program in the
# sandbox over pipes.  That program is compiled from a tree which holds what it includes and nothing
# else, with the student's lines in place of the solution's: these are nowhere in it.
import concurrent.futures
import hashlib
import json
import os
import pathlib
import re
import shutil
import subprocess
import tempfile
import threading
import time

import regions
import sandbox
import starter
from region import Region
from regions import ROOT

STATIC = ['-static', '-fno-diagnostics-show-caret', '-fdiagnostics-color=never', '-fmax-errors=20']
PATIENCE = 20       # seconds by the clock for one answer, more on a busy machine: what computes is stopped by its processor time


class Broken(Exception):
    """The solution itself cannot be built, or is not right: nobody can be graded."""


def flags():
    """The compiler and its options, as make gives them."""
    if 'CXX' not in os.environ or 'FLAGS' not in os.environ:
        raise Broken('say make grade')
    return os.environ['CXX'].split(), os.environ['FLAGS'].split()


def solved_tree():
    """The starter with all solutions and no marks, and the programs that answer: path -> text."""
    written = regions.solution_files()
    weeks = dict.fromkeys(e.week for e in regions.exercises() if e.number in written)
    everything = starter.Plan(','.join(weeks), solved=True)
    with tempfile.TemporaryDirectory() as folder:
        top = pathlib.Path(folder)
        starter.write_sources(everything, top)
        tree = {str(p.relative_to(top)): p.read_text() for p in top.rglob('*') if p.is_file()}
    for path in [*sorted((ROOT / 'tests/course').iterdir()), *sorted((ROOT / 'tests/oracle').glob('*.h'))]:
        if path.suffix == '.h' or path.name.startswith('answers_') and path.suffix == '.cpp':
            tree[str(path.relative_to(ROOT))] = path.read_text()
    return tree


def included(tree, path):
    """The files of the tree that compiling this one reads."""
    found, waiting = set(), [path]
    while waiting:
        path = waiting.pop()
        if path in found:
            continue
        found.add(path)
        for name in re.findall(r'^[ \t]*#[ \t]*include "([^"]+)"', tree[path], re.M):
            for candidate in (f'{os.path.dirname(path)}/{name}', f'src/{name}', f'tests/{name}'):
                if candidate in tree:
                    waiting.append(candidate)
                    break
    return found


def digest_of(texts):
    return hashlib.sha256('\0'.join(texts).encode('utf-8', 'surrogateescape')).hexdigest()


class Workshop:
    """Builds and judges; equal texts of regions are judged once."""

    def __init__(self, cache, seed):
        self.cxx, self.flags = flags()
        self.seed = seed
        self.tree = solved_tree()
        self.exercises = {e.number: e for e in regions.exercises()}
        self.solutions = regions.solution_files()
        self.programs = {}    # week -> the answers' source
        for week in dict.fromkeys(n.split('.')[0] for n in self.solutions):
            hidden, shown = (f'tests/course/answers_{week}{end}.cpp' for end in ('_hidden', ''))
            if (hidden in self.tree or shown in self.tree) and (ROOT / f'tests/course/judge_{week}.cpp').exists():
                self.programs[week] = hidden if hidden in self.tree else shown
        self.closure = {week: included(self.tree, source) for week, source in self.programs.items()}
        self.solutions = {n: s for n, s in self.solutions.items()
                          if n.split('.')[0] in self.programs and s[0] in self.closure[n.split('.')[0]]}
        self.key = self.digest()
        self.cache = pathlib.Path(cache).resolve() / self.key[:16]
        self.cache.mkdir(parents=True, exist_ok=True)
        self.cache.chmod(0o755)
        (self.cache / 'rules').write_bytes(sandbox.filter_program())
        self.lock, self.verdicts, self.built = threading.Lock(), {}, {}
        self.limits = {}      # exercise -> (seconds to compile, seconds to run)

    def digest(self):
        """Of all that a verdict depends on, but the student and the seed."""
        said = subprocess.run([*self.cxx, '--version'], capture_output=True, text=True).stdout
        parts = [said, ' '.join(self.cxx + self.flags + STATIC), *(f'{p}\n{t}' for p, t in sorted(self.tree.items()))]
        for path in sorted([*(ROOT / 'tests/course').glob('*'), *(ROOT / 'src/course').glob('*.py'), *(ROOT / regions.STUBS).iterdir()]):
            parts.append(path.read_text() if path.is_file() else '')
        return digest_of(parts)

    # ---- Judges and headers, which come from the solution alone ----

    def prepare(self, jobs, numbers, room):
        """Compiles what all need who solve these exercises, unless it was done before.  What others left a week ago is removed."""
        os.utime(self.cache)
        for other in self.cache.parent.iterdir():
            if other.stat().st_mtime < time.time() - 7 * 86400:
                shutil.rmtree(other, ignore_errors=True)
        orders = [self.header_order()]
        for week in dict.fromkeys(n.split('.')[0] for n in numbers):
            name = f'judge_{week}'
            orders.append((name, [*self.cxx, *self.flags, '-D_GLIBCXX_ASSERTIONS', '-o', name, f'tests/course/{name}.cpp']))
        with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
            list(pool.map(lambda order: self.trusted(*order), orders))
        self.headers = sandbox.within_reach(str(self.cache / 'headers'), room)

    def header_order(self):
        """What the programs include of the standard library, compiled once."""
        names = sorted({h for files in self.closure.values() for f in files
                        for h in re.findall(r'^#include (<[a-z]+>)', self.tree[f], re.M)})
        headers = self.cache / 'headers'
        headers.mkdir(exist_ok=True)
        (headers / 'all.h').write_text(''.join(f'#include {name}\n' for name in names))
        return 'headers/all.h.gch', [*self.cxx, *self.flags, *STATIC[1:], '-x', 'c++-header', '-o', 'headers/all.h.gch',
                                     str(headers / 'all.h')]

    def trusted(self, name, command):
        if (self.cache / name).exists():
            return
        partial = self.cache / (name + '.partial')
        command = [str(partial) if word == name else word for word in command]
        said = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
        if said.returncode != 0:
            raise Broken(f'{name} does not compile: {said.stderr[:2000]}')
        partial.rename(self.cache / name)

    # ---- Programs that answer ----

    def with_later_stubs(self, number, text):
        """A region, and stubs of all that comes after it in the course: it cannot call what is yet to be written."""
        order = [n for n in self.exercises if n in self.solutions]
        return {number: text, **{n: self.stub(n) for n in order[order.index(number) + 1:]}}

    def stub(self, number):
        return Region(number, '\n'.join(self.solutions[number][1].stub) + '\n', 1, '')

    def relevant(self, week, texts):
        """Of these regions those that the week's program includes."""
        return {n: t for n, t in texts.items() if n in self.solutions and self.solutions[n][0] in self.closure[week]}

    def write_tree(self, week, texts, top):
        """The week's files, with these texts as regions.  #line counts a student's lines from 1."""
        for path in self.closure[week]:
            mine = {n for n in texts if self.solutions[n][0] == path}
            text = self.tree[path]
            if mine:
                text = regions.rewrite((ROOT / path).read_text(), path, lambda region: None if region.number not in mine else [
                    f'#line 1 "student/{region.number}"', *texts[region.number].text.split('\n'), f'#line 1 "{path}"'])
            to = pathlib.Path(top) / path
            to.parent.mkdir(parents=True, exist_ok=True)
            to.write_bytes(text.encode('utf-8', 'surrogateescape'))

    def build(self, week, texts, out, cpu):
        """The program, or None, and what the compiler said: (path, Built)."""
        with tempfile.TemporaryDirectory(dir=os.path.dirname(out)) as top:
            os.chmod(top, 0o755)
            tree = pathlib.Path(top) / 'tree'
            self.write_tree(week, texts, tree)
            os.makedirs(out, exist_ok=True)
            os.chmod(out, 0o777)
            command = [*self.cxx, *self.flags, *STATIC, '-include', '/headers/all.h', '-o', '/out/answers',
                       self.programs[week]]
            built = sandbox.build(str(tree), out, command, cpu, self.headers)
        program = os.path.join(out, 'answers')
        return (program if built.ok and os.path.isfile(program) and not os.path.islink(program) else None), built

    # ---- Verdicts ----

    def judged(self, number, texts, scratch):
        """The judgement of an exercise with these regions in the solution: a dictionary with its state."""
        week = number.split('.')[0]
        texts = self.relevant(week, texts)
        what = digest_of(f'{n}\0{r.text}' for n, r in sorted(texts.items()))
        verdict = self.once(self.verdicts, (number, what), lambda: self.judge(number, texts, what, scratch))
        return dict(verdict)

    def once(self, known, key, work):
        """work(), by the first who asks; others wait for it."""
        with self.lock:
            mine = key not in known
            if mine:
                known[key] = concurrent.futures.Future()
            future = known[key]
        if mine:
            try:
                future.set_result(work())
            except BaseException as error:
                future.set_exception(error)
        return future.result()

    def forget(self, scratch):
        """The programs of a submission, which are removed."""
        with self.lock:
            self.built = {key: value for key, value in self.built.items() if key[0] != scratch}

    def judge(self, number, texts, what, scratch):
        week = number.split('.')[0]
        compile_limit, run_limit = self.limits.get(number, (60, 60))
        out = os.path.join(scratch, week + '-' + what[:16])
        program, built = self.once(self.built, (scratch, week, what), lambda: self.build(week, texts, out, compile_limit))
        if not program:
            return {'state': 'not compiled', 'says': built.ended, 'compiler': built.messages[:1 << 14], 'items': [],
                    'wasted': compile_limit if built.ended else 0}
        began = time.monotonic()
        verdict = self.ask(number, program, run_limit)
        verdict.update({'compile': built.seconds, 'run': time.monotonic() - began})
        if verdict['state'] == 'not judged' or any('processor time' in item['seen'] for item in verdict['items']):
            verdict['wasted'] = run_limit
        return verdict

    def ask(self, number, program, cpu):
        """What the judge says; the program's own words and exit status count for nothing."""
        patience = round(PATIENCE * max(1, os.getloadavg()[0] / (os.cpu_count() or 1)))
        with tempfile.TemporaryDirectory(dir=self.cache) as folder:
            answer = os.path.join(folder, 'verdict.json')
            command = ['timeout', '-k', '1', str(patience + 4 * cpu), str(self.cache / f'judge_{number.split(".")[0]}'),
                       '--mistakes', str(ROOT / 'tests/course/mistakes.txt'), '--json', answer, '--seed', str(self.seed),
                       '--patience', str(patience), number, '--', *sandbox.run_command(program, str(self.cache / 'rules'), cpu)]
            with open(os.path.join(folder, 'stderr'), 'w+b') as words:
                process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=words,
                                           env=sandbox.environment(), cwd=folder, start_new_session=True)
                status = process.wait()
                words.seek(0)
                said = words.read(1 << 12).decode('utf-8', 'replace').strip()
            try:
                with open(answer, encoding='utf-8', errors='replace') as file:
                    verdict = json.load(file)
            except (OSError, ValueError):
                return {'state': 'not judged', 'says': f'the judge ended with status {status}: {said}', 'items': []}
        return {name: verdict[name] for name in ('state', 'named', 'credit', 'allows', 'says', 'read', 'items')}

    # ---- What solution and stub are worth ----

    def weigh(self, jobs, numbers, scratch):
        """number -> (items, of which the stub has right); limits of processor time follow from the solution's time, and
        from what the exercise allows.

        The solution must have all right by this seed, and no stub may; else nobody can be graded.
        """
        path = self.cache / f'worth-{self.seed}.json'
        worth = json.loads(path.read_text()) if path.exists() else {}

        def weigh(number):
            found = self.weigh_one(number, scratch)
            with self.lock:  # a grading that is stopped keeps what it knows
                worth[number] = found
                partial = path.with_suffix('.partial')
                partial.write_text(json.dumps(worth))
                partial.rename(path)
        with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
            list(pool.map(weigh, [n for n in numbers if n not in worth]))
        self.limits = {n: (5 + int(4 * w['compile']), 3 + int(3 * w['run'] + w['allows'])) for n, w in worth.items()}
        return {n: (w['items'], w['stub']) for n, w in worth.items()}

    def weigh_one(self, number, scratch):
        solution = self.judged(number, {}, scratch)
        if solution['state'] != 'right':
            wrong = [i['what'] for i in solution['items'] if not i['right']]
            raise Broken(f'{number}: the solution is {solution["state"]} by seed {self.seed}: '
                         f'{"; ".join(wrong) or solution["says"]} {solution.get("compiler", "")[:1000]}')
        stub = self.judged(number, {number: self.stub(number)}, scratch)
        if stub['state'] in ('right', 'not compiled', 'not judged'):
            raise Broken(f'{number}: the stub is {stub["state"]}: {stub["says"]}')
        return {'items': len(solution['items']), 'stub': sum(i['right'] for i in stub['items']),
                'compile': solution['compile'], 'run': solution['run'], 'allows': solution['allows']}
