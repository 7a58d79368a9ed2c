# course/plant_test.py  tests of copies with a planted bug: python3 tests/course/plant_test.py [NAME...]
"""Each function test_... is a test; plant_test.cpp runs them one by one."""
import os
import pathlib
import subprocess
import sys
import tarfile
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / 'src/course'))
import hunted
import plant
import mutants
import regions
import sandbox
import starter
import testing
from testing import expect

BUG = 'warp_cosine_density_of_half'


def mutant_of(file, old, new, more=''):
    """A mutant that is not among those of the project."""
    def edit(mark, lines):
        return ''.join(mark + line + '\n' for line in lines.splitlines())
    [mutant] = mutants.parse(f'file: {file}\ntest: warp_test\n@@ made_up: made up\n{more}{edit("-", old)}{edit("+", new)}')
    return mutant


class Copy:
    """A copy with a bug, without pictures; or, in `refused`, why there is none."""

    def __init__(self, mutant=None, **made_up):
        self.temporary = tempfile.TemporaryDirectory()
        self.top = pathlib.Path(self.temporary.name)
        self.folder = self.top / '1'
        self.mutant = mutant_of(**made_up) if made_up else mutants.everything()[mutant]
        self.refused = ''
        try:
            plant.make_copy(self.mutant, starter.Plan('1-5', solved=True), self.folder)
        except plant.Refused as refused:
            self.refused = str(refused)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.temporary.cleanup()


def lines_of(file, part):
    """A line of the solution, as a mutant has it."""
    [line] = [line for line in (regions.ROOT / file).read_text().split('\n') if part in line]
    return line + '\n'


UNIFORM = lines_of('src/world/warp.h', 'inline real pdf_quad_area')


def test_the_copy_has_the_wrong_line_in_place_of_the_right_one():
    with Copy(BUG) as copy:
        expect(not copy.refused, copy.refused)
        expect('\nreport:' not in (copy.folder / 'Makefile').read_text(), 'a report of verdicts, without judges')
        old, new = copy.mutant.old, copy.mutant.new
        text = (copy.folder / copy.mutant.file).read_text()
        plan = starter.Plan('1-5', solved=True)
        right = regions.rewrite((regions.ROOT / copy.mutant.file).read_text(), 'warp.h', plan.replacement)
        expect(old in right and old not in text, 'the right lines are still there')
        wrong, solved = text.split('\n'), right.split('\n')
        first = next(i for i, (a, b) in enumerate(zip(wrong, solved)) if a != b)
        last = len(wrong) - next(i for i, (a, b) in enumerate(zip(wrong[::-1], solved[::-1])) if a != b)
        key = dict(line.split(': ', 1) for line in pathlib.Path(f'{copy.folder}.key').read_text().splitlines())
        expect(key['mutant'] == BUG and key['file'] == copy.mutant.file and key['exercise'] == '2.2', key)
        expect(key['lines'] == f'{first + 1}-{last}', key['lines'], first + 1, last)
        squeezed = ''.join(new.split())
        expect(squeezed in ''.join(text.split()), 'the wrong lines are not there')


def test_the_key_tells_lines_of_the_copy():
    longer = UNIFORM.replace('{ return 1 / length(cross(e, f)); }',
                             '{\n    const real area = 2 * length(cross(e, f));\n    return 1 / area;\n}')
    expect(longer.count('\n') == 4, longer)
    with Copy(file='src/world/warp.h', old=UNIFORM, new=longer) as copy:
        text = (copy.folder / 'src/world/warp.h').read_text().split('\n')
        first = 1 + next(i for i, line in enumerate(text) if 'pdf_quad_area' in line)
        key = hunted.read_key(pathlib.Path(f'{copy.folder}.key'))
        expect(key['lines'] == f'{first}-{first + 3}', key['lines'], first)


def test_all_else_is_the_solution():
    plan = starter.Plan('1-5', solved=True)
    with Copy(BUG) as copy, tempfile.TemporaryDirectory() as other:
        starter.write_sources(plan, pathlib.Path(other))
        for path in pathlib.Path(other).rglob('*'):
            name = path.relative_to(other)
            if path.is_file() and str(name) != copy.mutant.file:
                expect((copy.folder / name).read_text() == path.read_text(), name)


