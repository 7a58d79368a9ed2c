# course/starter.py  6  makes a starter: what students get, generated from the solution
"""starter.py [--weeks 1-3,V] [--solved | --handed-in] [--no-pictures] FOLDER

Writes FOLDER and FOLDER.tar.gz.  Exercises of these weeks are open: their stubs stand between
`// BEGIN N.M` and `// END N.M`.  Those of earlier weeks come solved, those of later ones are stubs that
nobody is asked to replace, so that no solution is given away.  --solved: all come solved, to look for a
planted bug.  --handed-in: the open ones are as who solved them hands them in, to try a machine.
"""
import argparse
import io
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tarfile

import regions
import sheets
from regions import ROOT

WINGS = {'5': 'shadow', 'V': 'voronoi', 'R': 'radiosity'}
FOLDERS = ['base', 'world', 'many', 'text', 'mesh', 'check', 'path', 'film', 'replay', 'app', 'show', 'web']
ALSO = ['src/keep/read_pfm.h', 'src/keep/pair.h']  # build/beside compares pictures
UNTOLD = ['src/shadow/population.h', 'src/web/render.js']  # formulas of an exercise, which only experiments need; what tests need
COURSE = ['beside.cpp', 'course.mk']  # of src/course
KIT = ['answers.h', 'judge.h', 'program.h', 'check', 'picture', 'report', 'update', 'pictures.txt']  # of tests/course
EDITORS = ['.devcontainer/devcontainer.json'] + [f'.vscode/{name}.json' for name in ('tasks', 'launch', 'extensions', 'settings')]
HAND_IN = '''Hand in the whole folder, or only src/, as .tar.gz or .zip: only the lines between `// BEGIN` and `// END` are read.
Leave these marks as they are, and write plain C++ between them. The grader refuses `#include`, `#define`, `asm` and
names with two underscores. A region has only what its file includes, and no `<random>`: random numbers are arguments
such as `u`, or come from `oracle::Random` (week 6).

A mistake costs half of an exercise's points, or a quarter where `make check` says `wrong` and not `WRONG`: at the limits of a
law. A mistake that it does not know by name may cost more.'''


class Plan:
    """Which weeks are open, which exercises, and what becomes of each region."""

    def __init__(self, words, solved=False, handed_in=False):
        self.all = regions.exercises()
        weeks = list(dict.fromkeys(e.week for e in self.all))
        self.weeks = []
        for part in words.split(','):
            ends = part.split('-')
            if len(ends) > 2 or not all(w in weeks for w in ends) or weeks.index(ends[0]) > weeks.index(ends[-1]):
                raise regions.Malformed(f'WEEKS={words}: say weeks of {" ".join(weeks)}, such as 1-3 or 2 or 1-6,V')
            self.weeks += weeks[weeks.index(ends[0]):weeks.index(ends[-1]) + 1]
        self.weeks = [w for w in weeks if w in self.weeks]
        first = weeks.index(self.weeks[0])
        numbered = [w for w in weeks if w.isdigit()]
        # An optional project alone comes after the whole course.
        before = weeks[:first] if self.weeks[0].isdigit() else numbered
        self.solved_weeks = [w for w in before if w not in self.weeks]
        self.solved, self.handed_in = solved, handed_in
        self.open = [e for e in self.all if e.week in self.weeks]
        given = self.weeks + self.solved_weeks
        for e in self.open:
            for need in e.needs:
                if need.split('.')[0] not in given:
                    raise regions.Malformed(f'WEEKS={words}: {e.number} needs {need}: add week {need.split(".")[0]}, '
                                            f'or give week {e.week} alone')
        self.wings = [wing for week, wing in WINGS.items() if week in self.weeks + self.solved_weeks]
        if 'radiosity' in self.wings and 'shadow' not in self.wings:
            self.wings.insert(0, 'shadow')  # its form factors

    def replacement(self, region):
        """Lines in place of a region; None: its solution."""
        week = region.number.split('.')[0]
        if self.solved or week in self.solved_weeks:
            return None
        return region.open(region.solution if self.handed_in else region.stub) if week in self.weeks else region.stub


def write(path, text, executable=False):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)
    path.chmod(0o755 if executable else 0o644)


