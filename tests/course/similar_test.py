# course/similar_test.py  copies are told, and what is equal by chance is not: python3 tests/course/similar_test.py [NAME...]
"""Each function test_... is a test; submission_test.cpp runs them one by one."""
import pathlib
import random
import re
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / 'src/course'), str(ROOT / 'tests/mutants')]
import mutants
import regions
import reports
import similar
import testing
from region import tokens
from testing import expect

KEYWORDS = set('auto bool break const constexpr continue double else false float for if inline int namespace return static '
               'struct template true typename using void while'.split())
PUBLISHED = 'equal to the published solution'
SOLUTIONS = {n: ('\n'.join(r.solution), '\n'.join(r.stub)) for n, (_, r) in sorted(regions.solution_files().items())}
LONG = {n for n, pair in SOLUTIONS.items() if similar.own_size(*pair) >= similar.SHORT}


def disguised(text, seed):
    """The same code with other names, comments and line ends."""
    chance, names, out = random.Random(seed), {}, []
    for kind, sign, _ in tokens(text):
        if kind == 'name' and sign not in KEYWORDS:
            sign = names.setdefault(sign, f'other_{seed}_{len(names)}')
        out.append('' if kind in ('comment', 'space') else sign + chance.choice((' ', '\n\n\t', '  // mine\n', ' /* a * b */ ')))
    return ''.join(out)


def others():
    """Right solutions of someone else: exercise -> text."""
    _, *parts = re.split(r'^@@ (.*)\n', (ROOT / 'tests/course/styles').read_text(), flags=re.M)
    return dict(zip(parts[::2], parts[1::2]))


def wrong(number):
    """A solution with a known mistake that normal_form tells from the right one."""
    for mutant in mutants.everything().values():
        if mutant.exercise == number:
            text = mutants.planted(mutant, (ROOT / mutant.file).read_text())
            lines = next(r.solution for r in regions.regions(text, mutant.file) if r.number == number)
            if similar.normal_form('\n'.join(lines)) != similar.normal_form(SOLUTIONS[number][0]):
                return '\n'.join(lines)
    raise AssertionError(f'{number} has no mistake')


def likenesses(handed_in):
    return similar.likenesses(handed_in, SOLUTIONS)


def test_a_copy_of_every_region_is_found_with_other_names_spaces_and_comments():
    for week in {n.split('.')[0] for n in SOLUTIONS}:
        copies = {n: disguised(text, 7) for n, (text, _) in SOLUTIONS.items() if n.split('.')[0] == week}
        found = likenesses({'Ada': copies})['Ada']
        expect(found == {n: PUBLISHED for n in copies}, week, found)
    for number in LONG:
        found = likenesses({'Ada': {number: disguised(SOLUTIONS[number][0], 7)}})['Ada']
        expect(found == {number: PUBLISHED}, number, found)
    expect(len(LONG) >= 24, len(LONG), 'regions are long')


def test_right_solutions_that_differ_are_not_nor_stubs_nor_mistakes():
    for what, handed_in in (('others', others()), ('stubs', {n: stub for n, (_, stub) in SOLUTIONS.items()}),
                            ('mistakes', {n: wrong(n) for n in SOLUTIONS})):
        expect(likenesses({'Ada': handed_in}) == {'Ada': {}}, what, likenesses({'Ada': handed_in}))


def test_what_is_short_may_be_equal_by_chance():
    short = {n: text for n, (text, _) in SOLUTIONS.items() if n not in LONG}
    expect(short and likenesses({'Ada': short}) == {'Ada': {}}, likenesses({'Ada': short}))
    mine = {n: text for n, text in ((n, wrong(n)) for n in short) if similar.own_size(text, SOLUTIONS[n][1]) < similar.SHORT}
    expect(likenesses({'Ada': mine, 'Bob': mine}) == {'Ada': {}, 'Bob': {}}, likenesses({'Ada': mine, 'Bob': mine}))
    stubs = {n: stub for n, (_, stub) in SOLUTIONS.items()}
    expect(likenesses({'Ada': stubs, 'Bob': stubs}) == {'Ada': {}, 'Bob': {}}, 'two have stubs')


