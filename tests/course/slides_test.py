# course/slides_test.py  decks of the sessions: python3 tests/course/slides_test.py [NAME...]
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / 'src/book'), str(ROOT / 'src/course'), str(ROOT / 'tests/course')]
import book  # noqa: E402
import handout  # noqa: E402
import slides  # noqa: E402
from testing import expect, run  # noqa: E402

# Each slide in turn: what is cut off, or stands on the line below; then keys.
LOOK = '''<script>
const root = document.documentElement.dataset, wrong = [];
slides.forEach((slide, k) => {
    show(k);
    const box = slide.getBoundingClientRect(), floor = slide.querySelector("footer").getBoundingClientRect().top;
    for (const part of slide.querySelectorAll(":scope > :not(footer), :scope > :not(footer) :not(svg *)")) {
        const { top, bottom, left, right } = part.getBoundingClientRect();
        if (bottom > floor + 1 || top < box.top || right > box.right + 1 || left < box.left - 1) { wrong.push(`${k + 1}: ${part.tagName} ${part.textContent.slice(0, 40)}`); break; }
    }
});
root.wrong = wrong.join("; ");
show(0);
for (const key of ["ArrowRight", "ArrowRight", "ArrowLeft", "n"]) dispatchEvent(new KeyboardEvent("keydown", { key }));
root.at = at + getComputedStyle(slides[1].nextElementSibling).display + getComputedStyle(slides[0]).display;
</script>'''


def refused(call, *part):
    try:
        call()
    except slides.Malformed as error:
        expect(all(p in str(error) for p in part), error, part)
        return
    raise AssertionError(f'not refused: {part}')


def plain(**changed):
    parts = {**{'Show': 'The diagram `snell`.', 'Draw': 'It.', 'Ask': 'Why? How?', 'Where classes stall': 'Here.', 'Close with': 'this.'}, **changed}
    return ''.join(f'* **{name}{"" if name == "Close with" else "."}** {words}\n' for name, words in parts.items() if words)


def test_sessions_have_all_exercises_of_the_weeks_in_turn():
    found = slides.sessions()
    expect([s.key for s in found] == [f'{week}{half}' for week in '123456' for half in 'ab'], [s.key for s in found])
    numbers = sorted(e.number for s in found for e in s.exercises)
    expect(numbers == sorted(e.number for e in slides.regions.exercises() if e.week.isdigit()), numbers)
    for s in found:
        expect(all(e.week == s.week for e in s.exercises), s.key)


def test_every_diagram_of_the_weeks_is_on_a_slide():
    shown = [name for s in slides.sessions() for name in s.diagrams]
    expect(len(shown) == len(set(shown)), shown)
    projects = {name.removesuffix(' ?') for chapter, _, name in book.rows(book.DIAGRAMS) if chapter in 'VR'}
    expect(set(shown) | projects == set(book.diagrams()) and not set(shown) & projects, shown)


def test_all_of_a_plan_is_in_its_deck():
    drawn = book.diagrams()
    for s in slides.sessions():
        deck = slides.deck_of(s, drawn)
        expect(len(deck) == 2 + len(s.pictures) + len(s.exercises) + len(s.diagrams) + len(s.questions()), s.key)
        expect(' '.join(s.questions()) == s.parts['Ask'] and len(s.questions()) >= 2, s.key, s.questions())
        notes = ' '.join(n for _, n in deck)
        expect(s.parts['Draw'] in notes and s.parts['Where classes stall'] in notes, s.key)
        for e in s.exercises:
            [body] = [body for body, _ in deck if body.startswith(f'## {e.number} {e.title}\n')]
            expect(body.count('\n1. ') >= 2 and '<div class="number">' in body or e.number == '5.5', body)
            expect(not re.search(r'[:,]\n\n<div', body), body)
    deck = [body for body, _ in slides.deck_of(slides.sessions()[0], drawn)]
    expect([body.split('\n')[0] for body in deck[2:6]] == ['## 1.1 A ray for every pixel', '## A ray for every pixel', '## 1.2 A ray and a sphere',
                                                          '## A ray and a sphere'], deck)


