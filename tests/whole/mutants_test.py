# whole/mutants_test.py  tests of tests/mutants/run: python3 tests/whole/mutants_test.py [NAME...]
"""Each function test_... is a test; scripts_test.cpp runs them one by one.

The compiler of their project is a script: it turns src/base/x.h, which is shell, into every test.
"""
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / 'tests/course'), str(ROOT / 'tests/mutants')]
import mutants
import testing
from testing import expect

COMPILER = '''#!/bin/bash
echo "$*" >>told
while [ "$1" != -o ]; do shift; done
case $2 in *.gch | *.o) touch "$2"; exit ;; esac
if grep -q 'no C++' src/base/x.h; then echo "no C++" >&2; exit 1; fi
{ echo '#!/bin/bash'; cat src/base/x.h; } >"$2"
chmod +x "$2"
'''
SOURCE = '''# base/x.h  1  a test
case "$2" in *nothing*) echo "0 passed, 0 failed"; exit 1 ;; esac
first=right
second=right
if [ $first = wrong ]; then echo "0 passed, 1 failed"; exit 1; fi
echo "1 passed, 0 failed"
# twice
# twice
'''
HEAD = 'file: src/base/x.h\ntest: x_test\n'


def block(name, right, wrong, more=''):
    return f'\n@@ {name}: made up\n{more}-{right}\n+{wrong}\n'


KILLED = block('killed', 'first=right', 'first=wrong')
SURVIVES = block('survives', 'second=right', 'second=wrong')


class House:
    def __init__(self, *blocks, head=HEAD):
        self.temporary = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self.temporary.name)
        self.write('src/base/x.h', SOURCE)
        for name in ('scenes/a.scene', 'reference/a.md', 'CMakeLists.txt', 'Makefile', 'README.md', 'LICENSE', '.clang-format',
                     'compile_flags.txt', '.vscode/tasks.json', '.devcontainer/devcontainer.json', 'tests/std.h', 'tests/main.cpp'):
            self.write(name, '')
        self.write('tests/base/x_test.cpp', '#include "base/x.h"\n#include "base/y.h"\n')
        self.write('src/base/y.h', '')
        self.write('tests/mutants/base.mutants', head + ''.join(blocks))
        for name in ('run', 'bench.py', 'kept.py', 'mutants.py'):
            shutil.copy(ROOT / 'tests/mutants' / name, self.folder / 'tests/mutants')
        bench = (self.folder / 'tests/mutants/bench.py').read_text()
        self.write('tests/mutants/bench.py', bench.replace('BASELINE_LIMIT = 120, 80', 'BASELINE_LIMIT = 1, 1'))
        self.write('compiler', COMPILER)
        (self.folder / 'compiler').chmod(0o755)

    def write(self, name, text):
        (self.folder / name).parent.mkdir(parents=True, exist_ok=True)
        (self.folder / name).write_text(text)

    def run(self, *words):
        """(exit status, the verdicts, the last line)"""
        done = subprocess.run([str(self.folder / 'tests/mutants/run'), *words], capture_output=True, text=True,
                              env={**os.environ, 'CXX': str(self.folder / 'compiler'), 'FLAGS': '-w'})
        lines = (done.stdout + done.stderr).splitlines() or ['']
        return done.returncode, lines[:-1], lines[-1]

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.temporary.cleanup()


def test_each_end_of_a_test_is_told_apart():
    for more, wrong, begin in (
            ('', 'first=wrong', 'killed '), ('', 'kill -SEGV $$', 'killed by a crash'),
            ('', 'while :; do :; done', 'killed by a timeout'), ('', 'first=other', 'SURVIVED'),
            ('', 'exit 3', 'ERROR: exit status 3'), ('', 'exit 1', 'ERROR: exit status 1'), ('', 'no C++', 'ERROR: does not compile'),
            ('case: nothing\n', 'first=wrong', 'ERROR: without a mutant: x_test nothing: no such test case'),
            ('equivalent: a proof\n', 'first=other', 'equivalent'), ('equivalent: a proof\n', 'first=wrong', 'ERROR: seen by')):
        with House(block('one', 'first=right', wrong, more)) as house:
            status, said, last = house.run()
            good = begin.startswith(('killed', 'equivalent'))
            expect(len(said) == 1 and said[0].startswith(begin) and status == (0 if good else 1), wrong, said, last)
            expect(not good or not list(house.folder.glob('build/mutants.*/')), 'it leaves a folder')


def test_what_is_red_by_itself_kills_nothing():
    with House(KILLED) as house:
        house.write('src/base/x.h', SOURCE.replace('first = wrong', 'second = right'))
        expect('ERROR: without a mutant: x_test : red' in house.run()[1][0])


