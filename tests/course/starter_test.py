# course/starter_test.py  tests of the generator: python3 tests/course/starter_test.py [NAME...]
"""Each function test_... is a test; starter_test.cpp runs them one by one."""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import xml.etree.ElementTree

sys.path[:0] = [str(pathlib.Path(__file__).resolve().parents[2] / 'src' / folder) for folder in ('course', 'book')]
import diagrams
import handout
import mistakes
import mutants
import region
import regions
import sheets
import starter
import starter_check
import testing
import trial
from testing import expect

FILE = '''// x.h
int before;
    // exercise 2.1
    return a + b;
    // end
int after;
'''
STUB = '// 2.1  add\n// instead: the first alone\n    // of two\n    return a;\n'


def refused(call, *part):
    """call() must be refused, and say this."""
    try:
        call()
    except (regions.Malformed, mutants.Malformed, SystemExit) as error:
        for p in part:
            expect(p in str(error), f'{p!r} is not in {str(error)!r}')
        return
    raise AssertionError(f'not refused: {part}')


# ---- Regions ---------------------------------------------------------------------------------------

class Tree:
    """A folder with these files of src."""

    def __init__(self, files):
        self.temporary = tempfile.TemporaryDirectory()
        self.root = pathlib.Path(self.temporary.name)
        starter.write(self.root / 'tests/course/exercises.txt', '2.1 | Add | x.h | | 1 | 1\n')
        for name, text in files.items():
            starter.write(self.root / 'src' / name, text)

    def __enter__(self):
        return self.root

    def __exit__(self, *_):
        self.temporary.cleanup()


def test_a_region_has_a_solution_and_a_stub():
    with Tree({'course/stubs/2': STUB}) as root:
        [r] = regions.regions(FILE, 'x.h', root)
    expect((r.number, r.title) == ('2.1', 'add'), r.number, r.title)
    expect(r.solution == ['    return a + b;'], r.solution)
    expect(r.stub == ['    // of two', '    return a;'], r.stub)


def test_a_week_has_stubs_one_after_another():
    with Tree({'course/stubs/2': STUB + '\n\n' + STUB.replace('2.1', '2.2') + '\n    // 2.3\n'}) as root:
        expect(regions.stubs('2', root) == {'2.1': ('add', ['    // of two', '    return a;']), '2.2': (
            'add', ['    // of two', '    return a;', '', '    // 2.3'])}, regions.stubs('2', root))


def test_an_open_region_is_its_stub_between_marks():
    with Tree({'course/stubs/2': STUB}) as root:
        text = regions.rewrite(FILE, 'x.h', lambda r: r.open(r.stub), root)
    expect(text == '// x.h\nint before;\n    // BEGIN 2.1  add\n    // of two\n    return a;\n    // END 2.1\nint after;\n', text)


def test_a_solved_region_has_no_marks():
    text = regions.rewrite(FILE, 'x.h', lambda r: None)
    expect(text == '// x.h\nint before;\n    return a + b;\nint after;\n', text)


def test_two_regions_keep_what_is_between_them():
    twice = FILE + FILE.replace('2.1', '2.2')
    text = regions.rewrite(twice, 'x.h', lambda r: [r.number])
    expect(text == '// x.h\nint before;\n2.1\nint after;\n// x.h\nint before;\n2.2\nint after;\n', text)


def test_what_is_not_well_formed_is_refused_with_its_line():
    begin, end = '// exercise 2.1\n', '// end\n'
    for text, line, part in ((begin + begin, 2, '2.1 begins within 2.1'), (end, 1, 'an end without an exercise'),
                             (begin + end + end, 3, 'an end without'), ('// exercise 9.9\n', 1, 'no stub in src/course/stubs/9'),
                             *((begin + like, 2, 'no mark') for like in (
                                 '//end\n', '// END\n', '// end 2.1\n', 'return a;  // end\n', '// exercise\n', '// exercise 2\n',
                                 '// exercise 2.2  add\n', '//exercise 2.2\n', '// Exercise 2.2\n', '// BEGIN 2.1  add\n'))):
        refused(lambda: regions.regions(text, 'x.h'), f'x.h:{line}: ', part)
    refused(lambda: regions.regions(begin + 'x', 'x.h'), 'x.h: 2.1 does not end')


def test_regions_and_stubs_belong_together():
    good = {'x.h': FILE, 'course/stubs/2': STUB}
    with Tree(good) as root:
        expect(list(regions.solution_files(root)) == ['2.1'], 'what is well-formed is refused')
    for change, part in (({'y.h': FILE}, 'src/y.h: 2.1 is in src/x.h, too'), ({'x.h': FILE + FILE}, 'src/x.h: 2.1 is in src/x.h, too'),
                         ({'x.h': '// x.h\n'}, 'src/course/stubs/2: 2.1 is the stub of no region'),
                         ({'course/stubs/3': STUB}, 'src/course/stubs/3: 2.1 is the stub of no region'),
                         ({'x.h': FILE.replace('2.1', '2.2')}, 'src/x.h:3: no stub in src/course/stubs/2 begins with "// 2.2 '),
                         ({'y.h': FILE.replace('2.1', '2.2'), 'course/stubs/2': STUB + STUB.replace('2.1', '2.2')},
                          'src/y.h: 2.2 is not in exercises.txt'),
                         *(({'course/stubs/2': stub}, 'src/course/stubs/2 must begin with a stub') for stub in (
                             STUB.replace('  add', ''), STUB.replace('// instead', '//'), 'int a;\n' + STUB, STUB + STUB)),
                         *(({'course/stubs/2': stub}, 'no stub in src/course/stubs/2 begins with') for stub in (
                             '', STUB.replace('2.1', '2.2')))):
        with Tree({**good, **change}) as root:
            refused(lambda: regions.solution_files(root), part)


