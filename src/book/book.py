# book/book.py  2  the book to learn from alone: sheets, answers, the lecture's code, tests, pictures
"""book.py FOLDER

Writes FOLDER/index.html, a page for each chapter, and book.pdf where Chromium is installed.  New text
stands in text.md; all else is read where it stands: sheets with their answers (reference/course), code
(src), verdicts (build/course, where the judges are built), mistakes (tests/course/mistakes.txt) and
reports (reference).  In text.md a line of its own is

    # KEY · TITLE                     a chapter begins
    @sheet                            all exercises of its sheet; @sheet intro: what stands before them
    @report FILE.md FIRST WORDS       a paragraph of a report; after a colon, or by @report+, the next, too

Diagrams are those of diagrams.py, live figures those of build/web (make web); both may be missing.
"""
import argparse
import concurrent.futures
import html
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / 'course'))
import handout  # noqa: E402
import regions  # noqa: E402
from regions import ROOT, Malformed  # noqa: E402

LECTURE = ['base', 'world', 'path', 'film']
SHEETS = {'1': '1-intersections', '2': '2-warps', '3': '3-path', '4': '4-halton', '5': '5-shadows', '6': '6-tests',
          'V': 'voronoi', 'R': 'radiosity'}

# Where the code of the lecture stands, in reading order: chapter, its section by its first words, file, and the line with which
# the piece begins (none: the first).  A piece ends where the next one of its file begins.
CODE = '''
0 | Numbers in the code | base/vec.h |
0 | Numbers in the code | base/rng.h |
0 | Numbers in the code | base/stats.h |
0 | Numbers in the code | base/portable.h |
1 | 1.1 | world/scene.h |
1 | 1.2 | world/shapes.h |
1 | 1.2 | world/shapes.h | // ---- Spheres -
1 | 1.3 | world/shapes.h | // ---- Triangles -
1 | 1.4 | world/bvh.h |
1 | 1.5 | world/bvh.h | // A leaf holds count shapes
1 | 1.6 | world/bvh.h | // A row of boxes is split
1 | Any shape | world/shapes.h | // ---- Kinds of shapes -
1 | The tree | world/bvh.h | // Its answers equal those of a loop
1 | The tree | world/tree.h |
2 | 2.1 | world/warp.h |
2 | 2.1 | world/warp.h | // exercise 2.1
2 | 2.2 | world/warp.h | // Directions of the hemisphere z > 0, dense
2 | 2.3 | world/warp.h | // A triangle with corner at the origin
2 | 2.4 | world/warp.h | // Directions about z with a density
2 | 2.5 | world/warp.h | // exercise 2.5
2 | 2.5 | world/lights.h |
2 | 2.6 | world/warp.h | // Uniform over the parallelogram
2 | 2.6 | world/lights.h | // Density per solid angle of the direction
2 | Lights of every kind | world/lights.h | // Corner p and two edges
3 | Scenes as data | world/scene.h | inline constexpr int32_t no_light
3 | Materials | world/bsdf.h |
3 | Materials | world/bsdf.h | // ---- Materials -
3 | The words of a path | path/pathtracer.h |
3 | The words of a path | path/pathtracer.h | // ---- Light sampling -
3 | The words of a path | path/pathtracer.h | // ---- One vertex -
3 | 3.1 | path/pathtracer.h | // ---- The path -
3 | 3.2 | path/pathtracer.h | // The rendering equation (Kajiya 1986)
3 | 3.3 | path/pathtracer.h | // Samples one light, chosen at random
3 | 3.4 | world/warp.h | // Weight of the technique with density
3 | 3.4 | path/pathtracer.h | // MIS weight of emission that a BSDF
3 | 3.5 | path/pathtracer.h | // Light that leaves glass gives eta2
3 | 3.6 | world/bsdf.h | // exercise 3.6
3 | One light of many | world/light_choice.h |
3 | One light of many | world/choice.h |
3 | One light of many | world/prepare.h |
4 | 4.1 | path/halton.h |
4 | 4.2 | path/halton.h | // Returns the next digit of a fraction
4 | 4.3 | path/sampler.h |
4 | 4.3 | path/sampler.h | // ---- Kinds of samplers -
4 | 4.3 | path/sampler.h | // Scrambled Halton points, with
4 | 4.4 | path/sampler.h | // ---- Strata -
4 | Sobol | path/sobol.h |
4 | The start of a path | path/sampler.h | // Sobol' points, with a randomisation
4 | The start of a path | path/start.h |
F | Two halves | film/image.h |
F | Two halves | film/film.h |
F | The error | film/film.h | // ---- Pixels -
F | The error | film/error.h |
F | More samples | film/weights.h |
F | The loop | film/film.h | // ---- Samples -
F | The loop | film/error.h | // ---- Error checks -
F | The loop | film/loop.h |
F | Light that no sample met | film/near_misses.h |
'''

