# course/report_test.py  what a student hands in: python3 tests/course/report_test.py [NAME...]
"""Each function test_... is a test; check_test.cpp runs them one by one.  Judge and renderer are stand-ins."""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

import testing
from testing import expect

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / 'src/course'))
import regions  # noqa: E402


class Room:
    """A starter of weeks 2, 3 and V: 2.1 is right, 2.2 wrong, 3.1 open, V.1 right.  2.1 and 2.2 share a picture."""

    def __init__(self, off='3'):
        self.off = off

    def __enter__(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.top = pathlib.Path(self.temporary.name)
        numbers = ('2.1', '2.2', '3.1', 'V.1')
        judge = ('#!/bin/sh\ncase $3 in 2.2) echo "2.2 wrong: half <i>of it & more; read \\"The disc\\""; echo "  WRONG exact"; exit 1;;\n'
                 '3.1) echo "3.1 open"; exit 3;; esac\necho "$3 right: 2 of 2"\n')
        for name, text in (('tests/course/exercises.txt', ''.join(f'{n} | Number {n} | world/a.h | | 1 | 1\n' for n in numbers)),
                           ('tests/course/pictures.txt', '2.1 | 2.1 2.2 | 30 | penumbra --spp 1 scene\n2.2 | 2.1 2.2 | 30 | penumbra --spp 1 scene\n'
                                                         '3 | 2.1 | 30 | penumbra --spp 3 other\n'),
                           ('tests/course/mistakes.txt', ''), ('tests/course/starter.txt', 'Starter of weeks 2 3 V, Penumbra abc.\n'),
                           ('tests/course/questions.txt', '# week | question\n2 | Why <so>?\n2 | And this?\n3 | How?\nV | Who?\n'),
                           ('src/world/a.h', ''.join(f'// BEGIN {n}\n// END {n}\n' for n in numbers)),
                           *((f'expected/{key}.pfm', '') for key in ('2.1', '2.2', '3')),
                           *((f'build/course/{kind}_{week}', judge) for kind in ('judge', 'answers') for week in '23V'),
                           ('build/penumbra', '#!/bin/sh\necho "$@" >>drawn\necho "scene: 9 samples per pixel, 1.0 s"\n'),
                           ('build/beside', f'#!/bin/sh\n[ $# != 0 ] || echo "<script>viewer</script>"\n[ $# != 2 ] || echo "<image-pair>$1 $2</image-pair>"\n'
                                            f'[ $# != 3 ] || echo "d_rel {self.off} %; mean 1 1 1"\n'),
                           ('make', '#!/bin/sh\n')):
            (self.top / name).parent.mkdir(parents=True, exist_ok=True)
            (self.top / name).write_text(text)
            (self.top / name).chmod(0o755)
        for name in ('check', 'picture', 'report'):
            shutil.copy(ROOT / 'tests/course' / name, self.top / 'tests/course' / name)
        self.answers = self.top / 'answers.md'
        return self

    def __exit__(self, *_):
        self.temporary.cleanup()

    def report(self, *words, status=0):
        done = subprocess.run(['tests/course/report', *words], cwd=self.top, env={**os.environ, 'MAKE': str(self.top / 'make'), 'SUFFIX': ''},
                              capture_output=True, text=True)
        expect(done.returncode == status, done)
        self.said = done.stdout + done.stderr
        return (self.top / 'out/report/index.html').read_text() if status == 0 else ''

    def write_answer(self, number, text, week=2):
        old = self.answers.read_text()
        place = re.search(rf'## Week {week}, question {number}\n\n> .*\n', old)
        self.answers.write_bytes((old[:place.end()] + text + old[place.end():]).encode())


def test_verdicts_pictures_and_boxes():
    with Room() as room:
        page = room.report()
        for part in ('class="right"><th scope="row">2.1<td>Number 2.1<td>right: 2 of 2\n',
                     'class="wrong"><th scope="row">2.2<td>Number 2.2<td>wrong: half &lt;i>of it &amp; more; read "The disc"\n',
                     'class="open"><th scope="row">3.1<td>Number 3.1<td>open\n', '<h2>Week V</h2>', 'Starter of weeks 2 3 V, Penumbra abc.',
                     '<image-pair>out/check/report-2.1.pfm expected/2.1.pfm</image-pair>', 'The picture of 2.1, 2.2', 'The picture of week 3',
                     '<p>9 samples per pixel, 1.0 s; d_rel 3 %; mean 1 1 1</p>', '<h3>1. Why &lt;so>?</h3>\n<div class="answer empty"></div>'):
            expect(part in page, part, page)
        expect(re.search(r'Weeks: 2 3 V\. .* \d{4}-\d\d-\d\d\.</p>', page), page)
        expect(page.count('class="answer empty"') == 4 and page.count('<image-pair>') == 2 and page.count('viewer') == 1, page)
        expect(len((room.top / 'drawn').read_text().splitlines()) == 2, 'a picture was drawn twice')
        expect('4 without an answer' in room.said, room.said)


def test_weeks_are_chosen_and_a_page_without_pictures_has_no_viewer():
    with Room() as room:
        for words, weeks in (('3', '3'), ('2-3', '23'), ('3,V', '3V'), ('3-V', '3V'), ('V', 'V')):
            page = room.report(words)
            expect(''.join(re.findall('<h2>Week (.)</h2>', page)) == weeks, words, page)
        expect('viewer' not in page and '<image-pair>' not in page, page)
        for words in ('1', '3-2', '2-', 'x', '2-3-V', '2,9'):
            room.report(words, status=2)
            expect('say make report' in room.said, words, room.said)


def test_answers_survive_and_are_shown_as_they_are():
    with Room() as room:
        room.report('2')
        room.write_answer(1, '\nBecause a < b & c.\r\n\r\n  > a line that quotes\r\n')
        kept = room.answers.read_bytes()
        page = room.report('2')
        expect(room.answers.read_bytes() == kept, 'answers were changed')
        expect('<div class="answer">Because a &lt; b &amp; c.\n\n  > a line that quotes</div>' in page, page)
        expect(page.count('class="answer empty"') == 1 and '1 without an answer' in room.said, page, room.said)
        room.answers.write_bytes(kept.replace(b'Name:', b'Name: Ada <3\r') + b'no newline')
        kept = room.answers.read_bytes()
        page = room.report()
        expect(room.answers.read_bytes().startswith(kept), 'answers were changed for another week')
        expect('<h1>Ada &lt;3</h1>' in page and '<div class="answer">no newline</div>' in page, page)
        text = room.answers.read_text()
        expect(re.findall(r'^## (.*)$', text, re.M) == [f'Week {w}, question {n}' for w, n in ((2, 1), (2, 2), (3, 1), ('V', 1))], text)


def test_a_picture_waits_or_is_far_off():
    for off, part in (('31', '; it waits for 2.2</p>'), ('-nan', '; it waits for 2.2</p>'), ('29', 'mean 1 1 1</p>')):
        with Room(off) as room:
            page = room.report('2')
            expect(part in page and '<image-pair>' in page, off, page)
    with Room('31') as room:
        expect('far off: noise alone makes d_rel 30 % at most</p>' in room.report('3'), 'not far off')
        (room.top / 'build/penumbra').write_text('#!/bin/sh\necho "scene:3: no <such> word"\nexit 2\n')
        page = room.report('3')
        expect('<p>scene:3: no &lt;such> word</p>\n</section>' in page and '<image-pair>' not in page, page)


def test_every_week_has_three_questions_in_a_starter():
    lines = [line.split(' | ') for line in (ROOT / 'tests/course/questions.txt').read_text().splitlines() if line[0] != '#']
    expect(all(len(line) == 2 for line in lines) and len({question for _, question in lines}) == len(lines), lines)
    weeks = list(dict.fromkeys(e.week for e in regions.exercises()))
    expect([week for week, _ in lines] == [week for week in weeks for _ in range(3)], lines)


if __name__ == '__main__':
    testing.run(globals())
