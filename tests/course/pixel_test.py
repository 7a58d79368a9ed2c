# course/pixel_test.py  what the sheets say of --pixel: python3 tests/course/pixel_test.py [NAME...]
"""Each function test_... is a test; starter_test.cpp runs them one by one.  Commands run in a starter of their week."""
import re

import testing
from editors_test import Made, starter
from testing import expect


def boxes(text):
    """(command, lines that are among what it prints) of a sheet."""
    blocks = [[line[4:] for line in block.rstrip('\n').split('\n')] for block in re.findall(r'(?:^    .*\n)+', text, re.M)]
    return [(block[0], block[1:]) for block in blocks if '--pixel' in block[0] and not block[0].startswith('gdb')]


def missing_line(lines, printed):
    """The first of these lines that is not printed after the one before; `...` stands for further digits."""
    rest = iter(printed.split('\n'))
    for line in lines:
        pattern = re.escape(line).replace(r'\.\.\.', r'\d*')
        if not any(re.fullmatch(pattern, other) for other in rest):
            return line


def built(week):
    """A starter in which this week is done and later ones are stubs: that of the next, which comes with it solved."""
    return Made(str(int(week) + 1)) if week != '6' else Made('6', solved=True)


def prints(made, command):
    done = made.run('make -s build/penumbra BRIEFLY=-O0')
    expect(done.returncode == 0, done.stderr)
    return made.run(command).stdout


def of_week(week):
    [(command, lines)] = boxes(starter.sheet_of(week).read_text())
    expect(len(command) <= 130 and lines, week, command)
    with built(week) as made:
        printed = prints(made, command)
        expect(missing_line(lines, printed) is None, week, missing_line(lines, printed), 'is not in', printed)


def test_missing_lines_are_seen():
    expect(missing_line(['a: 0.12...', 'b'], 'a: 0.1234\nc\nb\n') is None, 'a line is not seen')
    for lines in (['a: 0.13...'], ['b', 'a: 0.12...'], ['a: 0.1'], ['b...x'], ['b', 'b']):
        expect(missing_line(lines, 'a: 0.1234\nb\n') is not None, lines)
    expect(boxes('    ls\n    a\n\n    x --pixel 1\n    b\n      c\n\ntext\n') == [('x --pixel 1', ['b', '  c'])], 'boxes')


def test_sheet_1_says_what_a_pixel_prints():
    of_week('1')


def test_sheet_1_says_what_stubs_print():
    sheet = starter.sheet_of('1').read_text()
    [(command, lines)] = boxes(sheet)
    [end] = re.findall(r'ends at once: `(.*?)`', sheet)
    with Made('1') as made:
        printed = prints(made, command)
        expect(missing_line([end], printed) is None and missing_line(lines, printed), printed)


def test_sheet_2_says_what_a_pixel_prints():
    of_week('2')


def test_sheet_3_says_what_a_pixel_prints():
    of_week('3')


def test_sheet_4_says_what_a_pixel_prints():
    of_week('4')


def test_sheet_5_says_what_a_pixel_prints():
    of_week('5')


def test_sheet_6_says_what_a_pixel_prints():
    of_week('6')

if __name__ == '__main__':
    testing.run(globals())