# Diagrams by the heading that they follow: chapter, first words of the heading, name; ?: it shows answers, and folds out.
DIAGRAMS = '''
0 | Solid angle | area-solid-angle
1 | The image plane | image-plane
1 | The visible root | ray-sphere ?
1 | Inside | edge-functions
1 | Three slabs | slab ?
2 | Up from the disc | malley ?
2 | The solid angle of a cap | cone-of-sphere ?
2 | A slanted patch | area-solid-angle ?
3 | Weights that add up | mis-two-strategies
3 | Compensation | roulette
3 | Directions | snell
4 | Mirrored at the point | halton-digits
4 | Sobol | sobol-strata
5 | The question | penumbra
V | The question | voronoi-cell
R | The question | form-factor
'''

# Live figures: chapter, first words of the heading, scene, options of build/penumbra, those of a second picture, caption.
LIVE = '''
0 | An estimator | cornell | --sampler independent --replications 1 --spp 1 | --sampler independent --replications 1 --spp 64 | One path per pixel, and 64: an estimate and a mean of estimates.
1 | Any shape | materials | --view normal --spp 4 | | Normals as colours: what chapter 1 can see.
2 | 2.2 | cornell36 | --view occlusion --spp 16 | | Ambient occlusion: the open share of directions that follow the cosine.
3 | 3.3 | coursework | --light none --spp 16 | --light nee --spp 16 | Without and with light sampling.
3 | 3.4 | materials | --light nee --spp 16 | --light mis --spp 16 | Light sampling alone, and both ways with MIS weights.
4 | 4.3 | coursework | --sampler independent --spp 16 | --sampler halton --spp 16 | Independent numbers and Halton points.
F | Two halves | coursework | --spp 16 | | Click on a pixel to see its paths; its error is known while it renders.
5 | The question | penumbra | --depth 1 --spp 16 | | Light, penumbra and umbra.
R | The question | cornell36 | --spp 16 | | Light that walls send each other: colours bleed.
'''


def rows(table):
    return [[f.strip() for f in line.split('|')] for line in table.strip().split('\n')]


# ---- Code ---------------------------------------------------------------------------------------

class Piece:
    """Lines first ... last - 1, from 0, of a file of src, in a section of a chapter."""

    def __init__(self, chapter, section, file, first):
        self.chapter, self.section, self.file, self.first, self.last = chapter, section, file, first, None


def pieces(table=CODE, root=ROOT):
    """The pieces of code in reading order, with their ends."""
    found, lines_of = [], {}
    for chapter, section, file, begin in rows(table):
        lines = lines_of.setdefault(file, (root / 'src' / file).read_text().rstrip('\n').split('\n'))
        at = [i for i, line in enumerate(lines) if line.strip().startswith(begin)] if begin else [0]
        if len(at) != 1:
            raise Malformed(f'{file}: {len(at)} lines begin with "{begin}"')
        found.append(Piece(chapter, section, file, at[0]))
    for file, lines in lines_of.items():
        parts = sorted((p for p in found if p.file == file), key=lambda p: p.first)
        for part, after in zip(parts, parts[1:] + [None]):
            part.last = after.first if after else len(lines)
            if part.first == part.last:
                raise Malformed(f'{file}: two pieces begin at line {part.first + 1}')
    return found