def with_headers(folder, files):
    """Files of a folder that there are, and what they include of it, in turn."""
    found = list(dict.fromkeys(f for f in files if (folder / f).exists()))
    for file in found:
        for header in re.findall(r'^#include "course/(\w+\.h)"', (folder / file).read_text(), re.M):
            if header not in found and (folder / header).exists():
                found.append(header)
    return found


def decided(text, folders):
    """A header of the core that includes a module if a macro says so: as if the macro had said what is in the folders."""
    return re.sub(r'#ifdef WITH_(\w+)\n(.*?)#else\n(.*?)#endif\n', lambda m: m[2] if m[1].lower() in folders else m[3], text, flags=re.S)


def write_sources(plan, to):
    """src: the core and the wings of these weeks, with the plain tree alone."""
    for folder in FOLDERS + plan.wings:
        for path in sorted((ROOT / 'src' / folder).iterdir()):
            name = f'src/{folder}/{path.name}'
            if name in UNTOLD:
                continue
            write(to / name, decided(regions.rewrite(path.read_text(), name, plan.replacement), FOLDERS + plan.wings))
    for name in ALSO:
        write(to / name, (ROOT / name).read_text())
    names = COURSE + sorted({pathlib.Path(e.file).name for e in plan.open if e.file.startswith('course/')})
    for file in with_headers(ROOT / 'src/course', names):
        name = f'src/course/{file}'
        write(to / name, regions.rewrite((ROOT / name).read_text(), name, plan.replacement))
    write(to / 'src/world/tree.h', '// world/tree.h  5  the tree of a scene\n#pragma once\n'
          '#include "world/bvh.h"\n\nnamespace penumbra {\nusing Tree = Bvh;\n}\n')


def rows(text, keep):
    """Lines of a table whose first field is kept, and comments."""
    return ''.join(line + '\n' for line in text.splitlines()
                   if line.startswith('#') or keep(re.split(r'[\t|]', line)[0].strip()))


def frame(text):
    """The sum, as of cksum(1), of what is outside of open regions, without marks and white space: `check` compares it."""
    outside = re.sub(r'^[ \t]*// BEGIN .*?^[ \t]*// END [^\n]*', '', text, flags=re.M | re.S)
    return subprocess.run(['cksum'], input=re.sub(r'\s', '', outside).encode(), stdout=subprocess.PIPE, check=True).stdout.decode().strip()


def write_checks(plan, to):
    """tests/course: the kit, and answers, judges, exercises and known mistakes of the open weeks."""
    course = ROOT / 'tests/course'
    numbers = {e.number for e in plan.open}
    files = KIT + [f'{kind}_{w}.cpp' for w in plan.weeks for kind in ('answers', 'judge')]
    for file in with_headers(course, files):
        write(to / 'tests/course' / file, (course / file).read_text(), file in ('check', 'picture', 'report', 'update'))
    write(to / 'tests/course/questions.txt', rows((course / 'questions.txt').read_text(), lambda w: w in plan.weeks))
    commit = subprocess.run(['git', 'describe', '--always', '--dirty'], cwd=ROOT, capture_output=True, text=True).stdout.strip()
    write(to / 'tests/course/starter.txt', f'Starter of week{"s" if len(plan.weeks) > 1 else ""} {" ".join(plan.weeks)}, Penumbra {commit or "of unknown commit"}.\n')
    write(to / 'tests/course/exercises.txt', rows((course / 'exercises.txt').read_text(), lambda n: n in numbers))
    write(to / 'tests/course/mistakes.txt', rows((course / 'mistakes.txt').read_text(), lambda n: n in numbers))
    write(to / 'tests/course/frames.txt', ''.join(f'{f} {frame((to / "src" / f).read_text())}\n' for f in sorted({e.file for e in plan.open})))
    write(to / 'tests/oracle/oracle.h', (ROOT / 'tests/oracle/oracle.h').read_text())
    text = re.sub(r'\[bugs-found.md\].*?\n\n', '', (ROOT / 'tests/oracle/README.md').read_text(), flags=re.S)
    if '2' in plan.weeks:  # two examples sample spheres and triangles
        text = re.sub(r'```cpp\n((?!```).)*(std::cos|Triangle<3>)((?!```).)*```\n', '*(This example is an exercise of week 2.)*\n',
                      text, flags=re.S)
    write(to / 'tests/oracle/README.md', text)


