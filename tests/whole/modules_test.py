# whole/modules_test.py  tests of tests/modules: python3 tests/whole/modules_test.py [NAME...]
"""Each function test_... is a test; modules_test.cpp runs them one by one."""
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
    'src/app/keep.h': '#ifdef WITH_KEEP\n#include "keep/keep.h"\n#else\nstruct Keeper {};\n#endif\n',
    'src/keep/keep.h': 'struct Keeper {};\n',
    'src/app/penumbra.cpp': '#include "app/keep.h"\n#include "world/tree.h"\nint main() { Keeper(), Tree(); }\n',
    'src/shadow/shadow.cpp': '#include "keep/keep.h"\nint main() { Keeper(); }\n',
    'src/labs/lab.cpp': 'int main() {}\n',
    'reference/how-it-works.md': '| core 4 | `app` | programs |\n| module | `wide` | a tree |\n| module | `keep` | films; `--keep` |\n'
                                 '| module | `shadow` | shadows; needs `keep` |\n| | `labs` | experiments; needs `shadow` |\n',
}


def run(files, *words):
    """(exit status, what is said)"""
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        for name in ('Makefile', 'src/packages', 'tests/tests.mk', 'tests/modules'):
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(ROOT / name, folder / name)
        for name, text in {**FILES, **files}.items():
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            (folder / name).write_text(text)
        environment = {key: value for key, value in os.environ.items() if not key.startswith('MAKE')}
        done = subprocess.run([str(folder / 'tests/modules'), *words], capture_output=True, text=True, env=environment)
        return done.returncode, done.stdout + done.stderr


def test_what_is_left_compiles():
    expect(run({}) == (0, 'without wide: 2 programs compile\n'
                          'without keep (and labs shadow, which need it): 1 programs compile\n'
                          'without shadow (and labs, which need it): 1 programs compile\n'
                          'without labs: 2 programs compile\n'), *run({}))


def test_what_names_a_module_must_say_so():
    for name, text in (('src/app/penumbra.cpp', '#include "keep/keep.h"\nint main() {}\n'),
                       ('src/app/keep.h', '#include "keep/keep.h"\n'),
                       ('reference/how-it-works.md', FILES['reference/how-it-works.md'].replace('; needs `keep`', ''))):
        status, said = run({name: text}, 'keep')
        expect(status == 1 and 'it does not compile\n' in said and 'keep/keep.h: No such file' in said, name, said)


def test_a_mistyped_path_is_no_other_program():
    status, said = run({'src/app/keep.h': FILES['src/app/keep.h'].replace('keep/keep.h', 'keep/kept.h')}, 'labs')
    expect(status == 1 and 'keep/kept.h: No such file' in said, said)


def test_a_module_that_is_none_is_refused():
    status, said = run({}, 'sahdow')
    expect(status == 1 and 'wide keep shadow labs' in said, said)


if __name__ == '__main__':
    testing.run(globals())
