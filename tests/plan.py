# plan.py  which tests there are, in reading order, and which of them are meant by names
import collections
import glob
import re
import sys

# shapes_spawn_test, of the folder world, has the header world/shapes.
Test = collections.namedtuple('Test', 'layer place number name header')


def read(path):
    with open(path, encoding='utf-8', errors='surrogateescape', newline='\n') as file:
        return file.read()


def everything(layers):
    """All tests, by layer, place of the folder in LAYERS, number in line 1 of the header, name."""
    folders = [word.split(':') for word in layers.split()]
    layer = {folder: (int(number), place) for place, (folder, number) in enumerate(folders)}
    number = {path[4:-2]: int(re.match(r'\S+ \S+ +(\d+)|', read(path))[1] or 0) for path in glob.glob('src/*/*.h')}
    tests = []
    for path in glob.glob('tests/*/*_test.cpp'):
        name = header = path[6:-9]
        while header not in number and re.search('_[^_/]*$', header):
            header = header[:header.rindex('_')]
        tests.append(Test(*layer.get(name.split('/')[0], (0, 0)), number.get(name, 99), f'{name}_test',
                          header if header in number else name))
    return sorted(tests)


def named(tests, word, more=''):
    """Tests by their name or their header's, in full or its last part; by folder; by prefix."""
    whole, folder = re.escape(word) + more, re.escape(word.rstrip('/')) + more
    for pattern in (f'^{whole}(_test)? | {whole}$', f'/{whole}(_test)? |/{whole}$', f'^{folder}/', f'/{whole}_'):
        found = [t for t in tests if re.search(pattern, f'{t.name} {t.header}')]
        if found:
            return found
    return []


def above(tests, headers):
    """Tests that include one of the headers, directly or else by other headers."""
    def users(paths):
        return [path.split('/', 1)[1] for path in paths if any(f'"{h}"' in read(path) for h in headers)]
    found = [t for t in tests if users([f'tests/{t.name}.cpp'])]
    others = [] if found else users(glob.glob('src/*/*.h') + glob.glob('tests/*/*.h'))
    return above(tests, others) if others else found


def chosen(tests, words, later):
    """The tests that words mean; of a word that means none, says what begins like it.  Without words: all but some."""
    found, unknown = [], []
    if not words:
        return [t for t in tests if not (later and re.search(f' ({later})', f' {t.name} {t.header}'))]
    for word in words:
        short = re.sub(r'^(\./)?(src/)?(tests/)?|(\.h)?(\.cpp)?$', '', word)
        header = sorted(path[4:] for path in glob.glob(f'src/{short}.h') + glob.glob(f'src/*/{short}.h'))[:1]
        those, near, start = named(tests, short) or header and above(tests, header), [], short.split('/')[-1]
        while start and not (those or header or near):
            near, start = named(tests, start, '[^ /]*')[:8], start[:-1]
        found += those
        if not those:
            unknown += [' '.join([f'no test is named {word}' + '; is it one of:' * bool(near),
                                  *[re.sub('.*/|_test$', '', t.name) for t in near],
                                  *['or includes it: whole/ runs the programs' for _ in header]])]
    if unknown:
        print(*unknown, sep='\n', file=sys.stderr)
        sys.exit(2)
    return [t for t in tests if t in found]
