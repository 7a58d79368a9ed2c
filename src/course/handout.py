# course/handout.py  9  sheets as HTML and, where Chromium is installed, as PDF; or their key
"""handout.py [--key] [--paper A4|letter] FOLDER

HTML by pandoc, formulas as MathML: nothing is loaded from anywhere.  PDF by Chromium; hints that fold
out are left out on paper.  --key: the answers in place of blanks, and the instructor's pages.
"""
import argparse
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

import regions
import sheets
from regions import ROOT

SHEETS = ROOT / 'reference/course'
FOR_INSTRUCTORS = ['sessions', 'grading']  # and README, which is read here
BROWSERS = ['chromium', 'chromium-browser', 'google-chrome', 'chrome']
STYLE = '''<style>
@page { size: PAPER; margin: 18mm 22mm 20mm; @bottom-center { content: "TITLE · " counter(page) " / " counter(pages); font: 9pt sans-serif } }
body { max-width: 46em; margin: 2em auto; padding: 0 1em; font: 17px/1.5 Georgia, "DejaVu Serif", serif; color: #222; background: #fff }
h1, h2, h3, nav { font-family: system-ui, sans-serif; line-height: 1.2 } h2 { margin-top: 2em; border-top: 1px solid #ccc; padding-top: .7em }
pre { background: #f4f4f0; padding: .6em 1em; overflow-x: auto; font-size: 14px } code { font-size: 90% }
details { border-left: 3px solid #c90; margin: .5em 0; padding: .1em 1em } summary { cursor: pointer; color: #850 }
table { border-collapse: collapse } td, th { border-bottom: 1px solid #ddd; padding: .2em .7em; text-align: left }
img { max-width: 100% } math { font-family: "Latin Modern Math", "STIX Two Math", "Cambria Math", "DejaVu Serif", serif }
math[display=block] { padding: .4em 0; break-before: avoid } mfrac > * { padding: .15em .1em } math mn, math mtext { font-family: inherit }
.blank { display: inline-block; width: 8em; border-bottom: 1px solid #222 } mtext.blank { padding: 0 2.2em; border-bottom: 1px solid #222; width: auto }
.wide { width: 18em } .whole { white-space: nowrap }
mfrac > mtext.blank { padding: .9em 2.2em .2em; border-bottom: 0 }
.answer { color: #a00; font-weight: bold } mrow.answer { border-bottom: 1px solid #a00 }
@media print {
  body { font-size: 11pt; margin: 0; max-width: none; padding: 0 } details { display: none } pre { white-space: pre-wrap }
  h1, h2, h3, h2 + p, p:has(+ ul, + ol, + pre, + table) { break-after: avoid } p, li, table, img, pre, math { break-inside: avoid }
  p:has(.blank), li:has(.blank) { line-height: 2.1 }
  p:has(math), li:has(math) { padding-top: .35em } p:has(math) { margin-top: .65em }
}
</style>
'''


def needs(program, package):
    if not shutil.which(program):
        sys.exit(f'handout: {program} is not installed; on Debian or Ubuntu: sudo apt-get install {package}')


def filled(sheet, key):
    """A sheet's text, with blanks to write in or with answers."""
    text = sheet.read_text()
    if key:
        return sheets.with_answers(sheet.name, text, lambda a: f'<span class="answer">{a}</span>',
                                   lambda a: '{\\text{ANSWER}' + a + '\\text{REWSNA}}')
    # Behind a question there is room for a sentence.
    text = sheets.with_blanks(re.sub(r'(?<=\?)([ \n]+)____', r'\1<span class="wide blank"></span>', sheets.for_students(text)),
                              '<span class="blank"></span>', '\\text{BLANK}')
    return re.sub(r'(<span class="(?:wide )?blank"></span>)([,.;:)]+)', r'<span class="whole">\1\2</span>', text)


