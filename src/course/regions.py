# course/regions.py  1  exercises: the regions of src that a student writes, and their stubs
"""A region of the solution, in src:

    // exercise 2.2
    the solution
    // end

Its stub, among those of week 2 in src/course/stubs/2:

    // 2.2  title
    // instead: what it does instead
    the stub, indented as in src; empty lines at its end are not of it

In a starter, where it is open:

    // BEGIN 2.2  title
    the stub
    // END 2.2
"""
import pathlib
import re

ROOT = pathlib.Path(__file__).resolve().parents[2]
STUBS = 'src/course/stubs'

BEGIN = re.compile(r'^([ \t]*)// exercise (\w+\.\d+)$', re.M)
END = re.compile(r'^[ \t]*// end$', re.M)
MARK = re.compile(r'^[ \t]*// (?:BEGIN|END) \w+\.\d+')  # of a starter
MARKLIKE = re.compile(r'//\s*(?:(?:exercise|begin|end)\s+\w+\.\d|(?:exercise|end)(?:\s+\w)?\s*$)', re.I)
HEAD = re.compile(r'^// (\w+\.\d+)  (\S.*)\n// instead: \S.*\n', re.M)


class Malformed(Exception):
    """A file whose regions cannot be told apart, or have no stub."""


class Region:
    """An exercise's lines in a file: first and last are those of its marks, from 0."""

    def __init__(self, number, indent, first, root):
        self.number, self.indent, self.first = number, indent, first
        self.last = first
        self.solution = []
        week = number.split('.')[0]
        if number not in stubs(week, root):
            raise Malformed(f'no stub in {STUBS}/{week} begins with "// {number}  title" and "// instead: what it does"')
        self.title, self.stub = stubs(week, root)[number]

    def open(self, lines):
        """The region as a student gets it, or hands it in, around these lines."""
        return [f'{self.indent}// BEGIN {self.number}  {self.title}', *lines, f'{self.indent}// END {self.number}']


def stubs(week, root=ROOT):
    """Titles and lines of a week's stubs, by exercise: number -> (title, lines)."""
    path = root / STUBS / week
    above, *parts = HEAD.split(path.read_text() if path.is_file() else '')
    numbers = parts[::3]
    if above or len(set(numbers)) < len(numbers):
        raise Malformed(f'{STUBS}/{week} must begin with a stub, and have one of each exercise')
    return {n: (title, text.rstrip('\n').split('\n')) for n, title, text in zip(numbers, parts[1::3], parts[2::3])}


def regions(text, name, root=ROOT):
    """The regions of a file of the solution, in order."""
    found, region = [], None
    for i, line in enumerate(text.split('\n')):
        where = f'{name}:{i + 1}'
        begin = BEGIN.match(line)
        if begin:
            if region:
                raise Malformed(f'{where}: {begin[2]} begins within {region.number}')
            try:
                region = Region(begin[2], begin[1], i, root)
            except Malformed as error:
                raise Malformed(f'{where}: {error}')
        elif END.match(line):
            if not region:
                raise Malformed(f'{where}: an end without an exercise')
            region.last = i
            found.append(region)
            region = None
        elif MARKLIKE.search(line):
            raise Malformed(f'{where}: this is no mark, but looks like one')
        elif region:
            region.solution.append(line)
    if region:
        raise Malformed(f'{name}: {region.number} does not end')
    return found


def rewrite(text, name, replace, root=ROOT):
    """The file with replace(region), lines, in place of each region; None: the solution without marks."""
    lines, out, at = text.split('\n'), [], 0
    for r in regions(text, name, root):
        new = replace(r)
        out += lines[at:r.first]
        if new is None:
            out += r.solution
        else:  # formatters let a comment flow into the next one: not into a mark
            for line in new:
                out += ['', line] if MARK.match(line) and out and out[-1].lstrip().startswith('//') else [line]
        at = r.last + 1
    return '\n'.join(out + lines[at:])


class Exercise:
    """A line of tests/course/exercises.txt."""

    def __init__(self, line):
        fields = [f.strip() for f in line.split('|')]
        if len(fields) != 6:
            raise Malformed(f'exercises.txt: six fields, not {len(fields)}: {line}')
        self.number, self.title, self.file, needs, points, hours = fields
        self.needs, self.points, self.hours = needs.split(), int(points), float(hours)
        self.week = self.number.split('.')[0]


def exercises(root=ROOT):
    """All exercises, in the order of the course."""
    lines = (root / 'tests/course/exercises.txt').read_text().splitlines()
    return [Exercise(line) for line in lines if line.strip() and not line.startswith('#')]


def solution_files(root=ROOT):
    """Files of src that hold regions, by exercise: number -> (path relative to root, region)."""
    found, listed = {}, {e.number for e in exercises(root)}
    for path in sorted((root / 'src').rglob('*.h')):
        name = str(path.relative_to(root))
        for r in regions(path.read_text(), name, root):
            if r.number in found:
                raise Malformed(f'{name}: {r.number} is in {found[r.number][0]}, too')
            if r.number not in listed:
                raise Malformed(f'{name}: {r.number} is not in exercises.txt')
            found[r.number] = (name, r)
    for path in sorted((root / STUBS).iterdir()):
        for number in stubs(path.name, root):
            if number not in found or number.split('.')[0] != path.name:
                raise Malformed(f'{STUBS}/{path.name}: {number} is the stub of no region')
    return found