def test_every_exercise_is_a_region_of_its_file():
    found = regions.solution_files()
    listed = {e.number: e for e in regions.exercises()}
    for e in listed.values():
        expect(e.number in found, f'{e.number} is in no file')
        expect(found[e.number][0] == f'src/{e.file}', e.number, found[e.number][0], e.file)
        expect(0 < len(found[e.number][1].solution) <= 30, f'{e.number}: {len(found[e.number][1].solution)} lines')
        expect(set(e.needs) <= set(listed), f'{e.number} needs {e.needs}')
        expect(e.points > 0 and e.hours > 0, e.number)
    expect(set(found) == set(listed), set(found) ^ set(listed))


# ---- The starter -----------------------------------------------------------------------------------

def test_weeks_are_what_was_asked_for():
    for words, weeks, solved in (('1-6', '123456', ''), ('1-3', '123', ''), ('3', '3', '12'), ('2-3', '23', '1'),
                                 ('V', 'V', '123456'), ('1-2,V', '12V', ''), ('2-5,R', '2345R', '1')):
        plan = starter.Plan(words)
        expect((''.join(plan.weeks), ''.join(plan.solved_weeks)) == (weeks, solved), words, plan.weeks, plan.solved_weeks)
    for words in ('', '9', '3-1', '1-2-3', 'x', '1,'):
        refused(lambda: starter.Plan(words), words, 'say weeks')
    refused(lambda: starter.Plan('1-3,R'), 'R.1 needs 5.5', 'add week 5')


def test_wings_come_with_their_weeks_alone():
    for words, wings in (('1-4', []), ('1-5', ['shadow']), ('6', ['shadow']), ('V', ['shadow', 'voronoi']),
                         ('R', ['shadow', 'radiosity'])):
        expect(starter.Plan(words).wings == wings, words, starter.Plan(words).wings)


class Made:
    """A starter of weeks 2 and 3, without pictures."""

    def __enter__(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self.temporary.name) / 'starter'
        self.plan = starter.Plan('2-3')
        starter.make_starter(self.plan, self.folder)
        return self

    def __exit__(self, *_):
        self.temporary.cleanup()

    def sources(self):
        return '\n'.join(p.read_text() for p in sorted((self.folder / 'src').rglob('*.h')))


def test_earlier_weeks_are_solved_these_open_later_ones_stubs():
    with Made() as made:
        text, found = made.sources(), regions.solution_files()
        for e in regions.exercises():
            region = found[e.number][1]
            if e.week not in '1234':
                continue
            solution = '\n'.join(region.solution) in text
            stub = '\n'.join(region.stub) in text
            marked = f'// BEGIN {e.number}  {region.title}\n' in text and f'// END {e.number}\n' in text
            expect((solution, stub, marked) == (e.week == '1', e.week != '1', e.week in '23'), e.number, solution, stub, marked)
        expect(not regions.BEGIN.search(text) and not regions.END.search(text), 'marks of the solution are left')


def test_no_sampler_beside_it_shows_how_4_3_goes():
    with Made() as made:
        text = (made.folder / 'src/path/sampler.h').read_text()
        expect('case SamplerKind::halton' in text and 'bits, mix(bits))' not in text.split('class Sampler {')[1], 'two words of one')


def test_a_starter_has_what_its_weeks_need_and_no_more():
    with Made() as made:
        folders = sorted(p.name for p in (made.folder / 'src').iterdir())
        expect(folders == ['app', 'base', 'check', 'course', 'film', 'keep', 'many', 'mesh', 'path', 'replay', 'show', 'text', 'web', 'world'], folders)
        names = sorted(p.name for p in (made.folder / 'tests/course').iterdir())
        expect(not [n for n in names if n.endswith('_test.cpp') or n.endswith('.py') or 'hidden' in n], names)
        expect([n for n in names if n.startswith('judge_')] ==
               ['judge_2.cpp', 'judge_3.cpp', 'judge_3_light.h', 'judge_3_scenes.h'], names)
        expect(not list(made.folder.rglob('*.mutants')), 'mutants')
        for table in ('exercises.txt', 'mistakes.txt'):
            rows = [r for r in (made.folder / 'tests/course' / table).read_text().splitlines() if not r.startswith('#')]
            expect(rows and all(r[:2] in ('2.', '3.') for r in rows), table, rows[:1])
        questions = (made.folder / 'tests/course/questions.txt').read_text().splitlines()
        expect([q[0] for q in questions] == ['#', *'222333'], questions)
        told = (made.folder / 'tests/course/starter.txt').read_text()
        expect(re.fullmatch(r'Starter of weeks 2 3, Penumbra .+\.\n', told), told)
        for name in ('Dockerfile', '.github/workflows/check.yml', '.clang-format', 'sheets/systems.md', 'tests/course/update',
                     'tests/course/picture', 'tests/course/report'):
            expect((made.folder / name).exists(), f'no {name}')
        expect('wide' not in (made.folder / 'src/world/tree.h').read_text(), 'the wide tree')
        guide = (made.folder / 'tests/oracle/README.md').read_text()
        expect('expect_density(random, sample, pdf)' in guide and guide.count('exercise of week 2') == 2 and 'bugs-found' not in guide, guide)


