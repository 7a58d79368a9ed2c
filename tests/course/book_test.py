# course/book_test.py  3  the book: every line of the lecture in one chapter, and what its tables name is there
import pathlib
import re
import shutil
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / 'src/book'), str(ROOT / 'src/course'), str(ROOT / 'tests/course')]
import book  # noqa: E402
from testing import expect, run  # noqa: E402


def pages(found=None):
    """The chapters without Pandoc: their Markdown, with code, tests and mistakes in it."""
    drawn = {name.removesuffix(' ?'): '<svg></svg>' for _, _, name in book.rows(book.DIAGRAMS)}
    inserts = book.Inserts()
    figure = lambda scene, *rest: f'<live-figure scene="{scene}">'  # noqa: E731
    found = book.pieces() if found is None else found
    return {c.key: inserts.put(book.assembled(c, found, {}, drawn, figure, inserts)) for c in book.chapters()}


def test_every_line_of_the_lecture_stands_in_one_chapter():
    made = pages()
    expect(not book.uncovered(made.values()), book.uncovered(made.values()))
    lines = sum(len(book.lines_of(f'{folder}/{p.name}')) for folder in book.LECTURE for p in (ROOT / 'src' / folder).iterdir())
    expect(len(book.LISTED.findall(''.join(made.values()))) > lines > 2000, lines)


def test_a_line_that_is_missing_or_doubled_or_changed_is_named():
    made = pages()
    n = book.code_html('path/start.h', 2, 4)
    expect(book.uncovered([*made.values(), n]) == ['path/start.h:3-4: in 2 places'], book.uncovered([*made.values(), n]))
    line = '<span id="film/loop.h:1" data-n="1">'
    without = [re.sub(f'{line}.*?</span>', '', page, flags=re.S) for page in made.values()]
    expect(book.uncovered(without) == ['film/loop.h:1-1: in 0 places'], book.uncovered(without))
    other = [page.replace(line, line + 'x') for page in made.values()]
    expect(book.uncovered(other) == ['film/loop.h:1-1: in 1 places, changed'], book.uncovered(other))


def test_a_file_that_no_chapter_has_is_named():
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        for name in book.LECTURE:
            (root / 'src' / name).mkdir(parents=True)
        (root / 'src/film/new.h').write_text('one\ntwo\n')
        expect(book.uncovered([], root) == ['film/new.h:1-2: in 0 places'], book.uncovered([], root))


def test_a_heading_or_a_line_that_is_not_there_is_refused():
    for table, what in (('0 | Numbers | base/vec.h | no such line', '0 lines begin'), ('0 | No such heading | base/vec.h |', 'no heading')):
        try:
            pages(book.pieces(table))
        except book.Malformed as error:
            expect(what in str(error), error)
        else:
            raise AssertionError(f'accepted: {table}')


def test_each_exercise_has_its_code_test_and_mistakes():
    text = ''.join(pages().values())
    for e in book.regions.exercises():
        expect(text.count(f'<code>make check EX={e.number}</code>') == 1, e.number)
    expect(text.count('class="solution"') == len(book.regions.exercises()), text.count('class="solution"'))


def test_all_named_mistakes_and_no_stub_stand_in_the_book():
    lines = (ROOT / 'tests/course/mistakes.txt').read_text().split('\n')
    named = [f for f in (line.split('\t') for line in lines if line and line[0] != '#') if f[1] != 'stub']
    lists = re.findall(r'class="mistakes">(.*?)</details>', ''.join(pages().values()), re.S)
    expect(sum(text.count('<li>') for text in lists) == len(named) > 400, len(named))


def test_pandoc_understands_all_and_answers_fold_out():
    if not shutil.which('pandoc'):
        return
    for c, text in zip(book.chapters(), pages().values()):
        page = book.by_pandoc(text, c.key)
        expect(not re.search(r'____|\$\$|ANSWER|REWSNA|@sheet|@report', page), c.key)
        expect(page.count('class="answers"') > 3 or c.key in ('index', '0', 'F'), c.key)
        expect(('class="shown"' in page) == (c.key in '12'), c.key)


def test_new_text_is_short():
    words = len(re.sub(r'^@.*$', '', (ROOT / 'src/book/text.md').read_text(), flags=re.M).split())
    expect(words <= 6000, words)


def test_links_lead_somewhere():
    for key, page in pages().items():
        for link in re.findall(r'(?:\]\(|href=")(\.\./[^)"#]+)', page):
            expect((ROOT / 'src/book' / link).exists(), key, link)


if __name__ == '__main__':
    run(dict(globals()))