def lines_of(file, root=ROOT):
    return (root / 'src' / file).read_text().rstrip('\n').split('\n')


def code_html(file, first, last, root=ROOT):
    """A listing with line numbers; the lines of an exercise are marked."""
    out, inside = [], False
    for i, line in enumerate(lines_of(file, root)[:last]):
        mark = regions.BEGIN.match(line) or regions.END.match(line)
        inside = inside or bool(regions.BEGIN.match(line))
        if i >= first:
            text, note = html.escape(line, quote=False), re.search(r'//', line)
            if note:
                at = note.start()
                text = f'{html.escape(line[:at], quote=False)}<i>{html.escape(line[at:], quote=False)}</i>'
            kind = ' class="x"' if inside else ''
            out.append(f'<span id="{file}:{i + 1}" data-n="{i + 1}"{kind}>{text or " "}</span>')
        if mark and regions.END.match(line):
            inside = False
    return f'<pre class="code"><code>{"".join(out)}</code></pre>'


LISTED = re.compile(r'<span id="([a-z_/]+\.h):(\d+)" data-n="\2"(?: class="x")?>(.*?)</span>', re.S)


def uncovered(pages, root=ROOT):
    """Lines of the lecture that do not stand in exactly one of these pages, as they are: region by region."""
    shown = {}
    for page in pages:
        for file, n, text in LISTED.findall(page):
            line = html.unescape(re.sub(r'</?i>', '', text))
            shown.setdefault((file, int(n)), []).append(line)
    wrong = []
    for folder in LECTURE:
        for path in sorted((root / 'src' / folder).iterdir()):
            file, begin = f'{folder}/{path.name}', None
            lines = lines_of(file, root)
            for i in range(len(lines) + 1):
                line = lines[i] if i < len(lines) else None
                seen = shown.get((file, i + 1), [])
                good = line is None or seen == [line or ' ']
                if not good and begin is None:
                    begin, times = i + 1, len(seen)
                elif begin is not None and (good or len(seen) != times):
                    wrong.append(f'{file}:{begin}-{i}: in {times} places' + (', changed' if times == 1 else ''))
                    begin, times = (None, 0) if good else (i + 1, len(seen))
    return wrong


# ---- What stands with an exercise ------------------------------------------------------------------

def fold(summary, inner, kind):
    return f'<details class="{kind}"><summary>{summary}</summary>\n{inner}\n</details>'


def listing(file, first, last, folded):
    where = f'<a href="../../src/{file}">src/{file}</a>, lines {first + 1} to {last}'
    code = code_html(file, first, last)
    return fold(f'The code that runs: {where}', code, 'solution') if folded else f'<p class="where">{where}</p>\n{code}'


def code_of(section, part, found):
    """Listings of a section; those with an exercise fold out, because a learner may try first."""
    out = []
    for p in found:
        if p.section == section:
            lines = lines_of(p.file)[p.first:p.last]
            out.append(listing(p.file, p.first, p.last, any(regions.BEGIN.match(l) for l in lines)))
    if part in SOLVED and not found:  # a chapter beside the lecture
        file, region = SOLVED[part]
        lines = (ROOT / file).read_text().split('\n')
        first, last = region.first, region.last + 1
        while lines[first - 1].strip():
            first -= 1
        while last < len(lines) and lines[last].strip():
            last += 1
        out.append(listing(file.removeprefix('src/'), first, last, True))
    return out


def verdict(exercise):
    """What make check prints of the solution; nothing: its judge is not built."""
    week = exercise.split('.')[0]
    judge, answers = (ROOT / f'build/course/{name}_{week}' for name in ('judge', 'answers'))
    if not (judge.exists() and answers.exists()):
        return ''
    done = subprocess.run([judge, '--mistakes', 'tests/course/mistakes.txt', exercise, '--', answers], cwd=ROOT,
                          env={'PATH': '/usr/bin:/bin', 'ORACLE_PICTURES': ''}, capture_output=True, text=True)
    if done.returncode or done.stderr:
        raise Malformed(f'{exercise}: the solution is not right: {done.stdout}{done.stderr}')
    return done.stdout.strip()