def test_all_that_a_starter_includes_is_there():
    with tempfile.TemporaryDirectory() as temporary:
        starter.make_starter(starter.Plan('1-6,V,R'), pathlib.Path(temporary))
        files = [*pathlib.Path(temporary).rglob('*.h'), *pathlib.Path(temporary).rglob('*.cpp')]
        expect(any(f.name == 'penumbra.cpp' for f in files), files)
        for file in files:
            for name in re.findall(r'^#include "(.*)"', file.read_text(), re.M):
                found = [f for f in ('src', 'tests', 'tests/course') if (pathlib.Path(temporary) / f / name).exists()]
                expect(found, f'{file.name} includes {name}')


def test_the_judge_starts_programs_by_what_posix_has():
    if not shutil.which('g++') or 'Free Software Foundation' not in subprocess.run(['g++', '--version'], capture_output=True, text=True).stdout:
        return print('not tested: g++ is not that of GNU')
    with Made() as made:
        starter.write(made.folder / 'one.cpp', '#include "course/program.h"\n')
        done = subprocess.run(['g++', '-std=c++20', '-U_GNU_SOURCE', '-D_XOPEN_SOURCE=700', '-D_DEFAULT_SOURCE', '-Isrc', '-Itests', '-fsyntax-only',
                               'one.cpp'], cwd=made.folder, capture_output=True, text=True)
        # Some headers of the library itself need more than POSIX.
        ours = [line for line in done.stderr.splitlines() if re.match(r'(src|tests)/.*error', line)]
        expect(not ours, *ours)


# What bash 3.2, make 3.81 and the awk, sed and other tools of macOS do not know: a pattern, and an example of it.
NEWER = {r'\bsed (-\w+ )*-i': 'sed -i s/a/b/ x', r'\bsed .*s(.).*\1.*\\n.*\1': "sed 's/ /\\n/'", r'\bdate .*%[-\d]*N': 'date +%s.%N',
         r'\breadlink -f|\brealpath\b': 'readlink -f x', r'\bgrep -\w*P': 'grep -oP x', r'\b(head|tail) (-n ?|-c ?)-\d': 'head -n -1',
         r'\bstat -\w*c': 'stat -c %s x', r'\b(mapfile|readarray|coproc|wait -n)\b': 'mapfile -t x', r'\b(declare|local|typeset) -\w*[Ang]': 'declare -A x',
         r'\$\{\w+(\[.\])?(,,?|\^\^?|@\w)\}': '${x,,}', r'\$\{\w+\[-': '${x[-1]}', r'&>>|\|&|;;?&': 'x &>>y', r'\[\[ -v ': '[[ -v x ]]',
         r'\b(cp|mv|rm|mkdir|ln|tar|mktemp|sort|sed|grep|cut|wc|ls)\b[^|;]* --(?!strip-components)[a-z]*': 'cp -- x y',
         r'\bsort -\w*V|\bxargs -\w*r|-printf|\bbase64 -w|\bcp -\w*[alrdu]': 'sort -V',
         r'\b(tac|seq|timeout|nproc|md5sum|sha256sum|shuf|setsid|free|getconf) (?!2>)': 'timeout 1 x',
         r'\b(gensub|strftime|systime|asorti?|PROCINFO|BEGINFILE|ENDFILE)\b': 'gensub(/a/, "b", 1)',
         r'^\.ONESHELL|^\w+ *!=|^[^#\n"]*&:|\$\(file |^\w+ *::?:= *|\$\(guile |--output-sync|\$\(let |\$\(intcmp ': 'x != y'}


def test_scripts_and_rules_do_without_what_macos_has_not():
    for pattern, example in NEWER.items():
        expect(re.search(pattern, example, re.M), pattern, 'does not find', example)
    with tempfile.TemporaryDirectory() as temporary:
        starter.make_starter(starter.Plan('1-6,V,R'), pathlib.Path(temporary))
        scripts = [p for p in sorted(pathlib.Path(temporary).rglob('*')) if p.is_file() and
                   (p.name == 'Makefile' or p.suffix == '.mk' or re.match(rb'#!.*\b(ba)?sh\n', p.read_bytes()[:40]))]
        expect({'Makefile', 'course.mk', 'check', 'picture', 'update'} <= {p.name for p in scripts}, scripts)
        for script in scripts:
            for pattern in NEWER:
                for found in re.finditer(pattern, re.sub(r'^\s*# .*', '', script.read_text(), flags=re.M), re.M):
                    raise AssertionError(f'{script.name}: {found[0]}')


