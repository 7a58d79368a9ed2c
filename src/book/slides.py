# book/slides.py  3  a deck for each session of the course: what to show, to derive and to ask, with notes
"""slides.py FOLDER

Writes FOLDER/index.html and a page for each session of reference/course/sessions.md, which loads nothing.  All text is
read where it stands: the plan (Show, Draw, Ask, Where classes stall, Close with), the week's sheet (task, steps, number;
with answers in the notes), exercises.txt, the diagrams of the book.
"""
import base64
import html
import pathlib
import re
import shutil
import sys

import book
import handout
import regions
from regions import ROOT, Malformed

COURSE = ROOT / 'reference/course'
PARTS = ['Show', 'Draw', 'Ask', 'Where classes stall', 'Close with']
STYLE = '''
@page { size: A4; margin: 15mm } * { box-sizing: border-box }
body { margin: 0; font-family: system-ui, sans-serif; color: #222; background: #fff }
section { position: relative; width: min(100vw, 177.78vh); height: min(56.25vw, 100vh); font-size: min(2.3vw, 4.09vh); line-height: 1.35;
  padding: 1.6em 2.4em 1.8em; margin: 0 auto; display: flex; flex-direction: column; overflow: hidden }
.js section { display: none } .js section.on { display: flex }
h1 { font-size: 2.1em; margin: auto 0 .5em } h1 + * { margin-bottom: auto } h2 { font-size: 1.35em; margin: 0 0 .6em; line-height: 1.15; color: #0b57a4 }
p, ul, ol { margin: 0 0 .6em } li { margin-bottom: .25em } .columns { display: flex; gap: 2.5em } .columns > * { flex: 1 }
.number { margin: .8em 0 0; border-left: .25em solid #b35c00; padding-left: .7em; font-size: .92em } .number :last-child { margin-bottom: 0 }
.steps { columns: 2; color: #555 } .steps ol { margin: 0 }
.figure { flex: 1; min-height: 0; display: flex; justify-content: center; align-items: center } .figure > * { max-width: 100%; width: 100%; height: 100%; object-fit: contain }
.figure img { image-rendering: pixelated } .caption { text-align: center; color: #555; margin: .4em 0 0 }
.question { margin: auto 0; font-size: 1.8em; line-height: 1.3 }
footer { position: absolute; bottom: .5em; left: 3em; right: 3em; font-size: .6em; color: #777; display: flex; justify-content: space-between }
code { font: .88em "DejaVu Sans Mono", ui-monospace, monospace; overflow-wrap: anywhere } math { font-family: "Latin Modern Math", "STIX Two Math", "Cambria Math", "DejaVu Serif", serif }
math mn, math mtext { font-family: inherit } mfrac > * { padding: .15em .1em } mrow.mean { border-top: 1px solid }
.blank { display: inline-block; width: 4em; border-bottom: .06em solid } mtext.blank { width: auto; padding: 0 1.5em } .answer { color: #a00; font-weight: bold }
aside { display: none; font-size: max(15px, 1rem); line-height: 1.45; max-width: 60rem; margin: 0 auto; padding: 1em 2em; border-top: 3px solid #b35c00; background: #f7f5f0 }
.notes section.on + aside { display: block } .notes section.on { width: min(60vw, 80vh); height: min(33.75vw, 45vh); font-size: min(1.38vw, 1.84vh); border: 1px solid #999 }
table { border-collapse: collapse } td, th { padding: .1em .7em .1em 0; text-align: left; vertical-align: top }
@media print { section, .js section { display: flex; width: 180mm; height: 101.25mm; font-size: 4.14mm; border: .3mm solid #999; break-inside: avoid; break-before: page }
  aside { display: block; font-size: 9.5pt; max-width: none; padding: 3mm 0; background: none } }
'''
# A second window has the notes; both go on together, whichever has the keys.
SCRIPT = '''
const slides = [...document.querySelectorAll("section")];
let at = 0, other = window.opener;
function show(n, tell = true) {
    at = Math.min(Math.max(n || 0, 0), slides.length - 1);
    slides.forEach((slide, k) => slide.classList.toggle("on", k === at));
    history.replaceState(null, "", "#" + (at + 1));
    if (tell && other && !other.closed) other.postMessage({ slide: at }, "*");
}
const notes = () => document.documentElement.classList.toggle("notes");
const keys = { ArrowRight: 1, ArrowDown: 1, PageDown: 1, " ": 1, ArrowLeft: -1, ArrowUp: -1, PageUp: -1 };
addEventListener("keydown", event => {
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    if (event.key in keys) show(at + keys[event.key]);
    else if (event.key === "Home") show(0);
    else if (event.key === "End") show(slides.length);
    else if (event.key === "n") notes();
    else if (event.key === "p") other = window.open(location.href.split("#")[0] + "?notes#" + (at + 1), "notes", "width=900,height=700");
    else if (event.key === "f") document.documentElement.requestFullscreen();
    else return;
    event.preventDefault();
});
let from = null;
addEventListener("pointerdown", event => { from = event.clientX; });
addEventListener("pointerup", event => {
    const by = event.clientX - from;
    if (Math.abs(by) > 40) show(at - Math.sign(by));
    else if (event.target.closest("section")) show(at + (event.clientX < innerWidth / 4 ? -1 : 1));
});
addEventListener("message", event => { if (event.source === other) show(event.data.slide, false); });
document.documentElement.classList.add("js");
if (location.search === "?notes") notes();
show(+location.hash.slice(1) - 1, false);
'''