def test_of(exercise, said):
    tests = f'<a href="../../tests/course/judge_{exercise.split(".")[0]}.cpp">its source</a>'
    if not said:
        return fold(f'The test: <code>make check EX={exercise}</code>', f'<p>{tests}</p>', 'test')
    first, *rest = said.split('\n')
    return fold(f'The test, <code>make check EX={exercise}</code>, prints: {html.escape(first)}',
                f'<pre>{html.escape(chr(10).join([first] + rest))}</pre>\n<p>{tests}</p>', 'test')


def mistakes_of(exercise):
    """Named mistakes of an exercise, with the headings where to read."""
    out = []
    for line in (ROOT / 'tests/course/mistakes.txt').read_text().split('\n'):
        fields = line.split('\t')
        if fields[0] == exercise and fields[1] != 'stub':
            out.append(f'<li>{html.escape(fields[2])} <small>({html.escape(fields[3])})</small></li>')
    return fold(f'If something is wrong: {len(out)} mistakes by name', '<ul>\n' + '\n'.join(out) + '\n</ul>', 'mistakes') if out else ''


# ---- Text -----------------------------------------------------------------------------------------

class Chapter:
    def __init__(self, key, title, text):
        self.key, self.title, self.text = key, title, text
        words = re.sub(r'[^a-z0-9]+', '-', title.lower()).strip('-')
        self.page = 'index.html' if key == 'index' else f'{key}-{words}.html'
        self.name = f'{key} · {title}' if key != 'index' else title


def chapters(text=None):
    text = (HERE / 'text.md').read_text() if text is None else text
    parts = re.split(r'^# (\w+) · (.*)\n', text, flags=re.M)
    return [Chapter(*parts[i:i + 3]) for i in range(1, len(parts), 3)]


def sheet_of(key):
    """(what stands before the exercises, the rest) of a sheet with its answers, without what only a course needs."""
    text = handout.filled(ROOT / f'reference/course/{SHEETS[key]}.md', True).split('\n', 1)[1]
    text = re.sub(r'^\*\*Points\.\*\*.*?\n\n', '', text, flags=re.M | re.S)
    text = re.sub(r'^\*\d points?, about (.*?)\. File', r'*About \1. File', text, flags=re.M)
    text = re.sub(r' · \d points · about', ' · about', text)
    text = re.sub(r'!\[([^]]*)\]\(([\w-]+\.png)\)', r'![\1](../../reference/course/\2)', text)
    before, heading, after = text.partition('\n## ')
    return before, heading + after


def report(more, file, begin):
    """A block of a report that begins with these words, and perhaps the next."""
    path = (ROOT / 'reference' / file).resolve()
    name, blocks = path.relative_to(ROOT), path.read_text().split('\n\n')
    found = [i for i, b in enumerate(blocks) if b.startswith(begin)]
    if len(found) != 1:
        raise Malformed(f'{file}: {len(found)} paragraphs begin with "{begin}"')
    i = found[0]
    block = '\n\n'.join(blocks[i:i + (2 if more or blocks[i].rstrip().endswith(':') else 1)])
    said = ' '.join(b.strip().replace('\n', ' ') for b in blocks if re.match('Written (on|by)|Not current', b))
    quoted = '\n'.join(f'> {line}' for line in block.split('\n')) + f'\n>\n> [{name}](../../{name}). {said}'
    return re.sub(r'\]\((?!http|\.\./)([^)]+)\)', rf'](../../{name.parent}/\1)', quoted)


def with_sources(chapter):
    """A chapter's Markdown with its sheet and its reports."""
    text = chapter.text
    if chapter.key in SHEETS:
        before, after = sheet_of(chapter.key)
        for line, part in ('@sheet intro', before), ('@sheet', after):
            if len(re.findall(f'^{line}$', text, re.M)) != 1:
                raise Malformed(f'text.md: chapter {chapter.key} needs one line {line}')
            text = re.sub(f'^{line}$', lambda _: part, text, flags=re.M)
    return re.sub(r'^@report(\+?) (\S+) (.*)$', lambda m: report(m[1], m[2], m[3]), text, flags=re.M)


