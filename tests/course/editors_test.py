# course/editors_test.py  what editors and debuggers are given: python3 tests/course/editors_test.py [NAME...]
"""Each function test_... is a test; starter_test.cpp runs them one by one."""
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

sys.path[:0] = [str(pathlib.Path(__file__).resolve().parents[2] / 'src/course')]
import starter
import testing
from regions import ROOT
from testing import expect

ENVIRONMENT = {k: v for k, v in os.environ.items() if k not in ('MAKEFLAGS', 'MAKELEVEL', 'FLAGS', 'CXX', 'REAL', 'TREE', 'DEBUG', 'SAN', 'SUFFIX')}
# It makes each program a script that says its name.
COMPILER = '''#!/bin/sh
[ "$1" = -x ] && exit
while [ "$1" != -o ]; do shift; done
printf '#!/bin/sh\\necho "$0 $*" >>ran\\n' >"$2"; chmod +x "$2"
'''


class Made:
    """A starter of some weeks, without pictures."""

    def __init__(self, *words, **more):
        self.plan = starter.Plan(*words, **more)

    def __enter__(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self.temporary.name) / 'starter'
        starter.make_starter(self.plan, self.folder)
        return self

    def __exit__(self, *_):
        self.temporary.cleanup()

    def run(self, command, **more):
        return subprocess.run(['bash', '-c', command], cwd=self.folder, env={**ENVIRONMENT, **more}, capture_output=True, text=True)


def flags_for_editors(folder):
    """What the Makefile's FLAGS are without those that optimise, name a processor or list what was read, and the tests' folder."""
    done = subprocess.run(['make', '-s', '--no-print-directory', '--eval=print-flags:;@echo "$(FLAGS)"', 'print-flags', 'HOMEBREW='], cwd=folder,
                          env=ENVIRONMENT, capture_output=True, text=True)
    words = done.stdout.split()
    expect('-std=c++20' in words, done.stdout, done.stderr)
    return ['-xc++'] + [w for w in words if not re.match('-march|-f|-M|-Werror|-Wno-', w)] + ['-Itests']


def tasks_of(folder):
    """Commands by label, with an exercise and a week where they ask for one."""
    tasks = json.loads((folder / '.vscode/tasks.json').read_text())
    default = {i['id']: i['default'] for i in tasks['inputs']}
    return {t['label']: filled(t['command'], default).replace('${relativeFile}', 'scenes/cornell.scene') for t in tasks['tasks']}


def filled(text, default):
    return re.sub(r'\$\{input:(\w+)\}', lambda m: default[m[1]], text)


def programs_to_debug(folder):
    """(name, task, words) of each way to debug, in place of questions their defaults."""
    launch = json.loads((folder / '.vscode/launch.json').read_text())
    default = {i['id']: i['default'] for i in launch['inputs']}
    expect(set(re.findall(r'input:(\w+)', json.dumps(launch['configurations']))) == set(default), default)
    return [(c['name'], c['preLaunchTask'], [filled(w, default).replace('${workspaceFolder}/', '') for w in [c['program'], *c['args']]])
            for c in launch['configurations']]


def test_clangd_has_the_flags_of_the_compiler():
    expect((ROOT / 'compile_flags.txt').read_text().split() == flags_for_editors(ROOT), flags_for_editors(ROOT))
    with Made('2-3') as made:
        expect((made.folder / 'compile_flags.txt').read_text().split() == flags_for_editors(made.folder), flags_for_editors(made.folder))


def test_each_task_of_a_starter_runs():
    with Made('1-2') as made:
        starter.write(made.folder / 'cxx', COMPILER, True)
        tasks = tasks_of(made.folder)
        expect('check all exercises' in tasks and 'build week 2 for a debugger' in tasks, tasks)
        for label, command in tasks.items():
            done = made.run(command.replace(' WATCH=1', ''), CXX='./cxx')  # which does not end
            expect(done.returncode == 0, label, command, done.stdout, done.stderr)
        ran = (made.folder / 'ran').read_text()
        expect('build/penumbra --show scenes/cornell.scene\n' in ran, ran)
        # What is debugged is there once its task has run.
        for name, task, words in programs_to_debug(made.folder):
            programs = [w for w in words if w.startswith('build/')]
            for program in programs:
                (made.folder / program).unlink(missing_ok=True)
            done = made.run(tasks[task], CXX='./cxx')
            expect(programs and all((made.folder / p).exists() for p in programs), name, task, programs, done.stderr)


def test_a_starter_has_each_of_its_exercises_to_debug_and_to_choose():
    with Made('2,V') as made:
        numbers = [e.number for e in made.plan.open]
        words = {name: ' '.join(w) for name, _, w in programs_to_debug(made.folder)}
        for e in made.plan.open:
            expect(words.pop(f'{e.number} {e.title}') == f'build/course-debug/judge_{e.week} --patience 100000 {e.number} -- '
                   f'build/course-debug/answers_{e.week}', e.number, words)
        expect(sorted(words) == ['a picture', 'one path of a pixel'], words)
        [choice] = json.loads((made.folder / '.vscode/tasks.json').read_text())['inputs']
        expect(choice['options'] == numbers and choice['default'] == '2.1', choice)


def test_here_tasks_name_targets_and_programs_that_make_knows():
    tasks = tasks_of(ROOT)
    rules = ''.join(p.read_text() for p in (ROOT / 'Makefile', ROOT / 'tests/tests.mk', ROOT / 'src/course/course.mk'))
    for label, command in tasks.items():
        for part in command.split(' && '):
            program, *words = part.split()
            targets = [w for w in words if '=' not in w]
            if program != 'make':
                expect(program == 'build/penumbra', label)
                continue
            for target in (t for t in targets if '/' not in t):
                expect(re.search(rf'^{target}\b.*:', rules, re.M), label, target)
            files = [t for t in targets if '/' in t]
            if files:
                done = subprocess.run(['make', '-n', *files, *(w for w in words if '=' in w)], cwd=ROOT, env=ENVIRONMENT, capture_output=True, text=True)
                expect(done.returncode == 0, label, done.stderr)
    for name, task, words in programs_to_debug(ROOT):
        built = tasks[task] + ('-debug' if tasks[task] == 'make build/penumbra DEBUG=1' else '')
        for program in (w for w in words if w.startswith('build/')):
            expect(program in built.replace('build/penumbra DEBUG=1', 'build/penumbra') if 'penumbra' in program else program in built.split(), name, built)


def test_containers_have_a_dockerfile_that_takes_packages():
    with Made('1') as made:
        for folder in (ROOT, made.folder):
            container = json.loads((folder / '.devcontainer/devcontainer.json').read_text())
            file = folder / '.devcontainer' / container['build']['dockerfile']
            text = file.read_text()
            expect('ARG MORE=\n' in text and ' $MORE ' in text and {'clangd', 'gdb'} <= set(container['build']['args']['MORE'].split()), folder, text)
            expect(f'useradd --create-home {container["remoteUser"]}\n' in text, text)
            recommended = json.loads((folder / '.vscode/extensions.json').read_text())['recommendations']
            expect(container['customizations']['vscode']['extensions'] == recommended, recommended)
            json.loads((folder / '.vscode/settings.json').read_text())


if __name__ == '__main__':
    testing.run(globals())
