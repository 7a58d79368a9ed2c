# tell.py  what tests/run says: of a test that has ended, of a layer, and of all
import collections
import re

from plan import read

Result = collections.namedtuple('Result', 'passed failures checks alarms')  # failures: [(where, case, why)]


def result(name, report, log, status, late):
    """What a test reports (reporter.h), and why it ended if it did not come to its end.  late: why it was ended"""
    where, case, why, passed, failures, sums = f'tests/{name}.cpp:1', 'outside of its cases', '', 0, [], None
    for line in read(report).split('\n'):
        what, *row = (line.split('\t') + 3 * [''])[:4]
        if what == 'begin' or what == 'failed' and row[2].startswith('crashed'):
            where, case, why = row
        elif what == 'failed':
            failures.append(row)
        elif what == 'sum':
            sums = int(row[0]), float(row[1])
        passed += what == 'passed'
    if not sums:
        number = -status if status < 0 else status - 128  # a shell tells of signals in this way
        ended = late or (f'crashed: signal {number}' if number > 0 else f'ended the program: exit status {status}')
        if late and why.startswith('crashed'):
            why = ''  # by the signal that ended it
        if not why.startswith('crashed'):
            why += '; ' * bool(why) + ended
        words = r'Assertion .*|terminate called .*|what\(\): .*|ERROR: AddressSanitizer.*|runtime error: .*'
        why += ''.join(f': {said}' for said in re.findall(words, read(log))).replace('\\', '')
        failures.append((where, case, why))
    return Result(passed, failures, *sums or (0, 0))


def layer(folders, results, seconds):
    """A line; whether the layer has failed."""
    ran = [r for r in results if r]
    passed, failed, broken = sum(r.passed for r in ran), sum(len(r.failures) for r in ran), len(results) - len(ran)
    print(f'{folders:<16} {len(results)} file{"s" * (len(results) > 1)}, {passed} cases passed' + f', {failed} failed' * (failed > 0) +
          f', {broken} not built' * (broken > 0) + f', after {int(seconds)} s', flush=True)
    return failed + broken > 0


def output(log):
    """What a test has printed, without what every test prints."""
    same = r'\[doctest\]|=====*$|\d* statistical checks|\d* passed, \d* failed$'
    print(''.join(line for line in read(log).splitlines(True) if not re.match(same, line)), end='')


def messages(log):
    """Warnings of compilers, and the first error of everything that was not built: {error: how often}."""
    warnings, errors, failed, first, ours = {}, {}, set(), '', ''
    for line in read(log).split('\n'):
        if ': warning: ' in line:
            warnings[line] = True
        if re.match(r'(\./)?(src|tests)/[^:]*:\d', line):
            ours = line.split('\t')[0].split(': ')[0]
        if not first and re.search('error: |undefined reference|No such file|No rule to make', line):
            first = line + (f'; from {ours}' if line[0] == '/' and ours else '')
        if '*** ' in line:  # make's last word on a target: was it terminated, since a lower layer has failed?
            if line not in failed and not line.endswith('Terminated'):
                errors[first or line] = errors.get(first or line, 0) + 1
            failed.add(line)
            first = ours = ''
    return list(warnings), list(errors.items())


def everything(results, waits, logs):
    """Messages, failed cases, where to start, counts, in at most 40 lines: the exit status.  results: None if not built"""
    def say(text):
        print(text if len(text) <= 240 else text[:237] + '...')
    ran, broken = [r for r in results.values() if r], sum(r is None for r in results.values())
    red = [(name, r.failures) for name, r in results.items() if r and r.failures]
    cases = [f'{name}: {case}: {why}' for i, (name, those) in enumerate(red) for _, case, why in those[:2 if i else 8]][:20]
    passed, failed = sum(r.passed for r in ran), sum(len(r.failures) for r in ran)
    warnings, errors = messages(f'{logs}/compile')
    for warning in warnings[:3]:
        say(warning)
    if warnings[3:]:
        print(f'and {len(warnings) - 3} more warnings in {logs}/compile')
    for i, (error, times) in enumerate(errors[:4] if broken else []):
        say(f'not built: {error}' + f' ({times} times)' * (times > 1) + f'; {logs}/compile' * (i == 0))
    for case in cases:
        say(case)
    if failed > len(cases):
        print(f'    and {failed - len(cases)} more failed cases: {logs}')
    if broken and errors:
        say(f'start here: {errors[0][0]}')
    elif red:
        name, [(where, case, _), *_] = red[0]
        say(f'start here: {case}, {where}; make test ONLY=' + re.sub('.*/|_test$', '', name))
    elif broken:
        print('start here: ')
    if waits:
        print(f'{waits}; make test ALL=1 runs all')
    checks = sum(r.checks for r in ran)
    if checks:
        print(f'{checks} statistical checks; a false alarm has a probability of at most {sum(r.alarms for r in ran):.1e}')
    print(f'{passed} passed, {failed + broken} failed')
    return 1 if failed + broken or not passed else 0
