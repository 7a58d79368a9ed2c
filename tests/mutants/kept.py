# mutants/kept.py  keeps verdicts in build/mutants.verdicts, as long as they hold
"""A line of it is a fingerprint and a verdict.  The fingerprint covers the compiler's flags, the mutant, its source, and
all files that its test and the test's programs include; it covers the whole project if a test reads other files."""
import functools
import hashlib
import re
from pathlib import Path

from mutants import ROOT, source

PATH = ROOT / 'build/mutants.verdicts'
PROJECT = 'src tests scenes reference CMakeLists.txt Makefile README.md LICENSE .clang-format compile_flags.txt .vscode .devcontainer'.split()
SEES_MORE = re.compile(r'popen|system\(|exec[lv]|"(src|tests|scenes|reference|\.\.?)/')


@functools.cache
def included(path):
    """A file, and all that it includes of the project."""
    found, new = set(), {path}
    while new:
        found |= new
        new = {p for f in new for name in re.findall(r'^#include "(.*)"', (ROOT / f).read_text(), re.M)
               for p in (f.parent / name, Path('src', name), Path('tests', name)) if (ROOT / p).is_file()} - found
    return found


@functools.cache
def whole_project():
    return frozenset(p.relative_to(ROOT) for part in PROJECT for p in [ROOT / part, *(ROOT / part).rglob('*')]
                     if p.is_file() and '__pycache__' not in p.parts)


@functools.cache
def digest(paths):
    return [(str(p), hashlib.sha256((ROOT / p).read_bytes()).digest()) for p in sorted(paths)]


def fingerprint(m, flags):
    paths = {Path('tests/main.cpp'), Path('tests/std.h'), Path(m.file)}.union(
        included(source('tests', m.test)), *[included(source('src', p)) for p in m.program.split()])
    if Path(m.file).suffix not in ('.h', '.cpp') or any(SEES_MORE.search((ROOT / p).read_text()) for p in paths):
        paths = whole_project()
    said = (flags, m.name, m.head, m.old, m.new, digest(frozenset(paths)))
    return hashlib.sha256(repr(said).encode()).hexdigest()[:32]


def read():
    """{fingerprint: verdict}"""
    return dict(line.split(' ', 1) for line in PATH.read_text().splitlines()) if PATH.exists() else {}


def write(print_of_it, verdict):
    with PATH.open('a') as file:
        file.write(f'{print_of_it} {verdict}\n')