class Session:
    """A section of sessions.md."""

    def __init__(self, heading, text):
        found = re.fullmatch(r'((\d)[ab]): (.*) \((.*)\)', heading)
        if not found:
            raise Malformed(f'sessions.md: "{heading}" is not "1a: title (1.1, 1.2)"')
        self.key, self.week, self.title, numbers = found.groups()
        self.title = self.title[0].upper() + self.title[1:]
        ends = numbers.split(' to ')
        named = numbers.split(', ')
        self.exercises = [e for e in regions.exercises() if e.number in named or len(ends) == 2 and ends[0] <= e.number <= ends[1]]
        if not self.exercises or (len(ends) == 1 and len(named) != len(self.exercises)):
            raise Malformed(f'sessions.md: {self.key}: there are no exercises {numbers}')
        parts = re.findall(r'^\* \*\*([\w ]+?)\.?\*\* (.*?)(?=^\* |\Z)', text, re.M | re.S)
        self.parts = {name: ' '.join(words.split()) for name, words in parts}
        if [name for name, _ in parts] not in (PARTS, PARTS[1:]):
            raise Malformed(f'sessions.md: {self.key} has not {", ".join(PARTS)}')
        shown = self.parts.get('Show', '')
        self.diagrams = re.findall(r'`([\w-]+)`', shown)
        self.pictures = re.findall(r'\]\(([\w./-]+\.(?:png|svg))\)', shown)

    def questions(self):
        return [q.strip() for q in re.findall(r'[^?]*\?(?:[^?]*\Z)?', self.parts['Ask'])]


def sessions():
    text = (COURSE / 'sessions.md').read_text()
    parts = re.split(r'^## (.*)\n', text, flags=re.M)
    return [Session(*parts[i:i + 2]) for i in range(1, len(parts), 2)]


def goals(week):
    """What students can after a week, of the table."""
    [found] = re.findall(rf'^\| {week} \| (.*) \|$', (COURSE / 'sessions.md').read_text(), re.M)
    return found.split('; ')


class Exercise:
    """Its section of the sheet: task, steps and number to show, all of it with answers for the notes."""

    def __init__(self, sheet, exercise):
        def section(key):
            text = handout.filled(sheet, key)
            found = re.search(rf'^## {re.escape(exercise.number)} .*?\n(.*?)(?=^## |\Z)', text, re.M | re.S)
            if not found:
                raise Malformed(f'{sheet.name}: no section {exercise.number}')
            return re.sub(r'<details>.*?</details>\n?', '', found[1], flags=re.S).strip()
        text, steps = section(False), section(True)
        paragraphs = text.split('\n\n')
        whole = lambda i: '\n\n'.join(paragraphs[i:i + (2 if paragraphs[i].endswith((':', ',')) else 1)])
        self.task = re.sub(r'^\*\*Task\.\*\* ', '', whole(1))
        self.steps = re.findall(r'^### (.*)$', text, re.M)
        numbers = [whole(i) for i, p in enumerate(paragraphs) if re.match(r'\*\*(A number|Numbers)\.|Worked number', p)]
        self.number = re.sub(r'^(Worked numbers?):', r'**\1:**', numbers[0]) if numbers else ''
        self.notes = steps[steps.index('### '):]
        self.title = f'{exercise.number} {exercise.title}'
        self.diagrams = [name.removesuffix(' ?') for week, words, name in book.rows(book.DIAGRAMS)
                         if week == exercise.week and any(step.startswith(words) for step in self.steps)]


def picture_of(path, alt):
    kind = 'svg+xml' if path.suffix == '.svg' else 'png'
    return f'<div class="figure"><img alt="{html.escape(alt)}" src="data:image/{kind};base64,{base64.b64encode(path.read_bytes()).decode()}"></div>'


def diagram(name, drawn, session):
    if name not in drawn:
        raise Malformed(f'sessions.md: {session.key}: there is no diagram {name}')
    title, told = (re.search(rf'<{tag}[^>]*>(.*?)</{tag}>', drawn[name], re.S)[1] for tag in ('title', 'desc'))
    return f'## {title}\n\n<div class="figure">{drawn[name]}</div>', f'{told}\n\n**Draw.** {session.parts["Draw"]}'


