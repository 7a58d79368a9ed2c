# whole/cmake_test.py  tests of CMakeLists.txt: python3 tests/whole/cmake_test.py [NAME...]
"""Each function test_... is a test; cmake_test.cpp runs them one by one."""
import json
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / 'tests/course'))
import testing
from testing import expect

ENVIRONMENT = {key: value for key, value in os.environ.items() if not key.startswith(('MAKE', 'MFLAGS', 'CMAKE', 'ONLY'))}
PROJECT = 'cmake_minimum_required(VERSION 3.21)\nproject(mine LANGUAGES CXX)\n'
USE = 'add_executable(hello hello.cpp)\ntarget_link_libraries(hello PRIVATE penumbra::oracle)\n'


def run(*words, cwd=ROOT):
    """(exit status, what is said)"""
    done = subprocess.run([str(w) for w in words], cwd=cwd, env=ENVIRONMENT, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    return done.returncode, done.stdout


def well(*words, cwd=ROOT):
    status, said = run(*words, cwd=cwd)
    expect(status == 0, *words, said)
    return said


class Room:
    """A folder with an empty project of others, and the only files of ours that the oracle needs."""

    def __enter__(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.top = pathlib.Path(self.temporary.name).resolve()
        for name in ('CMakeLists.txt', 'tests/oracle/oracle.h', 'tests/oracle/expect.h'):
            (self.top / 'ours' / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(ROOT / name, self.top / 'ours' / name)
        (self.top / 'mine').mkdir()
        readme = (ROOT / 'README.md').read_text()
        (self.top / 'mine/hello.cpp').write_text(re.search(r'^```cpp\n(.*?)^```$', readme, re.M | re.S)[1])
        return self

    def __exit__(self, *_):
        self.temporary.cleanup()

    def configure(self, text, build='out', *words):
        (self.top / 'mine/CMakeLists.txt').write_text(PROJECT + text)
        return run('cmake', '-S', self.top / 'mine', '-B', self.top / build, *words)

    def greets(self, text, *words):
        """The README's program is built within the project, and finds the mistake."""
        status, said = self.configure(text + USE, 'out', *words)
        expect(status == 0, said)
        well('cmake', '--build', self.top / 'out')
        said = run(self.top / 'out/hello')[1]
        expect('theta drawn uniformly' in said, said)
        return self.top / 'out'

    def installed(self):
        well('cmake', '-S', self.top / 'ours', '-B', self.top / 'built', '-DPENUMBRA_PROGRAMS=OFF')
        well('cmake', '--build', self.top / 'built')
        well('cmake', '--install', self.top / 'built', '--prefix', self.top / 'prefix')
        return f'-DCMAKE_PREFIX_PATH={self.top}/prefix'


def entries(build):
    return set(re.findall(r'^(\w+):\w+=', (build / 'CMakeCache.txt').read_text(), re.M))


def test_fetch_content_brings_the_oracle():
    with Room() as room:
        git = ['git', '-C', room.top / 'ours', '-c', 'user.name=x', '-c', 'user.email=x@x']
        for words in (['init', '-q'], ['add', '.'], ['commit', '-q', '-m', 'x']):
            well(*git, *words)
        tag = well(*git, 'rev-parse', 'HEAD').strip()
        room.greets(f'include(FetchContent)\nFetchContent_Declare(penumbra GIT_REPOSITORY file://{room.top}/ours GIT_TAG {tag})\n'
                    'FetchContent_MakeAvailable(penumbra)\n')


def test_a_subdirectory_is_the_oracle_and_changes_nothing_else():
    with Room() as room:
        status, said = room.configure('', 'without')
        expect(status == 0, said)
        built = room.greets('add_compile_options(-Weffc++ -Wfloat-equal -Werror)\nset(CMAKE_CXX_STANDARD 17)\nadd_subdirectory(../ours ours)\n'
                            'get_property(targets DIRECTORY ../ours PROPERTY BUILDSYSTEM_TARGETS)\n'
                            'get_property(tests DIRECTORY ../ours PROPERTY TESTS)\n'
                            'get_property(ours DIRECTORY . PROPERTY COMPILE_OPTIONS)\n'
                            'file(WRITE ${CMAKE_BINARY_DIR}/said "${targets}|${tests}|${ours}|${CMAKE_CXX_STANDARD}${CMAKE_EXPORT_COMPILE_COMMANDS}")\n')
        expect((built / 'said').read_text() == 'penumbra_oracle||-Weffc++;-Wfloat-equal;-Werror|17', (built / 'said').read_text())
        # CMake itself keeps the version of any project.
        new = {e for e in entries(built) - entries(room.top / 'without') if not e.lower().startswith(('penumbra_', 'cmake_project_version'))}
        expect(not new, new)
        well('cmake', '--install', built, '--prefix', room.top / 'prefix')
        expect(not (room.top / 'prefix').exists(), 'it installs itself among others\' files')
        header = room.top / 'ours/tests/oracle/oracle.h'
        header.write_text(header.read_text() + '#error changed\n')
        status, said = run('cmake', '--build', built)
        expect(status != 0 and '#error changed' in said, 'a header that changed is not seen', said)


def test_its_parts_do_not_stand_before_headers_of_others():
    with Room() as room:
        for part in sorted(p.name for p in (ROOT / 'tests/oracle').glob('*.h')):
            shutil.copy(ROOT / 'tests/oracle' / part, room.top / 'ours/tests/oracle')
        (room.top / 'mine/hello.cpp').write_text('#include "oracle.h"\n#if __has_include("checks.h") || !__has_include("expect.h")\n#error others\n#endif\n'
                                                 'int main() {}\n')
        status, said = room.configure('add_subdirectory(../ours ours)\n' + USE)
        expect(status == 0, said)
        well('cmake', '--build', room.top / 'out')


def test_an_installed_package_is_found_by_its_version():
    with Room() as room:
        prefix = room.installed()
        number = int(re.search(r'#define ORACLE_VERSION (\d+)', (ROOT / 'tests/oracle/oracle.h').read_text())[1])
        major, minor = number // 10000, number // 100 % 100
        built = room.greets(f'find_package(penumbra {major} REQUIRED)\nfile(WRITE ${{CMAKE_BINARY_DIR}}/said ${{penumbra_VERSION}})\n', prefix)
        expect((built / 'said').read_text() == f'{major}.{minor}', (built / 'said').read_text())
        files = sorted(str(p.relative_to(room.top / 'prefix')) for p in (room.top / 'prefix').rglob('*') if p.is_file())
        expect(files == ['include/penumbra/expect.h', 'include/penumbra/oracle.h', 'share/cmake/penumbra/penumbraConfig.cmake',
                         'share/cmake/penumbra/penumbraConfigVersion.cmake'], files)
        for wanted, found in ((f'{major}.{minor}', True), (f'{major}.{minor} EXACT', True), (major + 1, False), (major - 1, False),
                              (f'{major}.{minor + 1}', False)):
            status, said = room.configure(f'find_package(penumbra {wanted} REQUIRED)\n', f'v{wanted}'.replace(' ', ''), prefix)
            expect((status == 0) == found, wanted, said)


def test_a_build_in_the_folder_itself_is_refused():
    with Room() as room:
        (room.top / 'ours/Makefile').write_text('ours\n')
        status, said = run('cmake', '.', '-DPENUMBRA_PROGRAMS=OFF', cwd=room.top / 'ours')
        expect(status != 0 and 'cmake -B build' in said, said)
        expect((room.top / 'ours/Makefile').read_text() == 'ours\n', 'the Makefile is another one')


def test_folders_have_spaces_and_other_names():
    with tempfile.TemporaryDirectory() as folder:
        top = pathlib.Path(folder)
        (top / 'a way').mkdir()
        (top / 'a way/source').symlink_to(ROOT)
        for source, build in ((ROOT, top / 'a build'), (top / 'a way/source', top / 'a way/b')):
            well('cmake', '-S', source, '-B', build, '-DPENUMBRA_TESTS=OFF')
            well('cmake', '--build', build, '--target', 'commit')
            status, said = run('git', '-C', ROOT, 'describe', '--always', '--dirty')
            described = 'unknown commit' if status else said.strip()
            expect(described.encode() in (build / 'commit/commit.o').read_bytes(), 'it names another commit', described)


def test_packages_that_are_missing_are_named_and_found_later():
    with tempfile.TemporaryDirectory() as folder:
        nowhere = ['-DCMAKE_FIND_ROOT_PATH=/nowhere', '-DCMAKE_FIND_ROOT_PATH_MODE_INCLUDE=']
        for given, package in (([], 'libstb-dev'), (['-DPENUMBRA_STB=/usr/include'], 'doctest-dev')):
            status, said = run('cmake', '-B', folder, nowhere[0], nowhere[1] + 'ONLY', *given)
            expect(status != 0 and f'sudo apt-get install {package}' in said.replace('\n  ', ' '), said)
        well('cmake', '-B', folder, nowhere[1] + 'BOTH')


def flags(command):
    """What a compiler makes of a file; folders and names of files aside."""
    words = iter(shlex.split(command)[1:])
    words = [w for w in words if not w.startswith(('-I', '-M', '-fmacro-prefix-map')) and not (w in ('-o', '-MF', '-MT') and next(words))
            and w != '-c' and not w.endswith(('.cpp', '.o', '.d', '.exe'))]
    return [w for i, w in enumerate(words) if not (w.startswith('-D') and w in words[:i])]  # CMake says nothing twice


def compiled_by_make(words, objects):
    """{object of make: flags} of all programs, and of the units of make test."""
    said = well('make', 'told', *words)
    told = {line.split(' ')[0]: line.split()[1:] for line in said.splitlines()}
    goals = ([f'{objects}/{pathlib.Path(p).stem}.exe' for p in told['PROGRAMS']] + [f'{objects}/programs.exe'] +
             [f'{objects}/tests/{unit}.exe' for unit in told['UNITS']])
    lines = well('make', '-n', f'OBJECTS={objects}', *words, *goals).replace('\\\n', ' ').splitlines()
    return {re.search(r' -o (\S+)', line)[1]: line.split(' && ')[0] for line in lines if re.search(r' -o \S+ \S*\.cpp', line)}


def test_every_program_and_test_has_the_flags_of_make():
    for compiler, words, options in (('g++', [], []), ('g++', ['REAL=float', 'TREE=plain'], []), ('g++', ['SAN=1'], []),
                                     ('g++', ['DEBUG=1'], ['-DCMAKE_BUILD_TYPE=Debug']), ('clang++', ['ARCH=x86-64'], [])):
        if not shutil.which(compiler):
            print(f'not tested: {compiler} is not installed')
            continue
        with tempfile.TemporaryDirectory() as folder:
            passed = [w for w in words if w != 'DEBUG=1']
            well('cmake', '-G', 'Unix Makefiles', '-B', folder, f'-DCMAKE_CXX_COMPILER={compiler}', f'-DPENUMBRA_MAKE={" ".join(passed)}', *options)
            ours = {}
            for entry in json.loads((pathlib.Path(folder) / 'compile_commands.json').read_text()):
                name = pathlib.Path(entry['file']).stem
                ours[name[6:] if name.startswith('tests-') else name] = entry['command']
            theirs = {pathlib.Path(o).stem: command for o, command in compiled_by_make([f'CXX={compiler}', *words], 'build/nothing').items()}
            theirs.pop('commit', None)
            expect(set(ours) == set(theirs) and 'core-heavy' in ours and 'penumbra' in ours, sorted(ours), sorted(theirs))
            for name, command in ours.items():
                same = flags(command)
                if options:
                    same.remove('-g')  # CMake's own of Debug, once more
                expect(same == flags(theirs[name]) and '-std=c++20' in same, compiler, words, name, same, flags(theirs[name]))
            link = (pathlib.Path(folder) / 'CMakeFiles/penumbra.dir/link.txt').read_text()
            expect(('-fsanitize' in link) == ('SAN=1' in words), link)


def test_ctest_runs_what_make_test_runs():
    with tempfile.TemporaryDirectory() as folder:
        well('cmake', '-B', folder)
        ours = json.loads(well('ctest', '--test-dir', folder, '--show-only=json-v1'))['tests']
        theirs = subprocess.run(['make', '-s', 'test'], cwd=ROOT, env={**ENVIRONMENT, 'LIST': '1'}, capture_output=True, text=True).stdout.split()
        expect(len(theirs) > 50 and sorted(t['name'] for t in ours) == sorted(theirs), len(theirs), {t['name'] for t in ours} ^ set(theirs))


def test_a_test_is_built_and_runs():
    with tempfile.TemporaryDirectory() as folder:
        well('cmake', '-B', folder)
        well('cmake', '--build', folder, '--target', 'tests-base')
        said = well('ctest', '--test-dir', folder, '-R', '^base/', '--no-tests=error')
        count = len(list((ROOT / 'tests/base').glob('*_test.cpp')))
        expect(f'100% tests passed, 0 tests failed out of {count}\n' in said, said)


if __name__ == '__main__':
    if not shutil.which('cmake') and sys.argv[1:] != ['--list']:
        print('not tested: cmake is not installed')
    else:
        testing.run(globals())
