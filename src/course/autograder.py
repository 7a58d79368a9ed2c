# course/autograder.py  17  grade.py where Gradescope runs it: the zip, its image, one submission
"""autograder.py pack [--weeks 1-3] [--seed N] [--visibility WHEN] [--board FILE] FILE.zip
autograder.py setup|run

pack writes the zip: setup.sh, run_autograder, and the project in penumbra/.  setup, once, as root, when the
image is built: compiles the judges, and judges the solution.  run: grades the submission in
/autograder/submission, and writes /autograder/results/results.json.  AUTOGRADER is another folder than
/autograder, for tests.

The contest's errors are measured on one quiet machine, and not here: --board has a line `email,error in %` for each
entry, which run shows as a leaderboard.
"""
import argparse
import concurrent.futures
import json
import os
import pathlib
import re
import secrets
import subprocess
import sys
import types
import zipfile

import grade
import regions
import reports
import sandbox
from regions import ROOT
from submission import Submission
from workshop import Broken

TOP = pathlib.Path(os.environ.get('AUTOGRADER', '/autograder'))
SETTINGS = ROOT / 'autograder.json'
OLDEST = 12  # of g++
JOBS = 2  # processors that a container has; Python would count those of its host
# What grading needs: the solution, and what asks, judges and says which weeks there are.
PACKED = ('src/**/*', 'tests/course/*', 'tests/oracle/*.h', 'LICENSE')
UNUSED = ('src/labs/', 'src/book/')
SETUP = '''#!/usr/bin/env bash
# Gradescope runs this once, as root, when it builds the image.
set -e
export DEBIAN_FRONTEND=noninteractive
apt-get update
apt-get install -y --no-install-recommends python3 g++ bubblewrap util-linux
[ "$(g++ -dumpversion | cut -d. -f1)" -ge %d ] || apt-get install -y --no-install-recommends g++-%d
exec python3 "$(dirname "$0")/penumbra/src/course/autograder.py" setup
''' % (OLDEST, OLDEST)
RUN = '''#!/usr/bin/env bash
exec python3 "${AUTOGRADER:-/autograder}/source/penumbra/src/course/autograder.py" run
'''


def pack(words):
    """Everything, with one seed for all submissions."""
    seed = secrets.randbelow(1 << 62) if words.seed is None else words.seed
    weeks = grade.Plan(words.weeks or grade.weekly()).weeks
    try:
        lines = pathlib.Path(words.board).read_text().splitlines() if words.board else []
        board = {email.strip().lower(): float(error) for email, error in (line.split(',') for line in lines if line.strip())}
    except OSError as error:
        raise Broken(str(error)) from None
    except ValueError as error:
        raise Broken(f'{words.board}: each line is an email, a comma and a number: {error}') from None
    settings = {'weeks': ','.join(weeks), 'seed': seed, 'visibility': words.visibility, 'flags': os.environ['FLAGS'], 'board': board}
    with zipfile.ZipFile(words.file, 'w', zipfile.ZIP_DEFLATED) as packed:
        def add(name, text, mode=0o644):
            info = zipfile.ZipInfo(name)
            info.external_attr, info.compress_type = (0o100000 | mode) << 16, zipfile.ZIP_DEFLATED
            packed.writestr(info, text)
        add('setup.sh', SETUP, 0o755)
        add('run_autograder', RUN, 0o755)
        add(f'penumbra/{SETTINGS.name}', json.dumps(settings, indent=1) + '\n')
        for path in sorted({path for pattern in PACKED for path in ROOT.glob(pattern)}):
            name = str(path.relative_to(ROOT))
            if path.is_file() and not name.startswith(UNUSED) and '__pycache__' not in name:
                add(f'penumbra/{name}', path.read_bytes())
    print(f'{words.file}: week{"s" if len(weeks) > 1 else ""} {" ".join(weeks)}, {os.path.getsize(words.file) >> 10} kB, SEED={seed}')


