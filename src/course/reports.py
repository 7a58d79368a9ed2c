# course/reports.py  14  what becomes of verdicts: points, grade.json and grade.md, tables
#
# What students wrote, and what a compiler says of it, is shown as text: no marks of Markdown or HTML,
# no formulas of a spreadsheet.  Of compilers only words about the student's own lines are shown, since
# others could quote a solution.
import collections
import csv
import json
import math
import os
import pathlib
import re
import time

MAX_MESSAGES = 5
# What a compiler says where a header is missing, which `make check` knows, too.
OF_A_HEADER = re.compile(r"(member of|in namespace|template) [^ ]*std|std::.* (has not been declared|incomplete type)|#include <|the header <")
ALONE = '; a region has only what its file includes'


def plain(text, most=300):
    """One line of printable text."""
    text = ''.join(c if c.isprintable() else ' ' for c in text)
    return text if len(text) <= most else text[:most] + ' ...'


def marked(text, most=300):
    """The same, with nothing that Markdown or HTML would take for more than text."""
    return re.sub(r'([\\`*_{}\[\]()#+!|~$-])', r'\\\1', plain(text, most)).replace('&', '&amp;').replace('<', '&lt;')


def own_messages(said, region):
    """Errors of the compiler in the region's own lines, by the lines of the student's file."""
    kept = []
    for part in re.split(r'\n(?=[^\n]*error: )', said):
        found = re.match(r'student/%s:(\d+):(?:\d+:)? (?:fatal )?error: (.*)' % re.escape(region.exercise), part)
        if found and 1 <= int(found[1]) <= region.text.count('\n'):
            kept.append(f'{region.file}:{region.line + int(found[1]) - 1}: {plain(found[2], 200)}' + (ALONE if OF_A_HEADER.search(part) else ''))
    return list(dict.fromkeys(kept))[:MAX_MESSAGES]


def share(verdict, items, stub):
    """The part of an exercise's points.

    The dearest wrong item says what a known mistake costs.  Any other has no more than its part of the items, beyond
    those that its stub has right.  Week 6 has a rule of its own: credit.
    """
    if verdict['state'] == 'right':
        return 1.0
    if verdict['state'] not in ('wrong', 'silent'):
        return 0.0
    if verdict['credit'] is not None:
        return verdict['credit']
    left = 1 - max(item['costs'] for item in verdict['items'] if not item['right'])
    if verdict['named']:
        return left
    right = sum(item['right'] for item in verdict['items'])
    return min(left, max(0.0, (right - stub) / max(items - stub, len(verdict['items']) - stub, 1)))


def headline(number, verdict):
    """A verdict in a sentence."""
    state, items = verdict['state'], verdict['items']
    sentence = {
        'right': f'right: {len(items)} of {len(items)}',
        'open': 'open: the stub is still there',
        'missing': f'not judged: {verdict["says"]}',
        'refused': f'refused: {verdict["says"]}',
        'not compiled': f'does not compile{": " + verdict["says"] if verdict["says"] else ""}',
        'not judged': f'not judged: {verdict["says"]}',
        'silent': f'wrong: {verdict["says"]}',
        'wrong': f'wrong: {verdict["says"]}',
    }[state]
    if verdict.get('read') and state == 'wrong':
        sentence += f'; read "{verdict["read"]}" in sheet {number.split(".")[0]}'
    return plain(sentence)


def write(path, text):
    """Under a new name first: readers find all of it or nothing."""
    with open(path + '.partial', 'w', encoding='utf-8', errors='backslashreplace', newline='') as file:
        file.write(text)
        file.flush()
        os.fsync(file.fileno())
    os.replace(path + '.partial', path)


def points(number):
    return f'{number:.2f}'.rstrip('0').rstrip('.')