class Inserts:
    """HTML that passes through Pandoc as comments."""

    def __init__(self):
        self.parts = []

    def mark(self, part):
        self.parts.append(part)
        return f'\n\n<!--INSERT {len(self.parts) - 1}-->\n\n'

    def put(self, page):
        return re.sub(r'<!--INSERT (\d+)-->', lambda m: self.parts[int(m[1])], page)


HEADING = re.compile(r'^(#{2,3}) (.*)\n', re.M)


def assembled(chapter, found, verdicts, drawn, figure, inserts):
    """A chapter's Markdown with marks where code, tests, mistakes, diagrams and figures stand."""
    parts = HEADING.split(with_sources(chapter))
    out, used = parts[0], set()
    own = [p for p in found if p.chapter == chapter.key]

    def after_heading(heading):
        marks = ''
        for key, words, name in rows(DIAGRAMS):
            if key == chapter.key and heading.startswith(words) and (words, name) not in used:
                used.add((words, name))
                name, spoils = name.removesuffix(' ?'), name.endswith(' ?')
                if name in drawn:
                    diagram = f'<figure class="diagram">{drawn[name]}</figure>'
                    marks += inserts.mark(fold('Diagram, with answers', diagram, 'shown') if spoils else diagram)
        return marks

    def end_of_section(section):
        if not section:
            return ''
        marks = ''
        for key, words, *live in rows(LIVE):
            if key == chapter.key and section.startswith(words):
                used.add(words)
                marks += inserts.mark(figure(*live))
        words = next((p.section for p in own if section.startswith(p.section)), '')
        number = re.match(r'[0-9VR]\.\d+', section)
        exercise = number[0] if number else ''
        used.add(('code', words))
        for part in code_of(words, exercise, own):
            marks += inserts.mark(part)
        if exercise:
            marks += inserts.mark(test_of(exercise, verdicts.get(exercise, ''))) + inserts.mark(mistakes_of(exercise))
        return marks

    section = ''
    for level, heading, body in zip(parts[1::3], parts[2::3], parts[3::3]):
        if level == '##':
            out += end_of_section(section)
            section = heading
        out += f'{level} {heading}\n{after_heading(heading)}\n{body}'
    out += end_of_section(section)
    wanted = {('code', p.section) for p in own} | {r[1] for r in rows(LIVE) if r[0] == chapter.key} | \
        {(r[1], r[2]) for r in rows(DIAGRAMS) if r[0] == chapter.key}
    if wanted - used:
        raise Malformed(f'chapter {chapter.key} has no heading for {sorted(map(str, wanted - used))}')
    return out


# ---- Pictures --------------------------------------------------------------------------------------

def diagrams():
    """Name -> SVG of each diagram; empty where diagrams.py is not there."""
    script = HERE / 'diagrams.py'
    if not script.exists():
        return {}
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([sys.executable, script, folder], check=True)
        return {p.stem: p.read_text()[p.read_text().index('<svg'):] for p in pathlib.Path(folder).glob('*.svg')}


WEB_FILES = 'figure.js', 'scenes.js', 'playground.html'


class Figures:
    """Still pictures by build/penumbra, in live figures where build/web is there."""

    def __init__(self, folder):
        self.folder, self.web, self.orders = folder, ROOT / 'build/web', []
        self.is_live = all((self.web / name).exists() for name in WEB_FILES)

    def still(self, scene, options):
        name = re.sub(r'[^a-z0-9]+', '-', f'{scene} {options}').strip('-') + '.png'
        self.orders.append([ROOT / 'build/penumbra', *options.split(), '-o', self.folder / name, ROOT / f'scenes/{scene}.scene'])
        return f'<img src="{name}" alt="{scene} by build/penumbra {html.escape(options)}">'

    def html(self, scene, first, second, caption):
        stills = self.still(scene, first) + (self.still(scene, second) if second else '')
        against = f' against="{second}"' if second else ''
        command = f'build/penumbra {first} scenes/{scene}.scene'
        return (f'<figure><live-figure scene="{scene}" technique="{first}"{against}><div class="stills">{stills}</div></live-figure>'
                f'<figcaption>{caption} <code>{command}</code></figcaption></figure>')

    def draw(self):
        program = ROOT / 'build/penumbra'
        if not program.exists():
            raise Malformed('build/penumbra is not there: make build/penumbra')
        for order in self.orders:
            subprocess.run(order, check=True, capture_output=True)
        for name in WEB_FILES if self.is_live else ():
            shutil.copy(self.web / name, self.folder / name)


