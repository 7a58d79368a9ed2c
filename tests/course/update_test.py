# course/update_test.py  a later starter taken into ten modified copies: python3 tests/course/update_test.py [NAME...]
"""Each function test_... is a test; starter_test.cpp runs them one by one."""
import functools
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / 'src/course'))
import region
import regions
import starter
import testing
from testing import expect

BVH, WARP, SHAPES = 'src/world/bvh.h', 'src/world/warp.h', 'src/world/shapes.h'


@functools.cache
def packed(weeks, top):
    folder = pathlib.Path(top) / weeks
    starter.make_starter(starter.Plan(weeks), folder)
    starter.pack(folder)
    return folder


def edit(name, old, new):
    def change(folder):
        text = (folder / name).read_text()
        expect(old in text, f'{old!r} is not in {name}')
        (folder / name).write_text(text.replace(old, new, 1))
    return change


def solve(folder):
    """Week 1 as in the solution."""
    for number, (name, r) in regions.solution_files().items():
        if number[0] == '1':
            path = folder / name
            text = '\n'.join(r.solution) + '\n'
            path.write_text(re.sub(rf'(// BEGIN {re.escape(number)} .*\n)(?s:.*?)([ ]*// END {re.escape(number)}\n)',
                                   lambda m: m[1] + text + m[2], path.read_text()))


def formatted(folder):
    if shutil.which('clang-format'):
        subprocess.run(['clang-format', '-i', '--style=LLVM', BVH, WARP, SHAPES], cwd=folder, check=True)


def windows(folder):
    for name in (BVH, WARP, SHAPES):
        (folder / name).write_bytes((folder / name).read_bytes().replace(b'\n', b'\r\n'))


# What students do to a copy, and the files whose versions are to be kept beside the later ones.
COPIES = {
    'nothing': (lambda folder: None, []),
    'solved': (solve, []),
    'comments': (edit(SHAPES, '// END 1.2', '    // my notes\n    // END 1.2'), []),
    'formatted': (lambda folder: (solve(folder), formatted(folder)), None),
    'windows': (lambda folder: (solve(folder), windows(folder)), []),
    'own helper': (edit(BVH, '#pragma once', '#pragma once\nint helper();'), [BVH]),
    'own files': (lambda folder: (folder / 'src/notes.txt').write_text('mine'), []),
    'own scene': (edit('scenes/cornell36.scene', '\n', '\n# mine\n'), ['scenes/cornell36.scene']),
    'deleted': (lambda folder: shutil.rmtree(folder / 'sheets'), []),
    'built': (lambda folder: starter.write(folder / 'build/penumbra', 'a program'), []),
    'mark lost': (edit(BVH, '// END 1.4', ''), [BVH]),
}


def test_a_later_starter_keeps_what_was_written():
    with tempfile.TemporaryDirectory() as top:
        first, second = packed('1', top), packed('1-2', top)
        for name, (change, kept) in COPIES.items():
            copy = pathlib.Path(top) / 'copy'
            shutil.rmtree(copy, ignore_errors=True)
            shutil.copytree(first, copy)
            change(copy)
            before = {p.relative_to(copy): p.read_bytes() for p in copy.rglob('*') if p.is_file()}
            done = subprocess.run(['tests/course/update', f'{second}.tar.gz'], cwd=copy, capture_output=True, text=True)
            expect(done.returncode == 0, name, done.stderr)
            for number, (file, r) in regions.solution_files().items():
                if number[0] in '12':
                    text = region.region((copy / file).read_bytes(), number, file).text
                    old = before[pathlib.Path(file)]
                    mine = number[0] == '1' and not (name == 'mark lost' and number == '1.4')
                    wanted = region.region(old, number, file).text if mine else '\n'.join(r.stub)
                    expect(region.canonical(text) == region.canonical(wanted), name, number, text)
            for path in second.rglob('*'):
                if path.is_file() and not str(path.relative_to(second)).startswith(('src/', 'scenes/')):
                    expect((copy / path.relative_to(second)).read_bytes() == path.read_bytes(), name, path)
            extra = {p for p in before if not (second / p).exists()}
            expect(all((copy / p).read_bytes() == before[p] for p in extra), name, 'a file of their own changed')
            if kept is not None:
                found = sorted(str(p.relative_to(copy)) for p in copy.rglob('*.mine'))
                expect(found == [f + '.mine' for f in kept], name, found)


def test_what_was_built_of_older_files_is_built_again():
    with tempfile.TemporaryDirectory() as top:
        copy, later = pathlib.Path(top) / 'copy', pathlib.Path(top) / 'later'
        starter.make_starter(starter.Plan('1'), copy)
        shutil.copytree(copy, later)
        for path in copy.rglob('*'):
            os.utime(path, (1e9, 1e9))
        (later / 'tests/course/judge_1.cpp').open('a').write('// a mended judge\n')
        (later / 'src/new.h').write_text('')
        starter.pack(later)
        subprocess.run(['tests/course/update', f'{later}.tar.gz'], cwd=copy, check=True, capture_output=True)
        newer = sorted(str(p.relative_to(copy)) for p in copy.rglob('*') if p.is_file() and p.stat().st_mtime != 1e9)
        expect(newer == ['src/new.h', 'tests/course/judge_1.cpp'], newer)
        expect(all(p.stat().st_mtime >= 1e9 for p in copy.rglob('*')), 'older than what it replaces')


def test_what_is_no_starter_is_refused():
    with tempfile.TemporaryDirectory() as top:
        first = packed('1', top)
        for words, says in (([], 'no file'), (['nowhere.tar.gz'], 'no file')):
            done = subprocess.run(['tests/course/update', *words], cwd=first, capture_output=True, text=True)
            expect(done.returncode == 2 and says in done.stderr, done)
        done = subprocess.run([str(regions.ROOT / 'tests/course/update'), f'{first}.tar.gz'], capture_output=True, text=True)
        expect(done.returncode == 2 and 'the solution' in done.stderr, done)


if __name__ == '__main__':
    testing.run(globals())