def test_nothing_in_the_copy_tells_which_it_is():
    with Copy(BUG) as copy, Copy(plant.candidates(starter.Plan('3'))[0].name) as another:
        for c in (copy, another):
            expect(not c.refused, c.mutant.name, c.refused)
            files = [p for p in c.folder.rglob('*') if p.is_file()]
            for path in files:
                text = path.read_text(errors='replace')
                for word in ('// exercise', '// end\n', c.mutant.name, c.mutant.head['what'], '.mutant', '// BEGIN'):
                    expect(word not in text, path, word)
            names = {str(p.relative_to(c.folder)) for p in files}
            expect(not any('judge' in n or 'mistakes' in n or 'answers' in n or n.endswith('.key') for n in names), names)
            with tarfile.open(f'{c.folder}.tar.gz') as tar:
                members = tar.getmembers()
                packed = {str(pathlib.Path(*pathlib.Path(m.name).parts[1:])) for m in members if m.isfile()}
            expect(packed == names, packed ^ names)
            expect(all(m.mtime == 0 and m.uname == '' for m in members), 'dates tell what was changed last')
        # Two copies have the same files: what is left out does not tell either.
        here = {str(p.relative_to(copy.folder)) for p in copy.folder.rglob('*')}
        expect(here == {str(p.relative_to(another.folder)) for p in another.folder.rglob('*')}, 'other files')


def test_wrong_lines_look_like_the_others():
    wide = UNIFORM.replace('{ return', '{   return').replace('length', ' length')
    with Copy(file='src/world/warp.h', old=UNIFORM, new=wide.replace('1 /', '2 /')) as copy:
        if 'clang-format' in copy.refused or not plant.shutil.which('clang-format'):
            return
        text = (copy.folder / 'src/world/warp.h').read_text()
        expect(UNIFORM.replace('1 /', '2 /') in text, 'not formatted')


def test_what_is_no_exercise_is_refused_and_leaves_nothing():
    for why, made_up in (
            ('equivalent', dict(file='src/world/warp.h', old=UNIFORM, new=UNIFORM.replace('1 /', '2 /'),
                                more='equivalent: nobody sees it\n')),
            ('does not hold', dict(file='src/labs/lab.h', old='#pragma once\n', new='\n')),
            ('not exactly once', dict(file='src/world/warp.h', old='no such line\n', new='\n')),
            ('does not compile', dict(file='src/world/warp.h', old=UNIFORM, new=UNIFORM.replace('length', 'lenght'))),
            ('warns', dict(file='src/world/warp.h', old=UNIFORM, new=UNIFORM.replace('cross(e, f)', 'e'))),
            ('nothing but spaces', dict(file='src/world/warp.h', old=UNIFORM, new=UNIFORM))):
        with Copy(**made_up) as copy:
            expect(why in copy.refused, repr(why), repr(copy.refused))
            left = [p.name for p in copy.top.iterdir()]
            expect(not left, left)


def test_known_mistakes_of_the_weeks_are_drawn():
    exercises = {e.number: e for e in regions.exercises()}
    for weeks in ('2', '1-3', '1-6'):
        found = plant.candidates(starter.Plan(weeks, solved=True))
        expect(len(found) > 4, weeks, len(found))
        for m in found:
            expect(exercises[m.exercise].week in starter.Plan(weeks).weeks, weeks, m.name)
            expect(not m.exercise.startswith('6'), m.name, 'a test is no place for a bug')


def run(*words):
    return subprocess.run([sys.executable, str(regions.ROOT / 'src/course/plant.py'), '--no-pictures', *words],
                          capture_output=True, text=True)


def test_copies_are_numbered_and_a_seed_draws_the_same():
    with tempfile.TemporaryDirectory() as top:
        for _ in range(2):
            done = run('--mutant', 'random', '--weeks', '2', '--seed', 'x', top)
            expect(done.returncode == 0, done.stderr)
            expect('warp' not in done.stdout and 'light' not in done.stdout, 'it is named aloud:', done.stdout)
        names = sorted(p.name for p in pathlib.Path(top).iterdir())
        expect(names == ['1', '1.key', '1.tar.gz', '2', '2.key', '2.tar.gz'], names)
        expect(*[len({(pathlib.Path(top) / k).read_text() for k in ('1.key', '2.key')}) == 1, 'another draw'])
        done = run('--mutant', 'no_such', top)
        expect(done.returncode == 1 and 'there is no mutant no_such' in done.stderr, done.stderr)