def test_marks_survive_every_style_of_clang_format():
    if not shutil.which('clang-format'):
        return print('not tested: clang-format is not installed')
    found = regions.solution_files()
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary)
        starter.make_starter(starter.Plan('1-6,V,R'), folder)
        files = {name: (folder / name).read_bytes() for name in sorted({name for name, _ in found.values()})}
        for style in ('LLVM', 'Google', 'Chromium', 'Mozilla', 'WebKit', 'file'):
            for name, data in files.items():
                if style == 'file':  # a student's comment flows into no mark
                    data = re.sub(rb'([ \t]*// END)', rb'// ' + rb'word ' * 30 + rb'\n\1', data)
                (folder / name).write_bytes(data)
            subprocess.run(['clang-format', '-i', f'--style={style}', *files], cwd=folder, check=True)
            for number, (name, solution) in found.items():
                text = region.region((folder / name).read_bytes(), number, name).text
                expect(region.canonical(text) == region.canonical('\n'.join(solution.stub)), style, number, text)


def test_help_names_every_target():
    with Made() as made:
        shown = subprocess.run(['make', 'help'], cwd=made.folder, capture_output=True, text=True, check=True).stdout
        names = re.findall(r'^  (\S+)', shown, re.M)
        expect(sorted(names) == sorted('all out/NAME.png penumbra report clean help check update web'.split()), names)


def test_a_compiler_that_is_not_there_is_named():
    with Made() as made:
        done = subprocess.run(['make', 'build/penumbra', 'CXX=no-such-compiler'], cwd=made.folder, capture_output=True, text=True)
        expect(done.returncode == 2 and 'no compiler no-such-compiler' in done.stderr and 'stb' not in done.stderr, done.stderr)


def test_another_compiler_builds_anew():
    with Made() as made:
        for name in ('one', 'two'):
            starter.write(made.folder / name, '#!/bin/sh\necho x >>asked\n[ "$1" = -x ] && exit\necho x >>built\n'
                          'while [ "$1" != -o ]; do shift; done\necho >"$2"\n', True)
        for name, times in (('one', 1), ('one', 1), ('two', 2), ('two', 2)):
            done = subprocess.run(['make', 'build/penumbra', f'CXX=./{name}'], cwd=made.folder, capture_output=True, text=True)
            expect(done.returncode == 0, done.stderr)
            expect((made.folder / 'built').read_text() == 'x\n' * times, name, times, (made.folder / 'built').read_text())


def test_a_compiler_that_does_not_know_this_processor_builds_for_its_own():
    with Made() as made:
        starter.write(made.folder / 'bin/brew', '#!/bin/sh\necho /opt/brew\n', True)
        path = {**os.environ, 'PATH': f'{made.folder}/bin:{os.environ["PATH"]}'}
        for refused, native in (('none', True), ('-march=native', False)):
            starter.write(made.folder / 'cxx', f'#!/bin/sh\ncase "$*" in *{refused}*) exit 1;; esac\n[ "$1" = -x ] && exit\necho "$@" >built\n'
                          'while [ "$1" != -o ]; do shift; done\necho >"$2"\n', True)
            shutil.rmtree(made.folder / 'build', ignore_errors=True)
            done = subprocess.run(['make', 'build/penumbra', 'CXX=./cxx'], cwd=made.folder, env=path, capture_output=True, text=True)
            expect(done.returncode == 0, refused, done.stderr)
            built = (made.folder / 'built').read_text()
            expect((' -march=native ' in built) == native and ' -idirafter /opt/brew/include ' in built, refused, built)


def test_a_program_for_a_debugger_is_kept_apart_and_named():
    with Made() as made:
        starter.write(made.folder / 'cxx', '#!/bin/sh\n[ "$1" = -x ] && exit\necho "$@" >>built\nwhile [ "$1" != -o ]; do shift; done\n'
                      'echo "#!/bin/sh" >"$2"; chmod +x "$2"\n', True)
        for words, options, names in ((['build/penumbra'], '-O1', []), (['build/penumbra', 'DEBUG=1'], '-Og -g -D_GLIBCXX_ASSERTIONS',
                                                                        ['build/penumbra-debug']),
                                      (['check', 'EX=2.2', 'DEBUG=1'], '-Og -g -D_GLIBCXX_ASSERTIONS',
                                       ['build/course-debug/answers_2', 'build/penumbra-debug'])):
            shutil.rmtree(made.folder / 'build', ignore_errors=True)
            (made.folder / 'built').unlink(missing_ok=True)
            said = subprocess.run(['make', 'CXX=./cxx', *words], cwd=made.folder, capture_output=True, text=True).stdout
            built = (made.folder / 'built').read_text()
            expect(built and all(options in line for line in built.splitlines()), words, built)
            expect('DEBUG=1' not in words or not (made.folder / 'build/penumbra').exists(), words, 'the other program was replaced')
            for name in names:
                expect(name in said and f'-o {name} ' in built, words, name, said, built)


def test_a_header_within_src_will_do():
    with Made() as made:
        for header, works in ((None, False), ('src/stb/stb_image_write.h', True)):
            if header:
                starter.write(made.folder / header, '#pragma once\n')
            done = subprocess.run(['make', 'packages', 'CXX=g++ -nostdinc'], cwd=made.folder, capture_output=True, text=True)
            expect((done.returncode == 0) == works, header, done.stdout, done.stderr)