def test_answers_stand_in_the_notes_alone():
    with tempfile.TemporaryDirectory() as folder:
        sheet = pathlib.Path(folder) / 'sheet.md'
        sheet.write_text('# Sheet\n\n## 1.1 A ray\n\n*2 points*\n\nIs it ____<!-- secret -->? It is:\n\n$$x$$\n\n### The step\n\nIt is ____<!-- known -->.\n\n'
                         '**A number.** 3 is ____<!-- three -->.\n\n<details><summary>Hint</summary>\n\nno hint\n\n</details>\n\n## 1.2 Other\n')
        x = slides.Exercise(sheet, next(e for e in slides.regions.exercises() if e.number == '1.1'))
    expect('secret' not in x.task and 'blank' in x.task and x.task.endswith('$$x$$') and x.steps == ['The step'], x.task)
    expect('three' not in x.number and x.number.startswith('**A number.** 3 is') and 'hint' not in x.notes, x.number, x.notes)
    expect(x.notes.startswith('### The step') and '<span class="answer">known</span>' in x.notes, x.notes)


def test_what_does_not_fit_is_refused():
    good = slides.Session('3b: glass (3.3, 3.4, 3.6)', plain())
    expect([e.number for e in good.exercises] == ['3.3', '3.4', '3.6'] and good.diagrams == ['snell'] and good.title == 'Glass', good.title)
    expect([e.number for e in slides.Session('1b: x (1.3 to 1.6)', plain()).exercises] == ['1.3', '1.4', '1.5', '1.6'], 'a range')
    for heading in ('glass (3.6)', '3b: glass', '3b: glass (3.9)', '3b: glass (3.6, 3.9)'):
        refused(lambda: slides.Session(heading, plain()), 'sessions.md')
    for missing in ('Draw', 'Ask', 'Close with'):
        refused(lambda: slides.Session('3b: glass (3.6)', plain(**{missing: ''})), '3b has not')
    refused(lambda: slides.deck_of(slides.Session('3b: glass (3.6)', plain(Show='`no-such`')), {}), 'no diagram no-such')
    refused(lambda: slides.deck_of(slides.Session('3b: glass (3.6)', plain(Show='[x](x.png)')), {}), 'no picture x.png')


def test_pages_load_nothing_and_slides_have_no_answers():
    if not shutil.which('pandoc'):
        return print('not tested: pandoc is not installed')
    browser = next(filter(shutil.which, handout.BROWSERS), None)
    drawn = book.diagrams()
    with tempfile.TemporaryDirectory() as folder:
        for s in slides.sessions():
            deck = slides.deck_of(s, drawn)
            page = slides.page_of(s, deck)
            bodies, notes = re.findall(r'<section>.*?</section>', page, re.S), re.findall(r'<aside>.*?</aside>', page, re.S)
            expect(len(bodies) == len(notes) == len(deck), s.key, len(bodies))
            expect('class="answer"' in ''.join(notes) and 'class="answer"' not in ''.join(bodies), s.key)
            expect(not re.search(r'____|\$|ANSWER|BLANK|<!--', ''.join(bodies + notes)), s.key)
            expect(not re.search(r'src="(?!data:)|href="(?!data:)|url\(|@import|</?live', page), s.key)
            expect(''.join(bodies).count('<svg') == len(s.diagrams), s.key)
            if browser:
                file = pathlib.Path(folder) / f'{s.key}.html'
                file.write_text(page.replace('</body>', LOOK + '</body>'))
                dom = subprocess.run([browser, '--headless=new', '--no-sandbox', '--disable-gpu', '--hide-scrollbars', '--window-size=1280,720',
                                      f'--user-data-dir={folder}/profile', '--dump-dom', file.as_uri()], capture_output=True, text=True, timeout=120).stdout
                expect('data-wrong=""' in dom and 'data-at="1blocknone"' in dom, s.key, re.findall('data-(?:wrong|at)=".*?"', dom))
        if not browser:
            print('not tested in a browser: chromium is not installed')


if __name__ == '__main__':
    run(dict(globals()))
