# course/sheets.py  5  blanks of the sheets, and the answers that stand behind them
"""In reference/course/*.md an answer is a comment behind its blank:

    it is ____<!-- $2\\pi \\sin\\theta$ --> long
    $t = \\underline{\\qquad} \\cdot z'$<!-- s_z -->

A comment behind a formula answers all blanks in it, with ` | ` between.  In a formula an answer is a
formula, elsewhere Markdown.  What students get has no comments; the key has answers in place of blanks.
"""
import re

import regions

BLANK = re.compile(r'____|\\underline\{\\qquad\}|\\_\\_\\_\\_')
ANSWERS = re.compile(r'(?<=\n)[ ]*<!-- (.*?) -->\n|<!-- (.*?) -->', re.S)


def for_students(text):
    """The sheet without its answers."""
    return ANSWERS.sub('', text)


def parts(name, text):
    """(text up to a comment, its answers), in order, then the rest with none; one answer per blank."""
    at = 0
    for m in ANSWERS.finditer(text):
        before, answers = text[at:m.start()], (m[1] or m[2]).split(' | ')
        if len(BLANK.findall(before)) != len(answers):
            raise regions.Malformed(f'{name}: {len(BLANK.findall(before))} blanks, {len(answers)} answers: {m[0].strip()}')
        yield before, answers
        at = m.end()
    if BLANK.search(text[at:]):
        raise regions.Malformed(f'{name}: a blank without an answer: {text[at:][:80]}')
    yield text[at:], []


def with_answers(name, text, in_text, in_formula):
    """The sheet with in_text(answer) or in_formula(answer) in place of each blank."""
    out = ''
    for before, answers in parts(name, text):
        rest = iter(answers)
        out += BLANK.sub(lambda m: (in_text if m[0] == '____' else in_formula)(next(rest)), before)
    return out


def with_blanks(text, in_text, in_formula):
    return BLANK.sub(lambda m: in_text if m[0] == '____' else in_formula, for_students(text))