def sheet_of(week):
    """The sheet of a week, if there is one."""
    names = {'V': 'voronoi', 'R': 'radiosity'}
    found = sorted((ROOT / 'reference/course').glob(f'{names[week]}.md' if week in names else f'{week}-*.md'))
    return found[0] if found else None


def write_rest(plan, to):
    """Scenes, sheets, Makefile, README, licence."""
    for path in sorted((ROOT / 'scenes').iterdir()):
        if path.suffix in ('.scene', '.obj', '.mtl') and 'build/' not in path.read_text():
            write(to / 'scenes' / path.name, path.read_text())
    listed = []
    for week in plan.weeks:
        sheet = sheet_of(week)
        if sheet:
            text = sheets.for_students(sheet.read_text())
            for picture in re.findall(r'!\[[^]]*\]\(([\w.-]+\.(?:png|svg))\)', text):
                (to / 'sheets').mkdir(exist_ok=True)
                if not (sheet.parent / picture).exists():
                    raise regions.Malformed(f"{sheet.name}: there is no picture {picture}")
                shutil.copy(sheet.parent / picture, to / "sheets" / picture)
            write(to / 'sheets' / sheet.name, text)
            listed.append((week, sheet.name, text.split('\n', 1)[0].lstrip('# ')))
    for name in ('systems', 'contest'):
        text = (ROOT / f'reference/course/{name}.md').read_text()
        write(to / f'sheets/{name}.md', text)
        listed.append((None, f'{name}.md', text.split('\n', 1)[0].lstrip('# ')))
    for name, place in (('starter.mk', 'Makefile'), ('Dockerfile', 'Dockerfile'), ('students-ci.yml', '.github/workflows/check.yml')):
        write(to / place, (ROOT / 'src/course' / name).read_text())
    points = sum(e.points for e in plan.open)
    hours = sum(e.hours for e in plan.open)
    write(to / 'README.md', '# A course with Penumbra\n\n'
          '    make                 # draws every scene into out/\n'
          '    make check EX=%s    # is this exercise right?\n'
          '    make check           # what is right, and what is to do\n'
          '    make report          # out/report/index.html: verdicts, pictures, your answers in answers.md; WEEKS=%s\n'
          '    make penumbra DEBUG=1    # build/penumbra-debug, for a debugger; make check EX=%s DEBUG=1\n'
          '    build/penumbra --pixel 100,60 scenes/cornell36.scene    # a pixel is wrong? every number of one of its paths\n'
          '    build/penumbra --show scenes/cornell36.scene    # out/cornell36.html shows the picture while it renders\n'
          '    make web             # (Debian, Ubuntu) your renderer in a browser, with every step of its paths: build/web/playground.html\n\n'
          % (plan.open[0].number, plan.weeks[0], plan.open[0].number) +
          'You need make, g++ 12 or clang++ 14, and stb (Debian, Ubuntu: `libstb-dev`); see *Setting up* for other systems, and for editors:\n'
          'clangd and Visual Studio Code know this folder, and `.devcontainer` has all in a container.\n'
          'Start with the sheet of the week.  '
          f'{len(plan.open)} exercises, {points} points, about {hours:g} hours.\n\n' +
          ''.join(f'* [{title}](sheets/{name})\n' for _, name, title in listed) +
          '\nAn exercise is what stands between `// BEGIN 2.2 ...` and `// END 2.2` in `src`: replace it.  What is there is\n'
          'wrong, but it compiles, and you can draw pictures from the first day.\n\n' +
          HAND_IN + '\n\n'
          '| exercise | | file | points | hours |\n|---|---|---|---|---|\n' +
          ''.join(f'| {e.number} | {e.title} | src/{e.file} | {e.points} | {e.hours:g} |\n' for e in plan.open))
    write(to / '.clang-format', (ROOT / '.clang-format').read_text() + 'ReflowComments: false\n')
    write(to / 'LICENSE', (ROOT / 'LICENSE').read_text())