def test_what_the_solution_draws_is_that_of_the_open_weeks():
    with tempfile.TemporaryDirectory() as temporary:
        folder, suffix = pathlib.Path(temporary), f'-stand-in-{os.getpid()}'
        stand_in = regions.ROOT / f'build/penumbra{suffix}'
        try:
            starter.write(stand_in, '#!/bin/sh\nfor last; do :; done; echo "$@" >"$last"\n', True)
            starter.draw_expected(starter.Plan('1-2'), folder, suffix)
        finally:
            stand_in.unlink()
        names = sorted(p.stem for p in (folder / 'expected').iterdir())
        expect(names == ['1', '1.4', '1.5', '1.6', '2.2'], names)
        order = (folder / 'expected/2.2.pfm').read_text()
        expect(order.startswith('--view occlusion') and 'scenes/cornell36.scene --quiet -o' in order, order)


def test_a_solved_copy_has_all_solutions():
    with tempfile.TemporaryDirectory() as temporary:
        starter.make_starter(starter.Plan('1-6,V,R', solved=True), pathlib.Path(temporary) / 's')
        text = '\n'.join(p.read_text() for p in sorted(pathlib.Path(temporary).rglob('*.h')))
        for number, (_, region) in regions.solution_files().items():
            expect('\n'.join(region.solution) in text, number)


def test_a_starter_as_handed_in_has_the_solutions_of_its_weeks_between_marks():
    with tempfile.TemporaryDirectory() as temporary:
        plan = starter.Plan('2', handed_in=True)
        starter.make_starter(plan, pathlib.Path(temporary) / 's')
        for number, (name, r) in regions.solution_files().items():
            if number.split('.')[0] in '234':
                text = (pathlib.Path(temporary) / 's' / name).read_text()
                expect(('\n'.join(r.open(r.solution)) in text) == (number[0] == '2'), number, text)
                expect(('\n'.join(r.stub) in text) == (number[0] != '2'), number)


def test_answers_stand_behind_blanks_and_stay_there():
    text = 'is ____<!-- $2\\pi$ -->, and $a (\\underline{\\qquad}, \\_\\_\\_\\_)$<!-- x | y -->\n$$\\underline{\\qquad}$$\n<!-- z -->\n'
    students = 'is ____, and $a (\\underline{\\qquad}, \\_\\_\\_\\_)$\n$$\\underline{\\qquad}$$\n'
    expect(sheets.for_students(text) == students, sheets.for_students(text))
    key = sheets.with_answers('x', text, '[{}]'.format, '<{}>'.format)
    expect(key == 'is [$2\\pi$], and $a (<x>, <y>)$\n$$<z>$$\n', key)
    for bad in (students, text.replace(' | y', ''), text.replace('<!-- z -->', ''), '____<!-- a | b -->'):
        refused(lambda: sheets.with_answers('x', bad, str, str), 'x: ')
    count = 0
    for sheet in sorted((regions.ROOT / 'reference/course').glob('*.md')):
        key = sheets.with_answers(sheet.name, sheet.read_text(), str, str)
        expect(not sheets.BLANK.search(key) and '<!--' not in key, sheet.name)
        count += len(sheets.BLANK.findall(sheet.read_text()))
    expect(count > 250, count)
    with Made() as made:
        texts = [p.read_text() for p in (made.folder / 'sheets').glob('?-*.md')]
        expect(texts and all('____' in t and '<!--' not in t for t in texts), 'a starter has answers')


def test_a_blank_and_what_ends_a_sentence_stay_on_a_line():
    with tempfile.TemporaryDirectory() as folder:
        sheet = pathlib.Path(folder) / 'x.md'
        sheet.write_text('is ____<!-- $a$ -->, is it? ____<!-- yes -->. is ____<!-- b --> long\n')
        blank, wide = ('<span class="%sblank"></span>' % kind for kind in ('', 'wide '))
        text = handout.filled(sheet, False)
        expect(text == f'is <span class="whole">{blank},</span> is it? <span class="whole">{wide}.</span> is {blank} long\n', text)


def test_the_archive_is_the_same_for_the_same_content():
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary) / 's'
        bytes_of = []
        for _ in range(2):
            (folder / 'sub').mkdir(parents=True, exist_ok=True)
            (folder / 'sub/x').write_text('x')
            starter.pack(folder)
            bytes_of.append((pathlib.Path(temporary) / 's.tar.gz').read_bytes())
            (folder / 'sub/x').unlink()
        expect(bytes_of[0] == bytes_of[1], 'two archives of the same content differ')
        import tarfile
        with tarfile.open(pathlib.Path(temporary) / 's.tar.gz') as tar:
            expect(tar.getnames() == ['penumbra-starter/sub', 'penumbra-starter/sub/x'], tar.getnames())


# ---- Checks of it, and known mistakes --------------------------------------------------------------

