# course/hunted.py  13  was a planted bug found, and is the test red with it and green without it?
"""hunted.py FOLDER/N FILE

FOLDER/N is a copy that plant.py made, FILE the tests/course/hunt.cpp that was handed in.  The test is
compiled and run in a sandbox: in the copy, and in one without the bug.  Prints what each part of the
answer is worth: 1 for the file, 1 for the line, within two lines of what is wrong, 2 for red with the bug
where it is green without it.
"""
import argparse
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

import regions
import sandbox
import starter

SECONDS = 20  # of processor time
LARGEST = 1 << 16


def read_key(path):
    return dict(line.split(': ', 1) for line in path.read_text().splitlines() if line.split(': ')[0] != 'pictures')


def right_text(file):
    """The file as the copy would have it without the bug."""
    plan = starter.Plan('1', solved=True)
    return regions.rewrite((regions.ROOT / file).read_text(), file, plan.replacement)


def state_of(top, hunt, replaced):
    """green, red, or what else became of the test in the copy `top` with files replaced: {path: text}."""
    with tempfile.TemporaryDirectory() as temporary:
        tree, out = pathlib.Path(temporary) / 'tree', pathlib.Path(temporary) / 'out'
        for folder in ('src', 'tests/oracle'):
            shutil.copytree(top / folder, tree / folder)
        for name, text in replaced.items():
            (tree / name).write_text(text)
        (tree / 'hunt.cpp').write_text(hunt)
        out.mkdir()
        for path in (pathlib.Path(temporary), tree, out, *tree.rglob('*')):
            path.chmod(0o777 if path == out else 0o755 if path.is_dir() else 0o644)
        command = [*os.environ['CXX'].split(), *os.environ['FLAGS'].split(), '-static', '-o', '/out/hunt', 'hunt.cpp']
        built = sandbox.build(str(tree), str(out), command)
        if not built.ok:
            error = re.search(r'^hunt.cpp:\d+.*error: .*$', built.messages, re.M)
            return built.ended or 'does not compile' + (f': {error[0]}' if error else '')
        rules = pathlib.Path(temporary) / 'rules'
        rules.write_bytes(sandbox.filter_program())
        try:
            done = subprocess.run(sandbox.run_command(str(out / 'hunt'), str(rules), SECONDS), stdin=subprocess.DEVNULL,
                                  stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, env=sandbox.environment(),
                                  timeout=3 * SECONDS)
        except subprocess.TimeoutExpired:
            return 'does not end'
        return {0: 'green', 1: 'red'}.get(done.returncode, 'crashes, or takes too long')


def verdict(top, hunt):
    """[(points, of how many, what)] of a test's text."""
    key = read_key(pathlib.Path(f'{top}.key'))
    first, last = (int(n) for n in key['lines'].split('-'))
    found = re.match(r'\s*// FOUND (\S+):(\d+)\s*$', hunt.split('\n', 1)[0])
    file = bool(found) and found[1].removeprefix('./') == key['file']
    line = file and first - 2 <= int(found[2]) <= last + 2
    with_bug = state_of(top, hunt, {})
    without = state_of(top, hunt, {key['file']: right_text(key['file'])})
    return [(int(file), 1, f'the file: {found[1] if found else "none is named"}; it is {key["file"]}'),
            (int(line), 1, f'the line: {found[2] if found else "none is named"}; it is {key["lines"]}'),
            (2 * int((with_bug, without) == ('red', 'green')), 2, f'the test: {with_bug} with the bug, {without} without it')]


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument('copy', type=pathlib.Path)
    parser.add_argument('hunt', type=pathlib.Path)
    words = parser.parse_args()
    top = words.copy.resolve()
    if not pathlib.Path(f'{top}.key').exists():
        raise SystemExit(f'hunted: there is no {words.copy}.key')
    if words.hunt.is_symlink() or not words.hunt.is_file() or words.hunt.stat().st_size > LARGEST:
        raise SystemExit(f'hunted: {words.hunt} is no file of at most {LARGEST >> 10} kB')
    sandbox.demand(os.environ.get('SANDBOX', ''))
    sandbox.closed([regions.ROOT])
    parts = verdict(top, words.hunt.read_text(errors='replace'))
    print(f'{sum(p for p, _, _ in parts)} of {sum(of for _, of, _ in parts)} points')
    for points, of, what in parts:
        print(f'  {points} of {of}  {what}')
    if sandbox.told():
        print(sandbox.told())
    return 0 if all(points == of for points, of, _ in parts) else 1


if __name__ == '__main__':
    try:
        sys.exit(main())
    except sandbox.Missing as missing:
        print(f'hunted: {missing}', file=sys.stderr)
        sys.exit(2)
