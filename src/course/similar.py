# course/similar.py  12  whose code equals the published solution or another student's; a folder for JPlag
#
# Equal are two regions whose tokens are, without comments and spaces and with names numbered by their
# first appearance: whoever renames and reformats changes nothing.  A region that has little beyond its
# stub may be equal by chance: it is told only beside a longer one that equals the same.
import collections
import hashlib
import pathlib
import shutil

from region import tokens

SHORT = 40  # tokens that begin three which are nowhere in the stub


def signs(text):
    return [(kind, sign) for kind, sign, _ in tokens(text) if kind not in ('comment', 'space')]


def normal_form(text):
    """A digest, equal for texts that differ in comments, spaces and names alone."""
    names = {}
    form = [str(names.setdefault(sign, len(names))) if kind == 'name' else f'{kind} {sign}' for kind, sign in signs(text)]
    return hashlib.sha256('\0'.join(form).encode('utf-8', 'surrogateescape')).hexdigest()


def own_size(text, stub):
    """How many tokens begin three in a row that the stub has not, or not as often; all names are alike."""
    def threes(code):
        row = ['' if kind == 'name' else sign for kind, sign in signs(code)]
        return collections.Counter(tuple(row[i:i + 3]) for i in range(len(row)))
    return sum((threes(text) - threes(stub)).values())


def likenesses(handed_in, solutions):
    """name -> {exercise: whose it equals}, of name -> {exercise: text} and exercise -> (solution, stub).

    The published solution, None, is one more who handed in; of what equals it, nothing else is said.
    """
    groups, partners, found = collections.defaultdict(list), collections.defaultdict(set), {name: {} for name in handed_in}
    for name, texts in [(None, {n: solution for n, (solution, _) in solutions.items()}), *handed_in.items()]:
        for number, text in texts.items():
            groups[number, normal_form(text)].append((name, text))
    groups = {key: dict(group) for key, group in groups.items() if len(group) > 1}
    for (number, _), group in groups.items():
        if own_size(next(iter(group.values())), solutions[number][1]) >= SHORT:
            for name in group:
                partners[name] |= set(group) - {name}
    for (number, _), group in groups.items():
        for name in set(group) - {None}:
            others = [other for other in group if other in partners[name]]
            if None in others:
                found[name][number] = 'equal to the published solution'
            elif others and None not in group:
                found[name][number] = f'equal to that of {listed(others)}'
    return found


def listed(names):
    return ', '.join(names[:3]) + (f' and {len(names) - 3} more' if len(names) > 3 else '')


def write_for_jplag(folder, handed_in, solutions):
    """folder/NAME/2.2.cpp of each student and of the published solution, and folder-base/2.2.cpp, the stubs.

    What stands within a function gets one around it: JPlag reads C++.
    """
    base = pathlib.Path(f'{folder}-base')
    for place in (pathlib.Path(folder), base):
        shutil.rmtree(place, ignore_errors=True)
    everybody = {pathlib.Path(folder, name): texts for name, texts in handed_in.items()}
    everybody[pathlib.Path(folder, 'published-solution')] = {n: text for n, (text, _) in solutions.items()}
    everybody[base] = {n: stub for n, (_, stub) in solutions.items()}
    for place, texts in everybody.items():
        place.mkdir(parents=True, exist_ok=True)
        for number, text in texts.items():
            if solutions[number][0].startswith(' '):
                text = f'void exercise() {{\n{text}\n}}\n'
            (place / f'{number}.cpp').write_bytes(text.encode('utf-8', 'surrogateescape'))
