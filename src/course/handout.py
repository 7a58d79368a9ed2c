# course/handout.py  9  sheets as HTML and, where a printer of PDF is installed, as PDF
"""handout.py FOLDER

HTML by pandoc, formulas as MathML: nothing is loaded from anywhere.  PDF by pandoc and XeLaTeX where both are
installed, else by Chromium; hints that fold out are left out on paper.
"""
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

from regions import ROOT

SHEETS = ROOT / 'reference/course'
STYLE = '''<style>
body { max-width: 46em; margin: 2em auto; padding: 0 1em; font: 17px/1.5 Georgia, serif; color: #222; background: #fff }
h1, h2, h3, nav { font-family: system-ui, sans-serif; line-height: 1.2 } h2 { margin-top: 2em; border-top: 1px solid #ccc; padding-top: .7em }
pre { background: #f4f4f0; padding: .6em 1em; overflow-x: auto; font-size: 14px } code { font-size: 90% }
details { border-left: 3px solid #c90; margin: .5em 0; padding: .1em 1em } summary { cursor: pointer; color: #850 }
table { border-collapse: collapse } td, th { border-bottom: 1px solid #ddd; padding: .2em .7em; text-align: left }
img { max-width: 100% } math[display=block] { margin: .7em 0 }
@media print { body { font-size: 11pt; margin: 0 } details { display: none } h2 { break-after: avoid } pre { white-space: pre-wrap } }
</style>
'''


def needs(program, package):
    if not shutil.which(program):
        sys.exit(f'handout: {program} is not installed; on Debian or Ubuntu: sudo apt-get install {package}')


def html_of(sheet, to, head):
    text = sheet.read_text()
    title = text.split('\n', 1)[0].lstrip('# ')
    # Links between sheets lead to their pages.
    text = re.sub(r'\]\(([\w-]+)\.md(#[\w-]*)?\)', r'](\1.html\2)', text)
    for picture in re.findall(r'!\[[^]]*\]\(([^)]+)\)', text):
        source = (sheet.parent / picture).resolve()
        shutil.copy(source, to / source.name)
        text = text.replace(f']({picture})', f']({source.name})')
    out = to / f'{sheet.stem}.html'
    done = subprocess.run(['pandoc', '--standalone', '--from', 'gfm+tex_math_dollars', '--to', 'html5', '--mathml',
                           '--include-in-header', head, '--metadata', f'pagetitle={title}', '--metadata', 'lang=en',
                           '-o', str(out)], input=text, text=True, capture_output=True)
    if done.returncode or done.stderr:
        sys.exit(f'handout: {sheet.name}: {done.stderr.strip()}')
    # Its own style has what ours says, and more.
    page = re.sub(r'<style>\s*(?:code\{|html \{).*?</style>', '', out.read_text(), count=1, flags=re.S)
    out.write_text(page)
    return out, text, title


def pdf_of(page, text, to):
    """The name of what made it; '' if nothing can."""
    out = to / f'{page.stem}.pdf'
    if shutil.which('xelatex'):
        plain = re.sub(r'<details>.*?</details>\n?', '', text, flags=re.S)
        done = subprocess.run(['pandoc', '--from', 'gfm+tex_math_dollars', '--pdf-engine', 'xelatex', '-V', 'geometry:margin=2.5cm',
                               '--resource-path', str(to), '-o', str(out)], input=plain, text=True, capture_output=True)
        if done.returncode:
            sys.exit(f'handout: {page.stem}: {done.stderr.strip()[-600:]}')
        return 'pandoc and XeLaTeX'
    if shutil.which('chromium'):
        with tempfile.TemporaryDirectory() as profile:
            subprocess.run(['chromium', '--headless=new', '--no-sandbox', f'--user-data-dir={profile}', '--no-pdf-header-footer',
                            f'--print-to-pdf={out}', page.resolve().as_uri()], capture_output=True, timeout=120)
        if out.exists():
            return 'Chromium'
    return ''


def main():
    to = pathlib.Path(sys.argv[1])
    needs('pandoc', 'pandoc')
    shutil.rmtree(to, ignore_errors=True)
    to.mkdir(parents=True)
    head = to / 'head.html'
    head.write_text(STYLE)
    pages, printed = [], ''
    for sheet in (s for s in sorted(SHEETS.glob('*.md')) if s.name != 'README.md'):  # which is the instructor's
        page, text, title = html_of(sheet, to, str(head))
        printed = pdf_of(page, text, to)
        pages.append((page.name, title))
    head.unlink()
    links = ''.join(f'<li><a href="{name}">{title}</a>' + (f' (<a href="{name[:-5]}.pdf">PDF</a>)' if printed else '') + '</li>\n'
                    for name, title in pages)
    (to / 'index.html').write_text(f'<!DOCTYPE html>\n<html lang="en"><meta charset="utf-8"><title>A course with Penumbra</title>\n'
                                   f'{STYLE}<h1>A course with Penumbra</h1>\n<ul>\n{links}</ul>\n</html>\n')
    print(f'{to}/index.html: {len(pages)} pages' + (f', and as PDF by {printed}' if printed else
          '; no PDF: neither xelatex (texlive-xetex) nor chromium is installed'))


if __name__ == '__main__':
    main()