def in_formulas(page):
    """Blanks and answers in MathML, and brackets that are as high as their text, unless \\left says otherwise."""
    page = re.sub(r'<math\b.*?</math>', lambda m: m[0] if '\\left' in m[0] else m[0].replace('stretchy="true"', 'stretchy="false"'),
                  page, flags=re.S)
    page = re.sub(r'<mtext[^>]*>BLANK</mtext>', '<mtext class="blank">&#160;</mtext>', page)
    page = re.sub(r'<mtext[^>]*>ANSWER</mtext>', '<mrow class="answer">', page)
    return re.sub(r'<mtext[^>]*>REWSNA</mtext>', '</mrow>', page)


def html_of(sheet, to, key, paper):
    text = filled(sheet, key)
    title = text.split('\n', 1)[0].lstrip('# ')
    # Links between sheets lead to their pages.
    text = re.sub(r'\]\(([\w-]+)\.md(#[\w-]*)?\)', r'](\1.html\2)', text)
    for picture in re.findall(r'!\[[^]]*\]\(([^)]+)\)', text):
        shutil.copy((sheet.parent / picture).resolve(), to / pathlib.Path(picture).name)
        text = text.replace(f']({picture})', f']({pathlib.Path(picture).name})')
    with tempfile.NamedTemporaryFile('w', suffix='.html') as head:
        head.write(STYLE.replace('PAPER', paper).replace('TITLE', title.replace('"', '')))
        head.flush()
        done = subprocess.run(['pandoc', '--standalone', '--from', 'gfm+tex_math_dollars', '--to', 'html5', '--mathml',
                               '--include-in-header', head.name, '--metadata', f'pagetitle={title}', '--metadata', 'lang=en'],
                              input=text, text=True, capture_output=True)
    if done.returncode or done.stderr:
        sys.exit(f'handout: {sheet.name}: {done.stderr.strip()}')
    out = to / f'{sheet.stem}.html'
    # Pandoc's own style says what ours does, and more.
    out.write_text(in_formulas(re.sub(r'<style>\s*(?:code\{|html \{).*?</style>', '', done.stdout, count=1, flags=re.S)))
    return out, title


def print_pdf(browser, page):
    with tempfile.TemporaryDirectory() as profile:
        subprocess.run([browser, '--headless=new', '--no-sandbox', f'--user-data-dir={profile}', '--no-pdf-header-footer',
                        f'--print-to-pdf={page.with_suffix(".pdf")}', page.resolve().as_uri()], capture_output=True, timeout=120)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument('--key', action='store_true')
    parser.add_argument('--paper', default='A4')
    parser.add_argument('folder', type=pathlib.Path)
    words = parser.parse_args()
    needs('pandoc', 'pandoc')
    shutil.rmtree(words.folder, ignore_errors=True)
    words.folder.mkdir(parents=True)
    browser = next(filter(shutil.which, BROWSERS), None)
    links = ''
    pages = sorted(s for s in SHEETS.glob('*.md') if s.stem != 'README' and (words.key or s.stem not in FOR_INSTRUCTORS))
    for sheet in pages:
        page, title = html_of(sheet, words.folder, words.key, words.paper)
        if browser:
            print_pdf(browser, page)
        pdf = f' (<a href="{sheet.stem}.pdf">PDF</a>)' if page.with_suffix('.pdf').exists() else ''
        links += f'<li><a href="{page.name}">{title}</a>{pdf}</li>\n'
    title = 'A course with Penumbra' + (': the key' if words.key else '')
    (words.folder / 'index.html').write_text(f'<!DOCTYPE html>\n<html lang="en"><meta charset="utf-8"><title>{title}</title>\n'
                                             f'{STYLE}<h1>{title}</h1>\n<ul>\n{links}</ul>\n</html>\n')
    print(f'{words.folder}/index.html: {len(pages)} pages' + (f', as PDF on {words.paper}, too' if browser else
                                                              '; no PDF: install chromium for it'))


if __name__ == '__main__':
    try:
        main()
    except regions.Malformed as error:
        sys.exit(f'handout: {error}')