def test_a_leak_is_seen():
    found = regions.solution_files()
    numbers = {e.number for e in regions.exercises() if e.week != '1'}
    for where, comment in (('src/world/warp.h', ''), ('src/path/start.h', '// '), ('sheets/1.md', '')):
        with Made() as made:
            starter_check.failures.clear()
            starter_check.check_leaks(found, made.folder, numbers)
            expect(not starter_check.failures, starter_check.failures)
            path = made.folder / where
            path.parent.mkdir(exist_ok=True)
            old = path.read_text() if path.exists() else ''
            line = max((s for s in found['2.2'][1].solution), key=lambda s: len(s.split('//')[0]))
            for leak in (comment + '  ' + line.strip(), '// exercise 2.2', '    // end'):
                path.write_text(old + '\n' + leak + '\n')
                starter_check.check_leaks(found, made.folder, numbers)
                expect(starter_check.failures, where, leak, 'was not found')
                starter_check.failures.clear()


def test_random_subsets_meet_every_pair_in_every_state():
    numbers = [str(n) for n in range(34)]
    for seed in ('a', 'b'):
        chosen = starter_check.subsets(numbers, seed)
        expect(len(chosen) == 50, len(chosen))
        for i, a in enumerate(numbers):
            for b in numbers[:i]:
                states = {(a in s, b in s) for s in chosen}
                expect(len(states) == 4, a, b, states)


def test_a_mistake_is_planted_once_or_refused():
    [mutant] = mutants.parse('file: x.h\ntest: x_test\n\n@@ minus: a wrong sign\n-    return a + b;\n+    return a - b;\n')
    expect('return a - b;' in mutants.planted(mutant, FILE), 'not planted')
    refused(lambda: mutants.planted(mutant, FILE + FILE), 'exactly once')
    refused(lambda: mutants.planted(mutant, 'none'), 'exactly once')


def test_a_mistake_changes_its_region_and_nothing_else():
    mistakes.within('m', 'x.h', FILE, FILE.replace('a + b', 'a - b'), '2.1')
    refused(lambda: mistakes.within('m', 'x.h', FILE, FILE.replace('int before', 'int earlier'), '2.1'), 'more than the region')
    refused(lambda: mistakes.within('m', 'x.h', FILE, FILE.replace('a + b', 'a - b'), '2.2'), 'more than the region')


def test_every_exercise_has_four_known_mistakes_whose_rows_are_there():
    rows = [r.split('\t') for r in (regions.ROOT / 'tests/course/mistakes.txt').read_text().splitlines() if not r.startswith('#')]
    known = mistakes.known_mistakes()
    expect([(k.exercise, k.name, k.says, k.read) for k in known] == [tuple(r[:4]) for r in rows],
           'tests/course/mistakes.txt is old: make mistakes')
    for e in regions.exercises():
        count = sum(k.exercise == e.number and k.name != 'stub' for k in known)
        expect(count >= 4, f'{e.number} has {count}')
    expect(len(known) - len(regions.exercises()) >= 100, len(known))
    prints = [(r[0], r[4]) for r in rows]
    expect(len(set(prints)) == len(prints), 'two mistakes have the same answers')
    for k in known:
        mistakes.check_heading(k)


class Checked:
    """A folder of two exercises in which `make check` finds judges and a renderer that say what they are told to."""

    def __init__(self, verdicts, off, svg=''):
        self.top = pathlib.Path(tempfile.mkdtemp())
        (self.top / 'expected').mkdir()
        (self.top / 'expected/1.pfm').touch()
        said = ''.join(f'{n}) echo "{n} {v}"; [ "{v}" = right ] && exit 0;; ' for n, v in verdicts.items())
        drawn = f'[ -z "$ORACLE_PICTURES" ] || {{ mkdir -p "$ORACLE_PICTURES"; echo "{svg}" >"$ORACLE_PICTURES/oracle-check-1.svg"; }}; '
        for name, text in {'build/course/judge_1': f'{drawn if svg else ""}case $3 in {said} esac; exit 1',
                           'build/penumbra': 'for last; do :; done; echo alone >"$last"; echo "x: 4 samples per pixel, 1.0 s"; echo wrote; '
                                             'echo "x: the image is black"',
                           'build/beside': f'echo beside >"$3"; echo "d_rel {off} %; mean 1 1 1"'}.items():
            starter.write(self.top / name, f'#!/bin/sh\n{text}\n', True)
        for name, text in {'exercises.txt': ''.join(f'{n} | {n} | a.h | | 1 | 1\n' for n in verdicts),
                           'pictures.txt': '1 | 1.1 1.2 | 30 | penumbra --spp 1 x.scene\n', 'mistakes.txt': ''}.items():
            starter.write(self.top / 'tests/course' / name, text)
        starter.write(self.top / 'src/a.h', ''.join(f'// BEGIN {n}\n// END {n}\n' for n in verdicts))
        for name in ('check', 'picture'):
            shutil.copy(regions.ROOT / 'tests/course' / name, self.top / 'tests/course' / name)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        shutil.rmtree(self.top)

    def check(self, *exercises, make='true', suffix=''):
        done = subprocess.run([str(self.top / 'tests/course/check'), *exercises], env={**os.environ, 'MAKE': make, 'SUFFIX': suffix},
                              capture_output=True, text=True)
        return done.stdout, done.returncode