def sheet(grade):
    """grade.md: a table, then what was looked at."""
    lines = [f'# {marked(grade["student"])}: {points(grade["sum"])} of {points(grade["of"])} points', '',
             '| exercise | | points | of | verdict | all together |', '|---|---|---|---|---|---|']
    for number, e in grade['exercises'].items():
        lines.append(f'| {number} | {marked(e["title"])} | {points(e["points"])} | {e["of"]} | {marked(e["line"])} | '
                     f'{marked(e["together"])} |')
    lines += ['', *RULES, *TOGETHER, f'Seed {grade["seed"]}, solution {grade["course"][:16]}.  {grade["sandbox"]}'.rstrip(), '']
    for number, e in grade['exercises'].items():
        if e['items'] or e['compiler']:
            lines += [f'## {number} {marked(e["title"])}', '', *checks(e), '']
    return '\n'.join(lines)


RULES = ['Each exercise is graded by itself, in a solution that is right elsewhere; later exercises are stubs.  A known mistake',
         'costs half of the points, or a quarter if only items marked so are wrong.  Any other mistake costs at least as much,',
         'and leaves no more than the share of items that are right.  Week 6 follows the rule of its sheet.']
TOGETHER = ['The column "all together" has the verdict when all that was handed in is in one program; points do not depend on it.']


def checks(e):
    """What was looked at in an exercise, or what the compiler said: a list."""
    lines = []
    for item in e['items']:
        seen = f': {marked(item["seen"])}' if item['seen'] and not item['right'] else ''
        state = 'right' if item['right'] else '**wrong**' if item['costs'] == 0.5 else '**wrong** (a quarter)'
        lines.append(f'* {state}, {item["kind"]}: {marked(item["what"])}{seen}')
    return lines + [f'* {marked(message)}' for message in e['compiler']]


def cell(text):
    """A cell that no spreadsheet takes for a formula."""
    text = plain(str(text), 10000)
    return "'" + text if text[:1] in ('=', '+', '-', '@') and not re.fullmatch(r'-?[0-9.]+', text) else text


def counted(n, what):
    return f'{n} {what}' + ('s' if n != 1 else '')


def look(verdict):
    """Why an instructor should look at it: it was not judged, refused or stopped; '': nothing of that."""
    state, says = verdict['state'], verdict['says']
    seen = verdict['items'][-1]['seen'] if state == 'silent' else ''
    # What ends the program, or answers in another's name, is no mistake in a formula.
    hostile = 'hostile? ' if re.search('is no answer|, no answer$|ends the program', seen) else ''
    return {'missing': says, 'not judged': says, 'not compiled': says, 'refused': f'refused: {says}',
            'silent': hostile + seen}.get(state, '')


def flags(grade):
    """What an instructor should look at, by its reasons."""
    numbers, reasons = list(grade['exercises']), {}
    for number, e in grade['exercises'].items():
        for reason in filter(None, (e['look'], grade.get('equal', {}).get(number))):
            reasons.setdefault(reason, []).append(number)
    return '; '.join(f'{ranges(of, numbers)}: {reason}' for reason, of in reasons.items())


def ranges(some, numbers):
    """1.1 1.3-1.6, of these numbers; all."""
    if len(some) == len(numbers) > 1:
        return 'all'
    runs = []
    for at in map(numbers.index, some):
        if runs and runs[-1][1] == at - 1:
            runs[-1][1] = at
        else:
            runs.append([at, at])
    return ' '.join(numbers[a] if a == b else f'{numbers[a]}-{numbers[b]}' for a, b in runs)


def table(path, rows):
    with open(path + '.partial', 'w', encoding='utf-8', errors='backslashreplace', newline='') as file:
        csv.writer(file).writerows([cell(c) for c in row] for row in rows)
    os.replace(path + '.partial', path)


def without_number(grades):
    """Who is not in the tables for Moodle and Canvas, and what to do."""
    lack = sum(not g['number'] for g in grades)
    who = (f'{lack} of {counted(len(grades), "student")} have no number, and are not in moodle.csv and canvas.csv' if lack < len(grades) else
           'No student has a number: moodle.csv and canvas.csv are not written')
    return who + ('. Grade the folder that Moodle or Canvas lets you download as it is, '
                  'or put a number of four digits or more into each name, such as Ada_4711.')