def test_students_whose_code_is_equal_are_named():
    mine, styles = {'1.2': wrong('1.2'), '2.2': others()['2.2']}, {'1.2': SOLUTIONS['1.2'][0]}
    copy = {n: disguised(text, 3) for n, text in mine.items()}
    found = likenesses({'Ada': mine, 'Bob': copy, 'Cid': styles, 'Dan': {'1.2': wrong('1.3')}})
    expect(found['Ada'] == {n: 'equal to that of Bob' for n in mine}, found)
    expect(found['Bob'] == {n: 'equal to that of Ada' for n in mine}, found)
    # Two copies of the solution are that, and no more.
    expect(found['Cid'] == {'1.2': PUBLISHED} and found['Dan'] == {}, found)
    found = likenesses({'Cid': styles, 'Eve': styles})
    expect(found == {'Cid': {'1.2': PUBLISHED}, 'Eve': {'1.2': PUBLISHED}}, found)
    found = likenesses({name: mine for name in 'ABCDEF'})['A']
    expect(found['1.2'] == 'equal to that of B, C, D and 2 more', found)


def test_exercises_that_follow_each_other_are_a_range():
    numbers = [f'1.{i}' for i in range(1, 7)] + ['2.1']
    for some, says in (('1.1', '1.1'), ('1.3 1.4 1.5 1.6', '1.3-1.6'), ('1.1 1.3 1.4 2.1', '1.1 1.3-1.4 2.1'),
                       ('1.6 2.1', '1.6-2.1'), (' '.join(numbers), 'all')):
        expect(reports.ranges(some.split(), numbers) == says, some, reports.ranges(some.split(), numbers))


def part(points, mistake='', state='', look=''):
    return {'title': 'A', 'of': 4, 'points': points, 'mistake': mistake, 'look': look,
            'state': state or ('wrong' if mistake else 'right')}


def test_the_page_of_the_class_counts_each_named_mistake():
    rows = [(4, ''), (2, 'upside down'), (2, 'upside down'), (2, 'a | pipe'), (0, '', 'open'), (0, '', 'refused'), (1, '', 'wrong')]
    grades = [{'sum': row[0], 'of': 4, 'exercises': {'1.1': part(*row)}} for row in rows]
    page = reports.class_page(['1.1'], grades)
    head = '# 7 submissions, 4 points\n\n| students | exercise | mistake |\n|---|---|---|\n| 2 | 1.1 | upside down |\n| 1 | 1.1 | a \\| pipe |\n'
    expect(page.startswith(head), page)
    expect('\n| 0 to 1 | 2 |\n| 1 to 2 | 1 |\n| 2 to 3 | 3 |\n| 3 to 4 | 1 |\n' in page, page)
    expect(page.endswith('\n| 1.1 | A | 4 | 1.57 | 1 | 3 | 1 | 1 | 1 |\n'), page)
    expect(reports.class_page(['1.1'], []).startswith('# 0 submissions, 0 points\n'), 'nobody')


def test_jplag_gets_a_folder_of_each_student_and_the_stubs():
    with tempfile.TemporaryDirectory() as top:
        for handed_in in ({'Gone': {}}, {'Ada L.': {'2.2': 'mine\n', '1.2': '    her = own;\n'}, 'Bob': {}}):
            similar.write_for_jplag(f'{top}/jplag', handed_in, SOLUTIONS)
        found = {str(p.relative_to(top)): p.read_text() for p in pathlib.Path(top).rglob('*.cpp')}
        expect(sorted(p.name for p in pathlib.Path(top, 'jplag').iterdir()) == ['Ada L.', 'Bob', 'published-solution'], list(found))
        expect(found['jplag/Ada L./2.2.cpp'] == 'mine\n', found['jplag/Ada L./2.2.cpp'])
        expect(found['jplag/Ada L./1.2.cpp'] == 'void exercise() {\n    her = own;\n\n}\n', found['jplag/Ada L./1.2.cpp'])
        expect(SOLUTIONS['3.6'][0] == found['jplag/published-solution/3.6.cpp'] and SOLUTIONS['3.6'][1] == found['jplag-base/3.6.cpp'])
        expect(len(found) == 2 + 2 * len(SOLUTIONS), len(found))


if __name__ == '__main__':
    testing.run(globals())