def test_a_picture_waits_or_is_far_off():
    for second, off, part, status in (('right', '29', None, 0), ('right', '31', 'right, but the picture is far off', 1),
                                      ('right', '-nan', 'right, but the picture is far off', 1), ('wrong', '164', 'the expected picture waits for 1.2', 0),
                                      ('wrong', '29', None, 0)):
        with Checked({'1.1': 'right', '1.2': second}, off) as folder:
            said, came = folder.check('1.1')
            expect(came == status, second, off, said)
            expect(part in said if part else not re.search('far off|waits', said), second, off, said)
            # What cannot resemble the expected picture yet stands alone.
            alone = second == 'wrong' and off == '164'
            page, drawn = ((folder.top / f'out/check/{name}').read_text() for name in ('index.html', '1.1.png'))
            expect('<b>expected</b>' not in page and 'd_rel' not in said + page if alone else '<b>expected</b>' in page, off, said, page)
            expect('src="1.1.png?' in page and drawn == ('alone\n' if alone else 'beside\n'), off, drawn)
    with Checked({'1.1': 'wrong', '1.2': 'right'}, '164') as folder:
        expect('far off' not in folder.check('1.1')[0], 'what is wrong is not right')


def test_it_is_said_why_a_region_has_no_header_of_its_own():
    why = 'a region has only what its file includes'
    with Checked({'1.1': 'wrong', '1.2': 'right'}, '3') as folder:
        for error, said in (("error: no member named 'mt19937' in namespace 'std'", f'; {why}'), ("error: 'mt19937' is not a member of 'std'", f'; {why}'),
                            ('error: \u2018mt19937\u2019 is not a member of \u2018std\u2019', f'; {why}'), ("error: 'std::chrono' has not been declared", f'; {why}'),
                            ("error: variable 'std::stringstream s' has initializer but incomplete type", f'; {why}'),
                            ("error: implicit instantiation of undefined template 'std::array<int, 3>'", f'; {why}'),
                            ("error: 'printf' was not declared in this scope\nsrc/a.h:1:1: note: 'printf' is defined in header '<cstdio>'; did you forget to "
                             "'#include <cstdio>'?", f'; {why}'),
                            ("error: 'y' was not declared in this scope", ''),
                            ("error: 'y' was not declared in this scope\nsrc/a.h:3:5: error: 'mt19937' is not a member of 'std'", '')):
            starter.write(folder.top / 'make', f'#!/bin/sh\ncat <<END\nsrc/a.h:2:5: {error}\nEND\nexit 1\n', True)
            came = folder.check('1.1', make=str(folder.top / 'make'), suffix='-debug')[0].split('\n')[0]
            expect(came == f'1.1 does not compile: src/a.h:2:5: {error}'.split('\n')[0] + said, came)
        for word, said in (('#', f'; {why}'), ('asm', '')):
            (folder.top / 'src/a.h').write_text(f'// BEGIN 1.1\n{word}\n// END 1.1\n')
            came = folder.check('1.1')[0]
            expect(came == f'1.1 cannot be handed in: src/a.h: line 2: {word} is refused{said}\n', came)


def test_it_is_said_what_was_changed_outside_of_the_marks():
    given = '// a.h\nint a;\n// BEGIN 1.1  it\nreturn 1;\n// END 1.1\nint b;\n    // BEGIN 1.2\n    // END 1.2\n'
    with Checked({'1.1': 'right', '1.2': 'wrong'}, '3') as folder:
        starter.write(folder.top / 'tests/course/frames.txt', f'a.h {starter.frame(given)}\n')
        for text, changed in ((given, False), (given.replace('return 1;', 'int c;\nreturn c;'), False), (given.replace('\n', '\r\n'), False),
                              (given.replace('int b;', '  int\n b ;\n\n'), False), (given.replace('int a;', '#include <random>\nint a;'), True),
                              (given.replace('int b;', 'int b, c;'), True), (given + 'int c;', True)):
            (folder.top / 'src/a.h').write_bytes(text.encode())
            came = folder.check('1.1')[0]
            expect(('src/a.h was changed outside of the marks' in came) == changed, text, came)
    plan = starter.Plan('1-2')
    with tempfile.TemporaryDirectory() as folder:
        to = pathlib.Path(folder)
        starter.write_sources(plan, to)
        starter.write_checks(plan, to)
        told = dict(line.split(' ', 1) for line in (to / 'tests/course/frames.txt').read_text().splitlines())
        expect(told == {e.file: starter.frame((to / f'src/{e.file}').read_text()) for e in plan.open} and len(set(told.values())) == len(told) > 3, told)