def test_all_must_apply_before_any_is_planted():
    for wrong in (block('stale', 'third=right', 'x'), block('twice', '# twice', 'x'), KILLED,
                  block('of_no_test', 'second=right', 'x', 'test: y_test\n'), block('key', 'second=right', 'x', 'cases: x\n')):
        with House(KILLED, wrong) as house:
            status, said, last = house.run()
            expect(status == 1 and 'killed' not in ''.join(said) and not (house.folder / 'told').exists(), wrong, said, last)


def test_lines_are_kept_as_they_are():
    text = HEAD + '\n@@ m: of: colons\n-@@ a\n--b\n \tc \n+\n-\n+ +d\n e\n'
    [m] = mutants.parse(text)
    expect((m.name, m.what, m.old, m.new) == ('m', 'of: colons', '@@ a\n-b\n\tc \n\ne\n', '\tc \n\n +d\ne\n'), m.old, m.new)
    expect(mutants.planted(m, 'x\n' + m.old) == 'x\n' + m.new)


def test_what_stands_above_a_source_is_for_its_mutants_alone():
    other = 'file: src/base/y.h\ntest: y_test\n'
    first, second = mutants.parse(HEAD + 'case: one\n' + KILLED + other + block('other', 'a', 'b', 'case: two\n'))
    expect((first.file, first.test, first.case) == ('src/base/x.h', 'x_test', 'one'), first)
    expect((second.file, second.test, second.case) == ('src/base/y.h', 'y_test', 'two'), second)
    [first, second] = mutants.parse(HEAD + 'case: one\n' + KILLED + other + SURVIVES)
    expect(second.case == '', second)
    for wrong in (HEAD + block('file', 'a', 'b', 'file: src/base/y.h\n'), HEAD + KILLED + 'case: one\n' + SURVIVES):
        try:
            expect(not mutants.parse(wrong), 'it is parsed')
        except mutants.Malformed:
            pass


def test_mutants_that_moved_have_not_changed():
    old = ''.join(block(f'old{i}', 'first=right', 'first=wrong') for i in range(8))
    with House() as house:
        def commit():
            for words in (['init', '-q'], ['add', '-A', 'src', 'tests/base', 'tests/mutants/*mutants'],
                          ['-c', 'user.name=x', '-c', 'user.email=x', 'commit', '-qm', 'x']):
                subprocess.run(['git', *words], cwd=house.folder, check=True, env={
                    **os.environ, 'GIT_AUTHOR_DATE': '1000000000 +0000', 'GIT_COMMITTER_DATE': '1000000000 +0000'})
        house.write('tests/mutants/base.mutants', HEAD + old)
        commit()
        (house.folder / 'tests/mutants/base.mutants').unlink()
        house.write('tests/mutants/whole.mutants', HEAD + old + block('changed', 'second=right', 'first=wrong'))
        commit()
        os.sched_setaffinity(0, list(os.sched_getaffinity(0))[:1])  # one after the other
        status, said, last = house.run('--changed', '1')
        expect(status == 0 and len(said) == 9 and ' changed ' in said[0], said, last)


def test_verdicts_hold_until_something_is_touched():
    with House(KILLED, SURVIVES) as house:
        status, said, last = house.run()
        expect(status == 1 and '1/2 mutants killed' in last and '1 survived' in last and '0 verdicts kept' in last, last)
        told = (house.folder / 'told').read_text()
        status, said, last = house.run()
        expect(status == 1 and 'SURVIVED' in said[0] and '1/2' in last and '2 verdicts kept' in last, said, last)
        expect((house.folder / 'told').read_text() == told, 'it compiles')
        expect('0 verdicts kept' in house.run('--again')[2])
        house.write('tests/mutants/base.mutants', HEAD + KILLED + SURVIVES.replace('second=wrong', 'first=wrong'))
        status, said, last = house.run()
        expect(status == 0 and '2/2' in last and '1 verdicts kept' in last, last)
        for name in ('src/base/x.h', 'src/base/y.h', 'tests/base/x_test.cpp', 'tests/main.cpp'):
            house.write(name, (house.folder / name).read_text() + '# more\n')
            expect('0 verdicts kept' in house.run()[2], name)
        house.write('tests/main.h', '')
        expect('2 verdicts kept' in house.run()[2], 'another file counts')
        house.write('tests/base/x_test.cpp', '#include "base/x.h"\n// popen\n')
        house.run()
        house.write('tests/main.h', '# more')
        expect('0 verdicts kept' in house.run()[2], 'a test that sees the project does not see a file')


def test_no_time_is_no_verdict():
    with House(KILLED, SURVIVES) as house:
        status, said, last = house.run('--seconds', '-1')
        expect(status == 1 and not said and '2 left out for time' in last, said, last)
        expect('0 verdicts kept' in house.run('--only', 'kill')[2])
        expect('no mutant is called' in house.run('--only', 'none')[2])
        expect('1/2' in house.run('--only', 'base/x', '--draw', 'x')[2])


if __name__ == '__main__':
    testing.run(globals())