# ---- Pages -----------------------------------------------------------------------------------------

SCRIPT = ('<script>document.addEventListener("click", e => e.target.closest?.(".answer")?.classList.toggle("shown"))</script>')


def by_pandoc(text, key):
    done = subprocess.run(['pandoc', '--from', 'gfm+tex_math_dollars', '--to', 'html5', '--mathml', '--section-divs',
                           '--id-prefix', f'{key}-'], input=text, text=True, capture_output=True)
    if done.returncode or done.stderr:
        raise Malformed(f'chapter {key}: {done.stderr.strip()}')
    page = handout.in_formulas(done.stdout)
    page = re.sub(r'\\text\{(?:ANSWER|REWSNA)\}', '', page)  # of the formulas as TeX, which pages carry
    # No font stretches the bar of a mean over two letters.
    page = re.sub(r'<mover>((?:(?!<mover>).)*?)<mo[^>]*>¯</mo></mover>', r'<mrow class="mean">\1</mrow>', page, flags=re.S)
    page = re.sub(r'<math display="block".*?</math>', r'<span class="math">\g<0></span>', page, flags=re.S)
    page = re.sub(r'<math display="inline".*?</math>', lambda m: m[0] if len(re.sub(r'<annotation.*?</annotation>|<[^>]*>|\s', '', m[0])) < 34
                  else f'<span class="long">{m[0]}</span>', page, flags=re.S)
    page = re.sub(r'<table>.*?</table>', r'<div class="wide">\g<0></div>', page, flags=re.S)
    # A step's answers fold out; a click shows a single one.
    steps = re.split(r'(<h[23].*?</h[23]>)', page, flags=re.S)
    for i in range(1, len(steps), 2):
        if 'class="answer"' in steps[i + 1]:
            steps[i] += '\n<details class="answers"><summary>Answers of this step</summary></details>'
    return ''.join(steps)


def with_links(page, pages):
    return re.sub(r'href="(\w+)\.md(#[\w.-]*)?"', lambda m: f'href="{pages[m[1]]}{m[2] or ""}"' if m[1] in pages else m[0], page)


def copied(page, folder):
    """The page with pictures beside it."""
    for picture in set(re.findall(r'src="(\.\./[^"]+)"', page)):
        shutil.copy(HERE / picture, folder / pathlib.Path(picture).name)
        page = page.replace(f'src="{picture}"', f'src="{pathlib.Path(picture).name}"')
    return page


def headings(page):
    return re.findall(r'<section\s+id="([^"]+)"\s+class="level2">\s*<h2[^>]*>(.*?)</h2>', page, re.S)


def contents_of(all_chapters, bodies):
    out = []
    for c in all_chapters[1:]:
        inner = ''.join(f'<li><a href="{c.page}#{i}">{h}</a></li>' for i, h in headings(bodies[c.key]))
        out.append(f'<li><a href="{c.page}"><b>{c.name}</b></a><ul>{inner}</ul></li>')
    return f'<ul class="contents">{"".join(out)}</ul>'