# Regions of one line: words, literals and comments that a grader may refuse or not.
LINES = r"""
int a__b;
int _a, a_b;
int _B;
[[gnu::pure]] void f();
[[clang::x]] int y;
import x;
asm("x");
int important, gnus, R; R + 1;
// # asm __ \ here
/* # asm __ */ int x;
/* # */ # /* */
int x; // /*
/*
/* //
*/
#define a
%:define a
??=define a
int hash = a##b;
x = a /* b */ * c / d;
a.b->c %= d ? e : f;
puts("#");
puts("%:");
puts("a // b");
puts("/*");
puts("a__b asm");
puts("a ?? b");
puts("a\"#");
puts("a\"");
puts("\\"); puts("b"); // "#"
puts("a" "#");
puts("
puts("'"); puts("''"); puts('"');
puts(R"(a)");
puts(u8"a");
char c = '#';
char c = '"'; // "
char c = '\\'; int x;
'
''
'ab'
int n = 1'000'000, hex = 0xFF'FF;
double d = 1.5e-3, h = 0x1p-24, f = .5f;
int a = 1; \
int a = \ b;
// a \
int größe = 2;
// BEGIN 1.2
// END 1.2
//END 1.1
// END 1.10
// BEGIN 1.1.1
// BEGIN the end
int x; // END 1.1
""".split('\n') + ['a\n#\nb', '/* a\n# */', '/* a\n# */ #', '// /*\n#', '/* /* \n */ #', '"a\nb"', 'int x;\f', 'int x;\x01', 'int x;\r', 'x\n' * 32767,
                   'x\n' * 32768]


def cannot_be_graded(text):
    """Whether the grader refuses the region of 1.1 in a file."""
    try:
        region.without_comments(region.region(text.encode(), '1.1', 'src/a.h'))
        return False
    except region.Problem:
        return True


def test_whatever_a_grader_refuses_cannot_be_handed_in_and_nothing_else():
    files = [f'// BEGIN 1.1\n{lines}\n// END 1.1\n' for lines in LINES]
    bad = sum(map(cannot_be_graded, files))
    expect(20 < bad < len(files) - 20, bad, len(files))
    files += ['', '// BEGIN 1.1\n', '// END 1.1\n// BEGIN 1.1\n', '//  BEGIN\t1.1: a ray\n\n  // END 1.1 .\n', '#\n// BEGIN 1.1\n// END 1.1\n#\n',
              '// BEGIN 1.1\n// END 1.1\n// BEGIN 1.1\n// END 1.1\n', '// BEGIN 1.10\n// END 1.10\n', 'x // BEGIN 1.1\n// END 1.1\n']
    check = (regions.ROOT / 'tests/course/check').read_text()
    unfit = check[check.index('\nunfit()'):check.index('\n}\n', check.index('\nunfit()')) + 3]
    with tempfile.TemporaryDirectory() as folder:
        for i, text in enumerate(files):
            starter.write(pathlib.Path(folder) / f'src/{i}', text)
        loop = f'field() {{ echo $i; }}; for ((i = 0; i < {len(files)}; ++i)); do echo $(unfit 1.1); done'
        done = subprocess.run(['bash', '-c', 'alone=; ' + unfit + loop], cwd=folder, capture_output=True, text=True, check=True)
    for text, said in zip(files, done.stdout.split('\n')):
        expect((said != '') == cannot_be_graded(text), text[:200], said)


def test_a_drawing_is_that_of_the_exercise_and_says_what_it_shows():
    for svg, part in (('running mean', 'the mean of the samples so far'), ('density', 'samples, density and their difference')):
        with Checked({'1.1': 'wrong', '1.2': 'right'}, '3', svg) as folder:
            folder.check()
            expect(not (folder.top / 'build/oracle').exists(), 'a check of all draws nothing')
            said = folder.check('1.1')[0]
            expect(part in said and (folder.top / 'out/check/1.1.svg').exists(), said)
            (folder.top / 'build/course/judge_1').write_text('#!/bin/sh\necho "$3 right"\n')
            expect('drawn' not in folder.check('1.1')[0] and not (folder.top / 'out/check/1.1.svg').exists(), 'an old drawing')


# ---- The book --------------------------------------------------------------------------------------

def test_diagrams_are_drawn_and_computed():
    names = ('image-plane ray-sphere edge-functions slab malley cone-of-sphere area-solid-angle mis-two-strategies roulette '
             'halton-digits sobol-strata snell penumbra voronoi-cell form-factor').split()
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([sys.executable, diagrams.__file__, folder], check=True)
        drawn = {path.stem: xml.etree.ElementTree.parse(path).getroot() for path in pathlib.Path(folder).glob('*')}
    expect(sorted(drawn) == sorted(names), drawn)
    for name, svg in drawn.items():
        told = {part.get('id'): part.text for part in svg[:2]}
        expect([*told] == svg.get('aria-labelledby').split() == [f'{name}-title', f'{name}-desc'], name, told)
        expect(all(told.values()) and len(svg) > 10, name, told)
    points = diagrams.sobol_points(16)
    for k in range(5):
        boxes = {(int(x * (16 >> k)), int(y * (1 << k))) for x, y in points}
        expect(len(boxes) == 16, f'{16 >> k} x {1 << k}:', boxes)
    areas = [diagrams.area(diagrams.cell_of(site, diagrams.SITES)) for site in diagrams.SITES]
    expect(min(areas) > 0 and abs(sum(areas) - 1) < 1e-12, areas)
    written = [''.join(part.itertext()) for part in drawn['voronoi-cell']]
    expect(all(f'{area:.3f}' in written for area in areas), written)
    expect([diagrams.mirrored(*pair) for pair in ((6, 2), (19, 3))] == ['011', '102'], 'the numbers of sheet 4.1')


if __name__ == '__main__':
    testing.run(globals())
