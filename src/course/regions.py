# course/regions.py  1  exercises: the regions of src that a student writes, and their stubs
"""A region of the solution:

    // BEGIN SOLUTION 2.2  title
    the solution
    // STUB  what it does instead
    // the stub, commented out
    // END SOLUTION

In a starter, where it is open:

    // BEGIN 2.2  title
    the stub
    // END 2.2
"""
import pathlib
import re

ROOT = pathlib.Path(__file__).resolve().parents[2]

BEGIN = re.compile(r'^(\s*)// BEGIN SOLUTION (\w+\.\d+)  (\S.*)$')
STUB = re.compile(r'^\s*// STUB  (\S.*)$')
END = re.compile(r'^\s*// END SOLUTION$')
MARKER = re.compile(r'^\s*//\s*(BEGIN|END)\s+(SOLUTION|[\w]+\.\d+)\b|^\s*//\s*STUB\b')


class Malformed(Exception):
    """A file whose regions cannot be told apart."""


class Region:
    """An exercise's lines in a file: first and last are those of its markers, from 0."""

    def __init__(self, number, title, indent, first):
        self.number, self.title, self.indent, self.first = number, title, indent, first
        self.last = first
        self.solution, self.stub = [], []

    def open(self, lines):
        """The region as a student gets it, or hands it in, around these lines."""
        return [f'{self.indent}// BEGIN {self.number}  {self.title}', *lines, f'{self.indent}// END {self.number}']


def uncommented(line, where):
    """A line of a stub as code: '    // x' becomes '    x'."""
    found = re.match(r'^(\s*)//(?: (.*)|)$', line)
    if not found:
        raise Malformed(f'{where}: a line of a stub must begin with //')
    return (found[1] + (found[2] or '')).rstrip()


def regions(text, name):
    """The regions of a file of the solution, in order."""
    found, region, in_stub = [], None, False
    for i, line in enumerate(text.split('\n')):
        where = f'{name}:{i + 1}'
        begin = BEGIN.match(line)
        if begin:
            if region:
                raise Malformed(f'{where}: {begin[2]} begins within {region.number}')
            region, in_stub = Region(begin[2], begin[3], begin[1], i), False
        elif END.match(line):
            if not region or not in_stub:
                raise Malformed(f'{where}: END SOLUTION without a ' + ('STUB' if region else 'BEGIN'))
            region.last = i
            found.append(region)
            region = None
        elif STUB.match(line):
            if not region or in_stub:
                raise Malformed(f'{where}: STUB is not in a region, or twice')
            in_stub = True
        elif MARKER.match(line):
            raise Malformed(f'{where}: this is no marker, but looks like one')
        elif region and in_stub:
            region.stub.append(uncommented(line, where))
        elif region:
            region.solution.append(line)
    if region:
        raise Malformed(f'{name}: {region.number} does not end')
    return found


def rewrite(text, name, replace):
    """The file with replace(region), lines, in place of each region; None: the solution without markers."""
    lines, out, at = text.split('\n'), [], 0
    for r in regions(text, name):
        new = replace(r)
        out += lines[at:r.first] + (r.solution if new is None else new)
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
    found = {}
    for path in sorted((root / 'src').rglob('*.h')):
        name = str(path.relative_to(root))
        for r in regions(path.read_text(), name):
            if r.number in found:
                raise Malformed(f'{name}: {r.number} is in {found[r.number][0]}, too')
            found[r.number] = (name, r)
    return found
