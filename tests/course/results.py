# course/results.py  is what the autograder wrote Gradescope's results.json, with the marks of make grade?
"""results.py RESULTS.json GRADE.json"""
import json
import sys

from testing import expect

TOP = {'output', 'output_format', 'visibility', 'stdout_visibility', 'tests'}
TEST = {'name', 'score', 'max_score', 'status', 'output', 'output_format', 'visibility'}
SEEN = ('visible', 'after_due_date', 'after_published', 'hidden')


def same_marks(results, grade):
    """By https://gradescope-autograders.readthedocs.io/en/latest/specs/"""
    expect(set(results) - {'leaderboard'} == TOP, 'fields', sorted(results))
    expect(results['visibility'] in SEEN and results['stdout_visibility'] == 'hidden', 'who sees it')
    expect(str(grade['seed']) not in json.dumps(results), 'it tells the seed')
    expect([t['name'] for t in results['tests']] == [f'{n} {e["title"]}' for n, e in grade['exercises'].items()], 'names')
    for test, e in zip(results['tests'], grade['exercises'].values()):
        expect(set(test) == TEST and test['output_format'] == 'md' and test['visibility'] in SEEN, 'a test has', test)
        expect((test['score'], test['max_score']) == (e['points'], e['of']), test['name'], test['score'], 'but', e['points'], e['line'])
        expect(test['status'] == ('passed' if e['state'] == 'right' else 'failed'), test['name'], 'is', test['status'], e['state'])
        expect(test['output'].startswith('**') and (e['state'] not in ('right', 'wrong') or len(test['output'].split('\n')) > 2),
               test['name'], 'says', test['output'])


if __name__ == '__main__':
    same_marks(*(json.load(open(path, encoding='utf-8')) for path in sys.argv[1:]))
