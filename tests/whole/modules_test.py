# whole/modules_test.py  tests of tests/modules and make layers: python3 tests/whole/modules_test.py [NAME...]
"""Each function test_... is a test; scripts_test.cpp runs them one by one."""
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / 'tests/course'))
import testing
from testing import expect

FILES = {
    'src/world/tree.h': '#ifdef TREE_WIDE\n#include "wide/tree.h"\n#else\nstruct Tree {};\n#endif\n',
    'src/wide/tree.h': 'struct Tree {};\n',
    'src/app/render.h': '#ifdef WITH_KEEP\n#include "keep/keep.h"\n#else\nstruct Keeper {};\n#endif\n',
    'src/keep/keep.h': 'struct Keeper {};\n',
    'src/app/penumbra.cpp': '#include "app/render.h"\n#include "world/tree.h"\nint main() { Keeper(), Tree(); }\n',
    'src/shadow/shadow.cpp': '#include "keep/keep.h"\nint main() { Keeper(); }\n',
    'src/labs/lab.cpp': 'int main() {}\n',
    'reference/how-it-works.md': '| core 4 | `app` | programs |\n| module | `wide` | a tree |\n| module | `keep` | films; `--keep` |\n'
                                 '| module | `shadow` | shadows; needs `keep` |\n| | `labs` | experiments; needs `shadow` |\n',
}


def run(files, *words):
    return said_by(['tests/modules', *words], {**FILES, **files})


def said_by(command, files):
    """(exit status, what is said)"""
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        for name in ('Makefile', 'src/packages', 'tests/tests.mk', 'tests/modules', 'tests/layers'):
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(ROOT / name, folder / name)
        for name, text in files.items():
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            (folder / name).write_text(text)
        environment = {key: value for key, value in os.environ.items() if not key.startswith('MAKE')}
        done = subprocess.run(command, cwd=folder, capture_output=True, text=True, env=environment)
        return done.returncode, done.stdout + done.stderr


def test_what_is_left_compiles():
    expect(run({}) == (0, 'without wide: 2 programs compile\n'
                          'without keep (and labs shadow, which need it): 1 programs compile\n'
                          'without shadow (and labs, which need it): 1 programs compile\n'
                          'without labs: 2 programs compile\n'), *run({}))


def test_what_names_a_module_must_say_so():
    for name, text in (('src/app/penumbra.cpp', '#include "keep/keep.h"\nint main() {}\n'),
                       ('src/app/render.h', '#include "keep/keep.h"\n'),
                       ('reference/how-it-works.md', FILES['reference/how-it-works.md'].replace('; needs `keep`', ''))):
        status, said = run({name: text}, 'keep')
        expect(status == 1 and 'it does not compile\n' in said and 'keep/keep.h: No such file' in said, name, said)


def test_a_mistyped_path_is_no_other_program():
    status, said = run({'src/app/render.h': FILES['src/app/render.h'].replace('keep/keep.h', 'keep/kept.h')}, 'labs')
    expect(status == 1 and 'keep/kept.h: No such file' in said, said)


def test_a_module_that_is_none_is_refused():
    status, said = run({}, 'sahdow')
    expect(status == 1 and 'wide keep shadow labs' in said, said)


# Three headers in a row, of which the last may include the others; one of a module, a test's and a program.
NUMBERED = {f'{top}/{name}': f'// {name}  {number}  what it is\n{lines}' for top, name, number, lines in (
    ('src', 'world/shapes.h', 1, '#include <vector>\n'), ('src', 'world/tree.h', 2, '#include "wide/bvh.h"\n'),
    ('src', 'world/scene.h', 3, '#include "shapes.h"\n#include "world/tree.h"\n'), ('src', 'path/li.h', 1, '#include "world/scene.h"\n'),
    ('src', 'wide/bvh.h', 1, '#include "world/shapes.h"\n'), ('src', 'keep/keep.h', 1, '#include <string>\n'),
    ('src', 'app/penumbra.cpp', 9, '#include "path/li.h"\n'), ('tests', 'world/near.h', '', '#include "world/scene.h"\n'))}


def test_includes_go_downwards():
    expect(said_by(['make', '-s', 'layers'], NUMBERED) == (0, '7 includes, all downwards\n'), said_by(['make', '-s', 'layers'], NUMBERED))


def test_an_include_that_does_not_is_refused():
    for name, line, why in (
            ('src/world/scene.h', '#include <string>', 'the lecture knows no text, file or thread'),
            ('src/path/li.h', '#include <thread>', 'the lecture knows no text, file or thread'),
            ('src/path/li.h', '#  include <cstring>', 'the lecture knows no text, file or thread'),
            ('src/world/scene.h', '#include "path/li.h"', 'world/scene.h is not above path/li.h'),
            ('src/world/shapes.h', '#include "scene.h"', 'world/shapes.h is not above world/scene.h'),  # a cycle
            ('src/world/scene.h', '#include "world/scene.h"', 'world/scene.h is not above world/scene.h'),
            ('src/world/scene.h', '#include "world/none.h"', 'world/scene.h is not above world/none.h'),
            ('src/world/scene.h', '#include "world/near.h"', 'world/scene.h is not above world/near.h'),
            ('src/world/scene.h', '#include "wide/bvh.h"', 'world/scene.h is not above wide/bvh.h'),  # tree.h is the door
            ('src/app/penumbra.cpp', '#include "keep/keep.h"', 'app/penumbra.cpp is not above keep/keep.h'),
            ('src/wide/bvh.h', '#include "world/tree.h"', 'wide/bvh.h is not above world/tree.h'),
            ('tests/world/near.h', '#include "path/li.h"', 'world/near.h is not above path/li.h')):
        at = NUMBERED[name].count('\n') + 1
        status, said = said_by(['make', '-s', 'layers'], {**NUMBERED, name: f'{NUMBERED[name]}{line}\n'})
        expect(status == 2 and said.startswith(f'{name}:{at}: {why}\nmake: '), name, line, said)


def test_a_header_has_a_name_and_a_number_in_a_folder_of_a_layer():
    for name, text, why in (
            ('src/path/li.h', '// path/li.h  what it is and does\n', 'line 1 must say: // path/li.h  NUMBER  what it is'),
            ('src/path/li.h', '// path/step.h  1  what it is\n', 'line 1 must say: // path/li.h  NUMBER  what it is'),
            ('src/paths/li.h', '// paths/li.h  1  what it is\n', 'no such folder in LAYERS')):
        status, said = said_by(['make', '-s', 'layers'], {**NUMBERED, name: text})
        expect(status == 2 and said.startswith(f'{name}: {why}\n'), name, said)


if __name__ == '__main__':
    testing.run(globals())
