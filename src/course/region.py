# course/region.py  11  the student's lines of one exercise, and what has no place in them
#
# Of a submission counts what stands between `// BEGIN 2.2 ...` and `// END 2.2`.  It is compiled in a
# tree that holds solutions of other exercises, so what could read files at compile time is refused:
# directives, and names that C++ keeps to itself (inline assembly, attributes and builtins of a
# compiler).  What is compiled holds no comment and no # at all: whether a line is a directive is
# therefore no question on which a compiler could be of another opinion than this file.
import re
from dataclasses import dataclass

from submission import LARGEST_REGION, Problem

MARK = re.compile(r'^[ \t]*//[ \t]*(BEGIN|END)[ \t]+([0-9A-Z]\.[0-9]+)(?![0-9.])[^\n]*$', re.M)

TOKEN = re.compile(r'''
    (?P<comment> //[^\n]* | /\*.*?\*/ )
  | (?P<raw>     (?<![A-Za-z0-9_])(?:u8|[uUL])?R" )
  | (?P<literal> "(?:[^"\\\n]|\\[^\n])*" | '(?:[^'\\\n]|\\[^\n])+' )
  | (?P<number>  \.?[0-9](?:'?[0-9A-Za-z_]|[eEpP][+-]|\.)* )
  | (?P<name>    [A-Za-z_]\w* | [^\x00-\x7f]+ )
  | (?P<space>   [ \t\n]+ )
  | (?P<other>   /\* | %: | \?\?= | . )''', re.X | re.S)

RESERVED = re.compile(r'__|^_[A-Z]')
WORDS = {'asm', 'import', 'gnu', 'clang'}
REFUSED = {'#': 'a # (directives are not allowed in a region: it has only what its file includes)', '%:': 'a %: (directives are not allowed in a region)',
           '??=': 'a ??= (directives are not allowed in a region)', '/*': 'a comment that never ends',
           '"': 'a string that does not end on its line', "'": 'a character that does not end on its line',
           '\\': 'a backslash'}


@dataclass(frozen=True)
class Region:
    exercise: str
    text: str   # whole lines between the marks
    line: int   # of the first of them, in the student's file
    file: str   # 'src/world/warp.h'


def region(data, exercise, file):
    """The region of the exercise in the bytes of a file; a Problem if there is not exactly one."""
    if b'\0' in data:
        raise Problem(f'{file} holds NUL bytes: is it text in UTF-8?')
    text = data.decode('utf-8', 'surrogateescape').replace('\r\n', '\n')
    marks = [(m.group(1), m.group(2), m.start(), m.end()) for m in MARK.finditer(text)]
    begins = [i for i, m in enumerate(marks) if m[:2] == ('BEGIN', exercise)]
    ends = [i for i, m in enumerate(marks) if m[:2] == ('END', exercise)]
    if not begins:
        raise Problem(f'{file} has no line "// BEGIN {exercise}"')
    if len(begins) > 1:
        raise Problem(f'{file} has "// BEGIN {exercise}" {len(begins)} times: which one counts?')
    if not ends:
        raise Problem(f'{file} has no line "// END {exercise}"')
    if len(ends) > 1:
        raise Problem(f'{file} has "// END {exercise}" {len(ends)} times: which one counts?')
    if ends[0] < begins[0]:
        raise Problem(f'in {file} "// END {exercise}" stands before its BEGIN')
    if ends[0] != begins[0] + 1:
        inner = marks[begins[0] + 1]
        raise Problem(f'in {file} another mark ({inner[0]} {inner[1]}) lies in the region of {exercise}')
    start = marks[begins[0]][3] + 1
    inside = text[start:marks[ends[0]][2]]
    if len(inside) > LARGEST_REGION:
        raise Problem(f'the region of {exercise} in {file} has more than {LARGEST_REGION} bytes')
    return Region(exercise, inside, text.count('\n', 0, start) + 1, file)


def tokens(text):
    """(kind, text, offset) of all tokens."""
    return [(m.lastgroup, m.group(), m.start()) for m in TOKEN.finditer(text)]


def without_comments(given):
    """The region's text as it is compiled, line by line where it was; a Problem if it holds what has no place there."""
    def refuse(what, at):
        raise Problem(f'line {given.line + given.text.count(chr(10), 0, at)} of {given.file} holds {what}')

    odd = re.search(r'\\[ \t]*\n|[\x00-\x08\x0b-\x1f\x7f]', given.text)
    if odd:
        refuse('a backslash at its end' if odd.group()[0] == '\\' else 'a control character', odd.start())
    kept = []
    for kind, text, at in tokens(given.text):
        if kind == 'comment':
            text = ' ' + '\n' * text.count('\n')
        elif kind == 'raw':
            refuse('a raw string', at)
        elif kind == 'name' and (RESERVED.search(text) or text in WORDS):
            refuse(f'{text[:40]}: names that C++ and compilers reserve are not allowed in a region', at)
        elif kind == 'other' and text in REFUSED:
            refuse(REFUSED[text], at)
        elif kind == 'literal' and re.search(r'#|%:|\?\?|//|/\*', text):
            refuse('a string with #, %:, ??, // or /* in it', at)
        kept.append(text)
    return ''.join(kept)


def canonical(text):
    """What remains of code without comments and spaces: equal for two texts that differ in nothing else."""
    return ' '.join(t for kind, t, _ in tokens(text) if kind not in ('comment', 'space'))
