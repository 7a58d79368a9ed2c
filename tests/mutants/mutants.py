# mutants/mutants.py  parses the mutants in this folder: mistakes that someone might make
"""A file has the mutants of one folder: world.mutants those of src/world.  Lines that apply to all mutants of a source
stand before them, the source first:

    file: src/world/bvh.h    the source, of src or tests, scripts among them
    test: bvh_test           the test file that must fail, without its folder
    case: *part of a name*   only these test cases of it (doctest's -tc)
    program: penumbra        builds build/penumbra, too, for tests that run it; or several
    needs: bwrap             without this command (root: who is not root) the test skips, and the mutant is left out

A mutant is a block.  Its first line has a unique name and describes the mistake.  All of these but file may follow and
override those of the source, and so may

    equivalent: proof        no test can detect it, so all must pass

Three more lines make it a known mistake of the course (course/mistakes.py).  With `test: judge` the course's judge must
refuse it when `make mistakes` plants it, and `make mutants` leaves it out.  Its edit is written as a diff: lines begin
with - (right), + (wrong) or a blank (unchanged).  The right and the unchanged lines are adjacent, and occur exactly once
in the source.

    @@ box_one_axis: a ray inside one slab is said to be inside the box
    exercise: 1.4
    says: a ray between the planes of one axis is taken to be in the box
    read: Three slabs
     for (int k = 0; k < 3; ++k)
    -    enter = std::max(enter, lo[k]);
    +    enter = lo[k];
"""
import dataclasses
import functools
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
ABOVE = ('file', 'test', 'case', 'program', 'needs')
KEYS = ABOVE[1:] + ('equivalent', 'exercise', 'says', 'read')


class Malformed(Exception):
    """Lines that are not a mutant, or do not fit their source."""


@dataclasses.dataclass
class Mutant:
    """head: {key: value in its block or above those of its source}.  Its keys are attributes, too."""
    name: str
    head: dict
    old: str = ''  # right and unchanged lines
    new: str = ''  # the lines in their place
    path: str = dataclasses.field(default='', compare=False)

    def __getattr__(self, key):
        if key not in ABOVE + KEYS + ('what',):
            raise AttributeError(key)
        return self.head.get(key, '')


def parse(text, path=''):
    """The mutants of a file, in order."""
    shared, found = {}, []
    head = shared  # of the source or of the mutant that the line belongs to
    for i, line in enumerate(text.split('\n'), 1):
        key, colon, value = line.partition(': ')
        if line.startswith('file: '):
            head = shared = {'file': value.strip()}
        elif line.startswith('@@ ') and colon:
            head = {**shared, 'what': value.strip()}
            found.append(Mutant(key[3:], head, path=str(path)))
        elif head is not shared and line[:1] in ('-', '+', ' '):
            found[-1].old += line[1:] + '\n' if line[0] != '+' else ''
            found[-1].new += line[1:] + '\n' if line[0] != '-' else ''
        elif colon and key in (ABOVE if head is shared else KEYS) and (head is shared or not found[-1].old):
            head[key] = value.strip()
        elif line:
            raise Malformed(f'{path}:{i}: neither a key, a mutant nor a line of one: {line}')
    for m in found:
        if not (m.file and m.test and m.old):
            raise Malformed(f'{path}: {m.name} lacks its file, its test or its lines')
    return found


def everything(root=ROOT):
    """{name: mutant} of the project."""
    mutants = {}
    for path in sorted((root / 'tests/mutants').rglob('*.mutants')):
        for m in parse(path.read_text(), path.relative_to(root)):
            if mutants.setdefault(m.name, m) is not m:
                raise Malformed(f'{m.path}: {m.name} is the name of another, too')
    return mutants


def planted(mutant, text):
    """Replaces the right lines, which must occur exactly once in the text, by the wrong ones."""
    text, old = '\n' + text, '\n' + mutant.old
    at = text.find(old)
    if at < 0 or text.find(old, at + 1) >= 0:
        raise Malformed(f'the right lines are not exactly once in {mutant.file}')
    return (text[:at] + '\n' + mutant.new + text[at + len(old):])[1:]


@functools.cache
def source(folder, name):
    """The .cpp file of a test or a program; its name must be unique."""
    found = [p.relative_to(ROOT) for p in ROOT.glob(f'{folder}/*/{name}.cpp')]
    if len(found) != 1:
        raise Malformed(f'there are {len(found)} files {folder}/*/{name}.cpp')
    return found[0]


def misfit(mutant):
    """The reason why a mutant cannot be planted; None if it can."""
    try:
        planted(mutant, (ROOT / mutant.file).read_text())
        if mutant.test != 'judge':
            source('tests', mutant.test)
        elif not mutant.exercise:
            raise Malformed('a judge refuses known mistakes only')
    except (Malformed, OSError) as error:
        return f'ERROR: {mutant.name}: {error}'


def print_density(mutants):
    mutated = [Path(m.file) for m in mutants]
    sources = [p.relative_to(ROOT) for p in sorted(ROOT.glob('src/*/*')) if p.is_file()]
    for folder in [*sorted({p.parent for p in sources}), Path('src')]:
        files = [p for p in sources if folder in p.parents]
        lines, count = sum((ROOT / p).read_text().count('\n') for p in files), sum(p in files for p in mutated)
        print(f'{folder!s:14} {lines:6} lines {count:5} mutants, {100 * count / lines:5.1f} per 100 lines')
    print(f'{"tests":14} {"":12} {sum(p not in sources for p in mutated):5} mutants\nwithout any:',
          *[p for p in sources if p not in mutated])