def write_editors(plan, to):
    """What an editor reads: this project's files, with the exercises of these weeks to choose from."""
    flags = (ROOT / 'compile_flags.txt').read_text().splitlines(keepends=True)
    write(to / 'compile_flags.txt', ''.join(f for f in flags if not re.match('-DWITH_|-DTREE_', f)))
    read = {name: json.loads((ROOT / name).read_text()) for name in EDITORS}
    container, tasks, launch = (read[name] for name in EDITORS[:3])
    container['build'] = {'dockerfile': '../Dockerfile', 'args': {'MORE': 'clangd gdb'}}
    for task in tasks['tasks']:
        if task['label'] == 'test':
            task.update(label='check all exercises', command='make check')
    tasks['tasks'] = [of_week for t in tasks['tasks'] for of_week in each(t, plan, 'week')]
    tasks['inputs'] = [{'id': 'exercise', 'type': 'pickString', 'description': 'which exercise?',
                        'options': [e.number for e in plan.open], 'default': plan.open[0].number}]
    launch['configurations'] = [of_one for c in launch['configurations'] for of_one in each(c, plan, 'exercise')]
    launch['inputs'] = [i for i in launch['inputs'] if i['id'] in ('scene', 'pixel')]
    for name, data in read.items():
        write(to / name, json.dumps(data, indent=4) + '\n')


def each(item, plan, what):
    """A task or a way to debug; if it asks for a week, one of each week or exercise, and nothing is asked."""
    if '${input:week}' not in json.dumps(item):
        return [item]
    def of(e):
        text = json.dumps(item).replace('${input:week}', e.week).replace('${input:exercise}', e.number)
        text = text.replace('build a check for a debugger', f'build week {e.week} for a debugger')
        return json.loads(text.replace('the check of an exercise', f'{e.number} {e.title}'))
    firsts = {e.week: e for e in reversed(plan.open)}
    return [of(e) for e in plan.open if what == 'exercise' or e == firsts[e.week]]


def draw_expected(plan, to, suffix):
    """expected/: what the solution's programs of this suffix draw, by the same random numbers."""
    for line in (ROOT / 'tests/course/pictures.txt').read_text().splitlines():
        if line.startswith('#'):
            continue
        key, *_, order = (part.strip() for part in line.split('|'))
        if key.split('.')[0] not in plan.weeks:
            continue
        (to / 'expected').mkdir(exist_ok=True)
        program, *options = order.split()
        subprocess.run([f'build/{program}{suffix}', *options, '--quiet', '-o', str(to / f'expected/{key}.pfm')], check=True, cwd=ROOT)


def pack(folder):
    """FOLDER.tar.gz, the same bytes for the same content."""
    def plain(info):
        info.uid = info.gid = info.mtime = 0
        info.uname = info.gname = ''
        return info
    buffer = io.BytesIO()
    with tarfile.open(fileobj=buffer, mode='w') as tar:
        for path in sorted(folder.rglob('*')):
            tar.add(path, pathlib.Path('penumbra-starter') / path.relative_to(folder), recursive=False, filter=plain)
    import gzip
    with open(f'{folder}.tar.gz', 'wb') as file, gzip.GzipFile(filename='', fileobj=file, mode='wb', mtime=0) as packed:
        packed.write(buffer.getvalue())


def make_starter(plan, to, suffix=None):
    """Writes the folder anew; without a suffix, without expected pictures."""
    shutil.rmtree(to, ignore_errors=True)
    for step in (write_sources, write_checks, write_rest, write_editors):
        step(plan, to)
    if suffix is not None:
        draw_expected(plan, to, suffix)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split('\n', 1)[0])
    parser.add_argument('--weeks', default='1-6')
    parser.add_argument('--solved', action='store_true')
    parser.add_argument('--handed-in', action='store_true')
    parser.add_argument('--no-pictures', action='store_true')
    parser.add_argument('folder', type=pathlib.Path)
    words = parser.parse_args()
    plan = Plan(words.weeks, words.solved, words.handed_in)
    folder = words.folder.resolve()
    make_starter(plan, folder, None if words.no_pictures else os.environ.get('DRAW_SUFFIX', '-plain'))
    pack(folder)
    count = f'{len(plan.open)} exercise' + ('s' if len(plan.open) > 1 else '')
    print(f'{words.folder}, {words.folder}.tar.gz: {count} of week{"s" if len(plan.weeks) > 1 else ""} {" ".join(plan.weeks)}')


if __name__ == '__main__':
    try:
        main()
    except regions.Malformed as error:
        sys.exit(f'starter: {error}')