def deck_of(session, drawn):
    """The slides of a session, and the notes of each: Markdown."""
    week, slides = session.week, []
    sheet = COURSE / f'{book.SHEETS[week]}.md'
    draw, stall = (f'**{name}.** {session.parts[name]}' for name in ('Draw', 'Where classes stall'))
    listed = '\n'.join(f'* {e.number} {e.title}' for e in session.exercises)
    can = '\n'.join(f'* {goal}' for goal in goals(week))
    slides.append((f'<h1>{session.title}</h1>\n<div class="columns"><div>\n\n{listed}\n\n</div><div>\n\nAfter week {week} you can\n\n{can}\n\n'
                   '</div></div>', f'{draw}\n\n{stall}'))
    for name in session.pictures:
        alt = re.findall(rf'!\[([^]]*)\]\({re.escape(name)}\)', sheet.read_text())
        if not alt:
            raise Malformed(f'sessions.md: {session.key}: {sheet.name} has no picture {name}')
        slides.append((f'## The picture of the week\n\n{picture_of(COURSE / name, alt[0])}\n<p class="caption">{alt[0]}</p>', ''))
    exercises = [Exercise(sheet, e) for e in session.exercises]
    apart = [name for name in session.diagrams if not any(name in x.diagrams for x in exercises)]
    slides += [diagram(name, drawn, session) for name in apart]
    for x in exercises:
        number = f'\n\n<div class="number">\n\n{x.number}\n\n</div>' if x.number else ''
        steps = '\n'.join(f'1. {step}' for step in x.steps)
        slides.append((f'## {x.title}\n\n{x.task}\n\n<div class="steps">\n\n{steps}\n\n</div>{number}', x.notes))
        slides += [diagram(name, drawn, session) for name in session.diagrams if name in x.diagrams]
    slides += [(f'<div class="question">\n\n{question}\n\n</div>', stall) for question in session.questions()]
    close = session.parts['Close with']
    slides.append((f'## To close\n\n<div class="question">\n\n{close[0].upper() + close[1:]}\n\n</div>', ''))
    return slides


def by_pandoc(texts, key):
    """HTML of many texts, by one call."""
    mark = '<!--PART-->'
    whole = f'\n\n{mark}\n\n'.join(re.sub(r'(?<!!)\[([^]]*)\]\([^)]*\)', r'\1', t) for t in texts)
    page = book.by_pandoc(whole, key)
    parts = re.sub(r'\n?<details class="answers">.*?</details>|</?section[^>]*>|<annotation.*?</annotation>', '', page, flags=re.S).split(mark)
    if len(parts) != len(texts):
        raise Malformed(f'{key}: {len(parts)} parts of {len(texts)}')
    return parts


def page_of(session, deck):
    texts = [t for slide in deck for t in slide]
    parts = by_pandoc(texts, session.key)
    title = f'{session.key} · {session.title}'
    out = ''
    for n, (body, notes) in enumerate(zip(parts[::2], parts[1::2]), 1):
        out += (f'<section>{body}<footer><span>{html.escape(title)}</span><span>{n} / {len(deck)}</span></footer></section>\n'
                f'<aside>{notes}</aside>\n')
    return (f'<!DOCTYPE html>\n<html lang="en"><meta charset="utf-8"><meta name="viewport" content="width=device-width, initial-scale=1">\n'
            f'<title>{html.escape(title)}</title><link rel="icon" href="data:,"><style>{STYLE}</style>\n<body>{out}<script>{SCRIPT}</script></body></html>\n')


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    handout.needs('pandoc', 'pandoc')
    folder = pathlib.Path(sys.argv[1])
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    drawn, links = book.diagrams(), ''
    for session in sessions():
        (folder / f'{session.key}.html').write_text(page_of(session, deck_of(session, drawn)))
        links += f'<li><a href="{session.key}.html">{session.key} · {session.title}</a></li>\n'
    (folder / 'index.html').write_text(f'<!DOCTYPE html>\n<html lang="en"><meta charset="utf-8"><title>Slides</title><style>body {{ font: 1.1rem/1.6 system-ui, sans-serif; margin: 2rem auto; max-width: 40rem }}</style>\n'
                                       f'<h1>Sessions</h1><ul>\n{links}</ul>\n'
                                       '<p>Arrows, space, a click or a finger: next and last. p: notes in a second window. n: notes below. f: full screen. Print: each slide with its notes.</p>\n')
    print(f'{folder}/index.html: {links.count("<li>")} decks')


if __name__ == '__main__':
    try:
        main()
    except Malformed as error:
        sys.exit(f'slides: {error}')