def test_make_check_runs_the_students_test():
    with Copy(BUG) as copy:
        hunt = copy.folder / 'tests/course/hunt.cpp'
        # Without the renderer, which takes a while to compile.
        for name in ('app/penumbra.cpp', 'shadow/shadow.cpp', 'course/beside.cpp'):
            (copy.folder / 'src' / name).write_text('int main() {}\n')
        def check(text):
            hunt.write_text(text)
            done = subprocess.run(['make', '-s', 'check'], cwd=copy.folder, capture_output=True, text=True)
            return done.stdout + done.stderr
        expect('green: it finds nothing' in check(hunt.read_text()), 'the example is not green')
        expect('red: is that the bug' in check('#include "world/warp.h"\n#include <cmath>\nusing namespace penumbra;\nint main() '
               '{ return std::abs(pdf_cosine_hemisphere(1) * pi - 1) > 1e-6; }\n'), 'the bug is not found')
        expect('does not compile' in check('int main() { return }\n'), 'an error is not told')
        expect('crashes' in check('#include <cstdlib>\nint main() { std::abort(); }\n'), 'a crash is not told')


GOOD = '''// FOUND src/world/warp.h:%d
#include <cmath>
#include "world/warp.h"
using namespace penumbra;
int main() { return std::abs(pdf_cosine_hemisphere(1) * pi - 1) > 1e-6; }
'''


def test_points_are_for_the_place_and_for_red_with_green_without():
    try:
        sandbox.demand()
    except sandbox.Missing as missing:
        print(f'skipped: {missing}')
        return
    os.environ.setdefault('CXX', 'g++')
    os.environ['FLAGS'] = '-std=c++20 -march=native -ffp-contract=off -fno-math-errno -DREAL=double -Isrc -Itests -w'
    with Copy(BUG) as copy:
        line = int(hunted.read_key(pathlib.Path(f'{copy.folder}.key'))['lines'].split('-')[0])
        def points(text):
            return [p for p, _, _ in hunted.verdict(copy.folder, text)]
        expect(points(GOOD % line) == [1, 1, 2], points(GOOD % line))
        expect(points(GOOD % (line + 2)) == [1, 1, 2], 'two lines off')
        for text, right in ((GOOD % (line + 3), [1, 0, 2]), (GOOD.replace('warp.h:%d', f'bsdf.h:{line}'), [0, 0, 2]),
                            (GOOD % line + '#error\n', [1, 1, 0]), ('int main() {}\n', [0, 0, 0]),
                            (f'// FOUND src/world/warp.h:{line}\nint main() {{ return 1; }}\n', [1, 1, 0]),
                            (f'// FOUND src/world/warp.h:{line}\nint main() {{ for (;;); }}\n', [1, 1, 0]),
                            (f'// FOUND src/world/warp.h:{line}\n#include "{copy.folder}.key"\n', [1, 1, 0])):
            expect(points(text) == right, text, points(text), right)


def test_nothing_is_run_without_a_sandbox():
    done = subprocess.run([sys.executable, str(regions.ROOT / 'src/course/hunted.py'), 'nowhere/1', __file__],
                          capture_output=True, text=True)
    expect(done.returncode == 1 and 'there is no nowhere/1.key' in done.stderr, done.stderr)
    with tempfile.TemporaryDirectory() as top:
        (pathlib.Path(top) / '1.key').write_text('file: src/world/warp.h\nlines: 1-1\n')
        done = subprocess.run([sys.executable, str(regions.ROOT / 'src/course/hunted.py'), f'{top}/1', __file__],
                              capture_output=True, text=True, env={'PATH': top})
        expect(done.returncode == 2 and 'bubblewrap' in done.stderr, done.stderr)


if __name__ == '__main__':
    testing.run(globals())