def page_of(chapter, before, after, body, is_live):
    def link(other, word):
        return f'<a href="{other.page}" rel="{word}">{"← " if word == "prev" else ""}{other.name}{" →" if word == "next" else ""}</a>' if other else '<span></span>'
    bar = f'<nav>{link(before, "prev")}<a href="index.html">Contents</a>{link(after, "next")}</nav>'
    side = ''.join(f'<li><a href="#{i}">{h}</a></li>' for i, h in headings(body))
    side = f'<aside><ul>{side}</ul></aside>' if chapter.key != 'index' else ''
    live = '<script src="scenes.js" defer></script><script src="figure.js" defer></script>' if is_live and '<live-figure' in body else ''
    return (f'<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width, initial-scale=1">'
            f'<title>{chapter.name}</title><link rel="icon" href="data:,"><link rel="stylesheet" href="book.css">{live}</head>\n'
            f'<body>{bar}{side}<main><h1>{chapter.name}</h1>\n{body}\n</main>{bar}{SCRIPT}</body></html>\n')


def print_pdf(folder, all_chapters, bodies):
    """One PDF of all chapters: answers shown, nothing folded but hints, still pictures."""
    browser = next(filter(shutil.which, handout.BROWSERS), None)
    if not browser:
        return False
    text = ''.join(f'<article><h1 id="{c.page}">{c.name}</h1>{bodies[c.key]}</article>' for c in all_chapters)
    text = re.sub(r'<details(?= class="(?:solution|test|mistakes|shown)")', '<details open', text)
    text = re.sub(r'</?live-figure[^>]*>', '', text)
    text = re.sub(r'href="[\w-]+\.html(#[^"]+)"', r'href="\1"', text)
    text = re.sub(r'href="([\w-]+\.html)"', r'href="#\1"', text)
    page = folder / 'print.html'
    page.write_text(f'<!DOCTYPE html><html lang="en"><head><meta charset="utf-8"><title>Penumbra, the book</title>'
                    f'<link rel="stylesheet" href="book.css"></head><body class="print"><main>{text}</main></body></html>')
    with tempfile.TemporaryDirectory() as profile:
        subprocess.run([browser, '--headless=new', '--no-sandbox', f'--user-data-dir={profile}', '--no-pdf-header-footer',
                        f'--print-to-pdf={folder / "book.pdf"}', page.resolve().as_uri()], capture_output=True, timeout=300)
    page.unlink()
    return (folder / 'book.pdf').exists()


SOLVED = regions.solution_files()


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument('folder', type=pathlib.Path)
    words = parser.parse_args()
    handout.needs('pandoc', 'pandoc')
    folder = words.folder.resolve()
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    figures, inserts, found, drawn = Figures(folder), Inserts(), pieces(), diagrams()
    numbers = [e.number for e in regions.exercises()]
    with concurrent.futures.ThreadPoolExecutor(2) as two:
        verdicts = dict(zip(numbers, two.map(verdict, numbers)))
    all_chapters = chapters()
    pages = {c.key: c.page for c in all_chapters}
    bodies = {}
    for c in all_chapters:
        text = assembled(c, found, verdicts, drawn, figures.html, inserts)
        bodies[c.key] = copied(with_links(inserts.put(by_pandoc(text, c.key)), pages), folder)
    if wrong := uncovered(bodies.values()):
        raise Malformed('lines of the lecture that are not in one chapter:\n' + '\n'.join(wrong))
    bodies['index'] += contents_of(all_chapters, bodies)
    if figures.is_live:
        bodies['index'] += '<p><a href="playground.html">The playground</a>: a scene of your own beside its picture and its paths.</p>'
    figures.draw()
    shutil.copy(HERE / 'book.css', folder / 'book.css')
    for before, c, after in zip([None] + all_chapters, all_chapters, all_chapters[1:] + [None]):
        (folder / c.page).write_text(page_of(c, before, after, bodies[c.key], figures.is_live))
    is_printed = print_pdf(folder, all_chapters, bodies)
    missing = [what for is_there, what in ((drawn, 'diagrams'), (figures.is_live, 'live figures (make web)'), (all(verdicts.values()), 'verdicts'),
                                           (is_printed, 'PDF (chromium)')) if not is_there]
    print(f'{words.folder}/index.html: {len(bodies)} pages' + (f'; without {", ".join(missing)}' if missing else ''))


if __name__ == '__main__':
    try:
        main()
    except Malformed as error:
        sys.exit(f'book: {error}')
