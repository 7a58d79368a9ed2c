# course/check_test.py  what make check shows: python3 tests/course/check_test.py [NAME...]
"""Each function test_... is a test; check_test.cpp runs them one by one.  Judge and renderer are stand-ins."""
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time

import testing
from testing import expect

ROOT = pathlib.Path(__file__).resolve().parents[2]
SAID = '''2.2 wrong: half <i>of it
  right  exact        a length is 1
  WRONG  statistical  it follows 1 < 2 & 3: p = 1e-9
'''


class Room:
    """A starter of two exercises: 2.1 has no picture, 2.2 has one."""

    def __enter__(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.top = pathlib.Path(self.temporary.name)
        for name, text in (('tests/course/exercises.txt', '2.1 | One | world/a.h | | 1 | 1\n2.2 | Two | world/a.h | | 1 | 1\n'),
                           ('tests/course/pictures.txt', '2.2 | 2.2 | 30 | penumbra --spp 1 scene\n'), ('tests/course/mistakes.txt', ''),
                           ('src/world/a.h', '// BEGIN 2.1\n// END 2.1\n// BEGIN 2.2\n// END 2.2\n'), ('said', SAID),
                           ('expected/2.2.pfm', ''), ('build/course/answers_2', ''),
                           ('build/course/judge_2', '#!/bin/sh\necho >>judged\ncat said\nexit 1\n'),
                           ('build/penumbra', '#!/bin/sh\nfor last; do :; done; echo x >$last; echo "scene: 9 samples per pixel"; echo wrote >&2\n'),
                           ('build/beside', '#!/bin/sh\necho "d_rel 3 %; mean 1 1 1"\n'),
                           ('make', '#!/bin/sh\necho "$@" >>made\n')):
            (self.top / name).parent.mkdir(parents=True, exist_ok=True)
            (self.top / name).write_text(text)
            (self.top / name).chmod(0o755)
        for name in ('check', 'picture'):
            shutil.copy(ROOT / 'tests/course' / name, self.top / 'tests/course' / name)
        self.environment = {**os.environ, 'MAKE': str(self.top / 'make'), 'SUFFIX': ''}
        return self

    def __exit__(self, *_):
        self.temporary.cleanup()

    def check(self, *words):
        return subprocess.run(['tests/course/check', *words], cwd=self.top, env=self.environment, capture_output=True, text=True)

    def page(self):
        return (self.top / 'out/check/index.html').read_text()


def shown(room, script=''):
    """What a browser makes of the page; nothing: there is none."""
    browser = next(filter(shutil.which, ('chromium', 'chromium-browser', 'google-chrome')), None)
    if not browser:
        print('not tested: chromium is not installed')
        return ''
    page = room.top / 'out/check/shown.html'
    page.write_text(room.page() + script)
    return subprocess.run([browser, '--headless=new', '--no-sandbox', '--disable-gpu', '--virtual-time-budget=3000', '--dump-dom',
                           f'--user-data-dir={room.top}/profile', page.as_uri()], capture_output=True, text=True, timeout=100).stdout


def test_the_renderer_is_built_for_exercises_with_a_picture_alone():
    with Room() as room:
        room.check('2.1')
        expect('build/penumbra' not in (room.top / 'made').read_text(), (room.top / 'made').read_text())
        said = room.check('2.2')
        expect(said.returncode == 1 and 'build/penumbra' in (room.top / 'made').read_text(), said)
        expect(said.stdout.startswith(SAID) and 'out/check/2.2.png: 9 samples per pixel; d_rel 3 %' in said.stdout, said.stdout)


def test_the_page_has_verdict_items_picture_and_scale():
    with Room() as room:
        room.check('2.2')
        expect('half &lt;i>of it</h1>' in room.page() and '1 &lt; 2 &amp; 3' in room.page(), room.page())
        dom = shown(room)
        for part in ('>2.2 wrong: half &lt;i&gt;of it</h1>', '<td>statistical</td><td>it follows 1 &lt; 2 &amp; 3: p = 1e-9', 'src="2.2.png?',
                     '<b>yours</b><b>expected</b><b>difference</b>', '>+0.4</span>', 'h1 class="other"'):
            expect(not dom or part in dom, part, dom)
        (room.top / 'said').write_text('2.1 right: 1 of 1\n')
        room.check('2.1')
        expect('h1 class="right"' in room.page() and '.png' not in room.page(), room.page())


def test_the_page_shows_drawings_and_names_pictures_right_above_them():
    with Room() as room:
        (room.top / 'build/course/judge_2').write_text('#!/bin/sh\ncat said\nmkdir -p "$ORACLE_PICTURES"\n'
                                                       'echo >"$ORACLE_PICTURES/oracle-check-1.svg"\n[ $3 = 2.2 ]\n')
        room.check('2.2')
        expect('<img class="drawn" src="2.2.svg?' in room.page(), room.page())
        (room.top / 'build/beside').write_text('#!/bin/sh\necho "d_rel 90 %; mean 1 1 1"\n')
        said = room.check('2.2').stdout
        expect('far off' in said and re.search('far off[^<]*\n<div class=three>.*</div>\n<img', room.page()), said, room.page())


def test_the_page_reloads_when_there_is_another():
    script = '''<script>const by = document.documentElement.dataset.by = performance.getEntriesByType("navigation")[0].type;
if (by === "reload") stamp = () => {};</script>'''
    with Room() as room:
        room.check('2.1')
        dom = shown(room, script)
        expect(not dom or 'data-by="navigate"' in dom, dom)
        (room.top / 'out/check/stamp.js').write_text('stamp("another")')
        dom = shown(room, script)
        expect(not dom or 'data-by="reload"' in dom, dom)


def test_watch_judges_again_at_every_save():
    def judged(count):
        for _ in range(200):
            if (room.top / 'judged').exists() and len((room.top / 'judged').read_text()) >= count:
                return True
            time.sleep(0.1)
        return False
    with Room() as room:
        watching = subprocess.Popen(['tests/course/check', '--watch', '2.1'], cwd=room.top, env=room.environment,
                                    stdout=subprocess.DEVNULL, start_new_session=True)
        try:
            expect(judged(1), 'never judged')
            time.sleep(1.5)
            expect(len((room.top / 'judged').read_text()) == 1, 'judged again without a reason')
            (room.top / 'src/world/a.h').touch()
            expect(judged(2), 'a save was not seen')
        finally:
            os.killpg(watching.pid, signal.SIGKILL)
            watching.wait()
        expect(room.check('--watch').returncode == 2, 'watch without an exercise')


if __name__ == '__main__':
    testing.run(globals())