def tables(folder, numbers, grades):
    """grades.csv has a line per student; moodle.csv and canvas.csv are what these import, of students with a number.

    Those without a number are counted in without-number.txt.  What an earlier grading left of these three is removed.
    """
    for name in ('moodle.csv', 'canvas.csv', 'without-number.txt'):
        pathlib.Path(folder, name).unlink(missing_ok=True)
    known = [g for g in grades if g['number']]
    of = points(grades[0]['of']) if grades else '0'
    table(os.path.join(folder, 'grades.csv'), [['student', 'number', *numbers, 'sum', 'of', 'look at']] + [
        [g['student'], g['number'], *(points(g['exercises'][n]['points']) for n in numbers), points(g['sum']), points(g['of']), flags(g)]
        for g in grades])
    if len(known) < len(grades):
        write(os.path.join(folder, 'without-number.txt'), without_number(grades) + '\n')
    if not known:
        return
    # Moodle takes no table without dates, and keeps grades that are newer than these.
    date = time.strftime('%Y-%m-%d %H:%M:%S +0000', time.gmtime())
    table(os.path.join(folder, 'moodle.csv'),
          [['Identifier', 'Full name', 'Grade', 'Maximum Grade', 'Last modified (grade)', 'Feedback comments']] +
          [[f'Participant {g["number"]}', g['student'], points(g['sum']), of, date, feedback(g)] for g in known])
    table(os.path.join(folder, 'canvas.csv'), [['Student', 'ID', 'SIS User ID', 'SIS Login ID', 'Section', 'Penumbra'],
                                               ['    Points Possible', '', '', '', '', of]] + [
        [g['student'], g['number'], '', '', '', points(g['sum'])] for g in known])


def class_page(numbers, grades):
    """class.md: the mistakes that have a name, the most frequent first; how points are distributed; each exercise."""
    of = grades[0]['of'] if grades else 0
    lines = [f'# {counted(len(grades), "submission")}, {points(of)} points', '', '| students | exercise | mistake |', '|---|---|---|']
    mistakes = collections.Counter((n, e['mistake']) for g in grades for n, e in g['exercises'].items() if e['mistake'])
    lines += [f'| {count} | {n} | {marked(what)} |' for (n, what), count in mistakes.most_common()]
    width = max(1, math.ceil(of / 10))
    bins = collections.Counter(min(g['sum'], of - 1) // width for g in grades)  # the last has its end
    lines += ['', '| points | students |', '|---|---|',
              *(f'| {a} to {min(a + width, of)} | {bins[a // width]} |' for a in range(0, of, width)), '',
              '| exercise | | of | mean | right | wrong, named | wrong, else | open | other |', '|---|---|---|---|---|---|---|---|---|']
    for n in numbers:
        parts = [g['exercises'][n] for g in grades]
        states = collections.Counter('named' if p['mistake'] else 'wrong' if p['state'] == 'silent' else p['state'] for p in parts)
        known = [states[state] for state in ('right', 'named', 'wrong', 'open')]
        if parts:
            lines.append(f'| {n} | {marked(parts[0]["title"])} | {parts[0]["of"]} | {points(sum(p["points"] for p in parts) / len(parts))} | '
                         + ' | '.join(str(k) for k in [*known, len(parts) - sum(known)]) + ' |')
    return '\n'.join(lines) + '\n'


def feedback(grade):
    return '; '.join(f'{n}: {points(e["points"])} of {e["of"]}' for n, e in grade['exercises'].items())


def save(folder, grade):
    """grade.md, then grade.json, which says that the student is done."""
    os.makedirs(folder, exist_ok=True)
    write(os.path.join(folder, 'grade.md'), sheet(grade))
    write(os.path.join(folder, 'grade.json'), json.dumps(grade, indent=1) + '\n')


def load(folder):
    try:
        with open(os.path.join(folder, 'grade.json'), encoding='utf-8') as file:
            return json.load(file)
    except (OSError, ValueError):
        return None