def settled():
    """What grade.py takes from its command line and from make; whoever is another user is kept out."""
    for folder in (TOP / 'source', TOP / 'submission', TOP / 'results'):
        folder.mkdir(parents=True, exist_ok=True)
        folder.chmod(0o700)
    settings = json.loads(SETTINGS.read_text())
    version = subprocess.run(['g++', '-dumpversion'], capture_output=True, text=True).stdout
    os.environ['CXX'] = 'g++' if int(re.match(r'\d*', version)[0] or 0) >= OLDEST else f'g++-{OLDEST}'
    os.environ['FLAGS'] = settings['flags']
    sandbox.demand(os.environ.get('SANDBOX', ''))
    sandbox.closed([ROOT, TOP / 'submission', TOP / 'results'])
    words = types.SimpleNamespace(cache=ROOT / 'build/grade', weeks=settings['weeks'], jobs=JOBS)
    return settings, grade.opened(words, settings['seed'], TOP / 'source/.work')


def setup():
    with settled()[1] as (_, numbers, _, _):
        print(f'ready: {" ".join(numbers)}.  {sandbox.told()}')


def run():
    """One submission, by grade.py's way; without results.json Gradescope tells that the autograder failed."""
    result = TOP / 'results/results.json'
    result.unlink(missing_ok=True)
    settings, everything = settled()
    with everything as (shop, numbers, worth, room), concurrent.futures.ThreadPoolExecutor(JOBS) as pool:
        student = grade.Student(Submission('submission', '', [str(TOP / 'submission')]), shop, numbers)
        with grade.scratch_in(room) as scratch:
            graded = student.grade(pool, scratch, worth)
    told = {**results(graded, settings['visibility']), **leaderboard(settings['board'])}
    reports.write(str(result), json.dumps(told, indent=1) + '\n')
    print(f'{reports.points(graded["sum"])} of {graded["of"]} points.  {reports.flags(graded)}')


def results(graded, visibility):
    """Gradescope's results.json.  It does not tell the seed, which is that of later submissions, too."""
    tests = []
    for number, e in graded['exercises'].items():
        text = [f'**{reports.marked(e["line"])}**', '', *reports.checks(e)]
        tests.append({'name': f'{number} {e["title"]}', 'score': e['points'], 'max_score': e['of'],
                      'status': 'passed' if e['state'] == 'right' else 'failed',
                      'output': '\n'.join(text), 'output_format': 'md', 'visibility': visibility})
    return {'output': ' '.join([*reports.RULES, graded['sandbox']]).strip(), 'output_format': 'md', 'visibility': visibility,
            'stdout_visibility': 'hidden', 'tests': tests}


def leaderboard(board):
    """The best error of those who handed in."""
    path = TOP / 'submission_metadata.json'
    users = json.loads(path.read_text()).get('users', []) if board and path.exists() else []
    errors = [board[user['email'].lower()] for user in users if user['email'].lower() in board]
    return {'leaderboard': [{'name': 'error after 30 s, in %', 'value': min(errors), 'order': 'asc'}]} if errors else {}


def main():
    parser = argparse.ArgumentParser(description=__doc__.split('\n', 1)[0])
    parts = parser.add_subparsers(dest='what', required=True)
    packing = parts.add_parser('pack')
    packing.add_argument('--weeks')
    packing.add_argument('--seed', type=int)
    packing.add_argument('--visibility', default='visible', choices=['visible', 'after_due_date', 'after_published', 'hidden'])
    packing.add_argument('--board')
    packing.add_argument('file')
    parts.add_parser('setup')
    parts.add_parser('run')
    words = parser.parse_args()
    {'pack': lambda: pack(words), 'setup': setup, 'run': run}[words.what]()


if __name__ == '__main__':
    try:
        main()
    except (sandbox.Missing, Broken, regions.Malformed) as error:
        sys.exit(f'autograder: {error}')
