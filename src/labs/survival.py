# labs/survival.py  1  robustness and checkpoint time: reference/survival.md, by `make survival`
"""Measures build/penumbra: memory per pixel, checkpoint time, the latency of Ctrl-C, and renders
that are killed 200 times.  --quick: fewer runs, written to out/."""
import json
import os
import random
import signal
import statistics
import subprocess
import sys
import tempfile
import time

QUICK = '--quick' in sys.argv
FOLDER = tempfile.mkdtemp(prefix='survival.')
PENUMBRA = os.path.abspath('build/penumbra')


def path(name):
    return os.path.join(FOLDER, name)


def scene(name):
    return os.path.abspath(f'scenes/{name}.scene')


def words(*options):
    return [PENUMBRA, '--quiet', '-o', path('a.pfm'), '--stats', path('a.json'), *map(str, options)]


def render(*options):
    """Statistics of a render, and the seconds of its whole process."""
    begun = time.monotonic()
    # A small shell runs it, because the peak of a process begins with its parent's memory.
    subprocess.run(['sh', '-c', '"$@"; exit $?', 'sh', *words(*options)], check=True)
    with open(path('a.json'), encoding='utf8') as file:
        return json.load(file) | {'whole': time.monotonic() - begun}


def bits(name):
    with open(path(name), 'rb') as file:
        return file.read()


def table(heads, rows):
    lines = ['| ' + ' | '.join(heads) + ' |', '|' + '---|' * len(heads)]
    return '\n'.join(lines + ['| ' + ' | '.join(map(str, row)) + ' |' for row in rows]) + '\n\n'


def memory():
    rows = []
    for name in ['penumbra', 'cornell36']:
        none = render('--size', '16x8', '--spp', 17, scene(name))['peak_memory_bytes']
        for size in ['512x256'] if QUICK else ['512x256', '1024x512']:
            run = render('--size', size, '--spp', 17, scene(name))
            width, height = map(int, size.split('x'))
            rows.append([name, size, f"{run['sets_per_pixel']:.2f}",
                         f"{run['peak_memory_bytes'] / 1e6:.0f} MB",
                         f"{(run['peak_memory_bytes'] - none) / (width * height):.1f}"])
    return ('## Memory\n\nPeak memory of the process, including files, from `--stats`; per pixel: less the memory of a picture of '
            '16x8.\nOne replication takes 24 bytes, an image 12, the number of replications 8, its choice 16 temporarily.\n\n'
            + table(['scene', 'size', 'replications per pixel', 'peak', 'bytes per pixel'], rows))


def kept_anew(*base):
    if os.path.exists(path('a.film')):
        os.remove(path('a.film'))
    return render('--keep', path('a.film'), *base)


def cost():
    rows = []
    sizes = [('256x128', 64), ('1024x512', 4)]
    for size, spp in sizes[:1] if QUICK else sizes:
        ratios, film = [], 0
        for _ in range(3):
            base = ('--threads', 1, '--size', size, '--spp', spp, scene('cornell36'))
            without = render(*base)['whole']
            kept = kept_anew(*base)['whole']
            film = os.path.getsize(path('a.film'))
            ratios.append(kept / without - 1)
        rows.append([size, spp, f'{without:.1f} s', f'{film / 1e6:.1f} MB',
                     f'{100 * statistics.median(ratios):+.1f} %',
                     f'{100 * min(ratios):+.1f} … {100 * max(ratios):+.1f} %'])
    return ('## Checkpoint time\n\nTime with `--keep a.film`, which is written at least once, at the end, over the time without: '
            'whole processes\nof one thread, interleaved. At size 256x128 and 64 samples only the last checkpoint is written.\n\n'
            + table(['size', 'samples', 'time', 'file', 'extra time, median', 'range'], rows))


def ctrl_c():
    with open(path('mirrors.scene'), 'w', encoding='utf8') as file:
        file.write('size 64 32\ncamera 0 0 0  0 0 1  60\ndepth 1000000\nmirror m 1 1 1\n'
                   'sphere 0 0 0 10 m\n')
    rows = []
    for what, options in [('paths of 10⁶ scatterings', ['--roulette', 0, path('mirrors.scene')]),
                          ('cornell36, 16384x1', ['--size', '16384x1', '--spp', 10 ** 6, scene('cornell36')])]:
        took = []
        for _ in range(5 if QUICK else 20):
            process = subprocess.Popen(words(*options))
            time.sleep(random.uniform(0.2, 0.7))
            begun = time.monotonic()
            process.send_signal(signal.SIGTERM)  # the parent shell may ignore SIGINT
            process.wait()
            took.append(1e3 * (time.monotonic() - begun))
            assert process.returncode == 143, process.returncode
        rows.append([what, len(took), f'{statistics.median(took):.0f} ms', f'{max(took):.0f} ms'])
    return ('## Ctrl-C\n\nTime from the signal (SIGTERM acts like SIGINT) to the end of the process, which saves the completed passes.\n\n'
            + table(['in', 'signals', 'median', 'most'], rows))


def kills():
    kills_wanted = 20 if QUICK else 200
    options = ['--size', '64x32', '--spp', 1024, '--seed', 1, scene('cornell36')]
    whole = render(*options)
    expected, done, chains = bits('a.pfm'), 0, 0
    while done < kills_wanted:
        if os.path.exists(path('k.film')):
            os.remove(path('k.film'))
        chains += 1
        while True:
            process = subprocess.Popen(words('--keep', path('k.film'), *options))
            try:
                process.wait(random.uniform(0.02, 0.6))
            except subprocess.TimeoutExpired:
                process.send_signal(random.choice([signal.SIGKILL, signal.SIGTERM]))
                process.wait()
                done += 1
                continue
            assert process.returncode == 0, process.returncode
            break
        assert bits('a.pfm') == expected, 'another picture'
        left = [name for name in os.listdir(FOLDER) if '.part' in name]
        assert not left, left
    return (f'## kill -9\n\ncornell36 at 64x32 with 1024 samples ({whole["seconds"]:.1f} s), killed or stopped at random moments '
            f'and resumed until it was done: **{done} kills** in\n{chains} chains of runs; every picture has the bits of an uninterrupted run. '
            f'No file was damaged, and no temporary file remained.\n\n')


report = ('# Robustness and checkpoint time\n\nWritten by `make survival`'
          + (' (`QUICK=1`)' if QUICK else '') + f', on {os.cpu_count()} cores.\n\n'
          + memory() + cost() + ctrl_c() + kills())
where = 'out/survival.md' if QUICK else 'reference/survival.md'
os.makedirs(os.path.dirname(where), exist_ok=True)
with open(where, 'w', encoding='utf8') as file:
    file.write(report.rstrip('\n') + '\n')
subprocess.run(['rm', '-rf', FOLDER], check=True)
print(f'wrote {where}')
