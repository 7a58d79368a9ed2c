# course/testing.py  what tests in Python share
import sys


def expect(good, *what):
    if not good:
        raise AssertionError(' '.join(str(w) for w in what))


def run(tests):
    """Those named on the command line of {name: function}, or all; --list: their names alone."""
    names = [n for n in tests if n.startswith('test_')]
    if sys.argv[1:] == ['--list']:
        print('\n'.join(names))
        return
    for name in sys.argv[1:] or names:
        tests[name]()
