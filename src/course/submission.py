# course/submission.py  10  what a student handed in: the regions of their exercises, and nothing else
#
# A submission is a folder or an archive, both in the hands of someone who may mean harm.  An archive is
# never unpacked: what is wanted of it is read into memory.  A folder is walked without following links,
# and only regular files are opened.  All that is wrong becomes a sentence for its exercise, and no error.
import bz2
import io
import lzma
import os
import re
import stat
import tarfile
import zipfile
import zlib
from dataclasses import dataclass, field

LARGEST_FILE = 1 << 20      # bytes of a source file; ours have some 20 000
LARGEST_REGION = 1 << 16
LARGEST_ARCHIVE = 1 << 28   # bytes, unpacked: a starter has fewer than 3 million
LARGEST_INNER = 1 << 24     # of an archive in an archive
MAX_INNER = 8
MAX_ENTRIES = 20000        # of an archive or a folder
DEPTH = 4                   # folders above src/
ARCHIVES = ('.tar.gz', '.tar.xz', '.tar.bz2', '.tgz', '.txz', '.tar', '.zip')
DAMAGED = (tarfile.TarError, zipfile.BadZipFile, zlib.error, lzma.LZMAError, OSError, EOFError, ValueError, OverflowError,
           RecursionError, RuntimeError)  # a RuntimeError: it is encrypted
MOODLE = re.compile(r'(.+?)_(\d+)_assignsubmission_(?:file|onlinetext)(?:_.*)?')
CANVAS = re.compile(r'([^_]+)_(?:LATE_)?(\d+)_\d+_.+')


class Problem(Exception):
    """What is wrong with a submission, a file or a region, as a sentence to its student."""


# ---- Submissions ---------------------------------------------------------------------------------

@dataclass
class Submission:
    name: str
    number: str                                 # of the student, where a file's name has it; else ''
    paths: list = field(default_factory=list)   # all that they handed in


def is_archive(name):
    return name.lower().endswith(ARCHIVES)


def student_of(entry):
    """Name and number, by the names that Moodle and Canvas give to downloads, or by a number of four digits or more."""
    told = MOODLE.fullmatch(entry) or CANVAS.fullmatch(entry)
    if told:
        return told[1], told[2]
    name = next((entry[:-len(end)] for end in ARCHIVES if entry.lower().endswith(end)), '') or entry
    numbers = re.findall(r'(?<!\d)\d{4,}(?!\d)', name)
    return name, numbers[0] if len(numbers) == 1 else ''


def submissions(folder):
    """Those of all students, sorted; a name is used once."""
    found = {}
    for entry in sorted(os.listdir(folder)):
        if not entry.startswith('.'):
            who = student_of(entry)
            found.setdefault(who, Submission(*who)).paths.append(os.path.join(folder, entry))
    names = [s.name for s in found.values()]
    for s in found.values():
        if names.count(s.name) > 1:
            s.name += f'_{s.number}'
    return list(found.values())


def read(paths, wanted):
    """The bytes, or the Problem, of each wanted file ('src/world/warp.h') of a submission."""
    copies, problems = {}, []
    for path in paths:
        try:
            copies.update({f'{os.path.basename(path)}/{root}': files for root, files in copies_at(path, wanted).items()})
        except Problem as problem:
            problems.append(problem)
        except OSError as error:
            problems.append(Problem(f'the submission cannot be read: {error.strerror}'))
    chosen = next(iter(copies.values()), {})
    problem = None
    if any(told(files) != told(chosen) for files in copies.values()):
        problem = Problem(f'the submission holds {len(copies)} copies of src that differ ({", ".join(sorted(copies)[:3])}): '
                          'which one counts?')
    elif not copies:
        problem = (problems or [Problem('the submission holds no src/ with the files of the exercises')])[0]
    return {file: problem or chosen.get(file, Problem(f'{file} is missing')) for file in wanted}


def told(files):
    return {file: str(data) if isinstance(data, Problem) else data for file, data in files.items()}


def copies_at(path, wanted):
    """What is in each src/ of a folder or an archive: folder above it -> {file: bytes or Problem}."""
    mode = os.lstat(path).st_mode
    if stat.S_ISLNK(mode):
        raise Problem('the submission is a link')
    if stat.S_ISDIR(mode):
        return copies_in_folder(path, wanted)
    if stat.S_ISREG(mode) and is_archive(path):
        with open(path, 'rb') as opened:
            return copies_in_archive(opened, wanted)
    raise Problem(f'the submission is neither a folder nor an archive ({", ".join(ARCHIVES)})')


def place_of(path, wanted):
    """(folder above src, file) of a wanted file; None for any other path, and where none is looked for."""
    file = next((file for file in wanted if path == file or path.endswith('/' + file)), None)
    root = path[:-len(file)] if file else ''
    return (root, file) if file and root.count('/') <= DEPTH and not re.search(r'(^|/)(\.|__MACOSX|build/)', root) else None


# ---- Folders -------------------------------------------------------------------------------------

def all_paths(top):
    """Of everything below, relative, links and pipes too; those in folders that are links are not there."""
    paths, waiting = [], ['']
    while waiting:
        folder = waiting.pop()
        try:
            entries = sorted(os.scandir(os.path.join(top, folder)), key=lambda entry: entry.name)
        except OSError:
            continue
        for entry in entries:
            path = folder + entry.name
            paths.append(path)
            if len(paths) > MAX_ENTRIES:
                raise Problem(f'the submission holds more than {MAX_ENTRIES} files')
            if path.count('/') <= DEPTH + 3 and entry.is_dir(follow_symlinks=False):
                waiting.append(path + '/')
    return paths


def copies_in_folder(top, wanted):
    copies, paths = {}, all_paths(top)
    for path in paths:
        place = place_of(path, wanted)
        if place:
            try:
                with open_regular(top, path, place[1]) as opened:
                    data = whole(opened.read(LARGEST_FILE + 1), place[1])
            except Problem as problem:
                data = problem
            copies.setdefault(place[0], {})[place[1]] = data
    for path in [] if copies else [path for path in paths if is_archive(path)][:MAX_INNER]:
        with open_regular(top, path, path) as opened:
            copies.update({f'{path}/{root}': files for root, files in copies_in_archive(opened, wanted).items()})
    return copies


def open_regular(top, path, file):
    """top/path, opened, of which no folder is a link, and which is a regular file."""
    folder = os.open(top, os.O_RDONLY | os.O_DIRECTORY | os.O_NOFOLLOW)
    try:
        *folders, name = path.split('/')
        for part in folders:
            inner = os.open(part, os.O_RDONLY | os.O_DIRECTORY | os.O_NOFOLLOW, dir_fd=folder)
            os.close(folder)
            folder = inner
        mode = os.lstat(name, dir_fd=folder).st_mode
        if stat.S_ISLNK(mode):
            raise Problem(f'{file} is a link')
        if not stat.S_ISREG(mode):
            raise Problem(f'{file} is no regular file')
        opened = open(os.open(name, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK, dir_fd=folder), 'rb')
        if not stat.S_ISREG(os.fstat(opened.fileno()).st_mode):
            opened.close()
            raise Problem(f'{file} is no regular file')
        return opened
    except OSError as error:
        raise Problem(f'{file} cannot be read: {error.strerror}') from None
    finally:
        os.close(folder)


def whole(data, file):
    if len(data) > LARGEST_FILE:
        raise Problem(f'{file} has more than {LARGEST_FILE} bytes')
    return data


# ---- Archives ------------------------------------------------------------------------------------

class Limited:
    """A file of which no more than so many bytes are read, however small it was when packed."""
    def __init__(self, opened):
        self.opened, self.left = opened, LARGEST_ARCHIVE

    def read(self, size):
        self.left -= size
        if self.left < 0:
            raise Problem(f'the archive holds more than {LARGEST_ARCHIVE} bytes')
        return self.opened.read(size)


class Inflated:
    """The bytes of a packed file, as they are asked for."""
    def __init__(self, packed, machine):
        self.packed, self.machine, self.ready = packed, machine, b''

    def read(self, size):
        while len(self.ready) < size and not self.machine.eof:
            packed = getattr(self.machine, 'unconsumed_tail', b'')
            if not packed and getattr(self.machine, 'needs_input', True):
                packed = self.packed.read(1 << 14)
                if not packed:
                    raise EOFError('the archive is cut off')
            self.ready += self.machine.decompress(packed, 1 << 18)
        taken, self.ready = self.ready[:size], self.ready[size:]
        return taken


def members_of_tar(opened, magic):
    """(name, 'file', 'link' or other, size, function that reads it), one after the other."""
    machine = (zlib.decompressobj(31) if magic[:2] == b'\x1f\x8b' else lzma.LZMADecompressor() if magic == b'\xfd7zXZ\0' else
               bz2.BZ2Decompressor() if magic[:3] == b'BZh' else None)
    with tarfile.open(fileobj=Limited(Inflated(opened, machine) if machine else opened), mode='r|') as archive:
        for m in archive:
            kind = 'link' if m.issym() or m.islnk() else 'file' if m.isreg() and not m.issparse() else 'other'
            yield m.name, kind, m.size, lambda: archive.extractfile(m).read()


def members_of_zip(opened):
    """The same.  A list of members may be as large as the archive: its size is looked at first."""
    opened.seek(max(0, opened.seek(0, os.SEEK_END) - (1 << 16) - 22))
    tail = opened.read()
    at = tail.rfind(b'PK\x05\x06')
    if at >= 0 and (int.from_bytes(tail[at + 12:at + 16], 'little') > 200 * MAX_ENTRIES or b'PK\x06\x07' in tail):
        raise Problem(f'the archive holds more than {MAX_ENTRIES} files')
    with zipfile.ZipFile(opened) as archive:
        for m in archive.infolist():
            kind = 'link' if stat.S_ISLNK(m.external_attr >> 16) else 'file'
            yield m.filename.replace('\\', '/'), kind, m.file_size, lambda: archive.open(m).read(LARGEST_INNER)


def copies_in_archive(opened, wanted, outermost=True):
    """One pass over the members; what several of them claim to be is a Problem."""
    copies, archives = {}, {}
    try:
        magic = opened.read(6)
        opened.seek(0)
        members = members_of_zip(opened) if magic[:4] == b'PK\x03\x04' else members_of_tar(opened, magic)
        for count, (name, kind, size, load) in enumerate(members):
            if count >= MAX_ENTRIES:
                raise Problem(f'the archive holds more than {MAX_ENTRIES} files')
            name = re.sub(r'^(\./)+', '', name)
            place = place_of(name, wanted)
            if place:
                copy = copies.setdefault(place[0], {})
                copy[place[1]] = Problem(f'the archive holds {place[1]} twice') if place[1] in copy else (
                    one_member(place[1], kind, size, load))
            elif outermost and is_archive(name) and kind == 'file' and size < LARGEST_INNER and len(archives) < MAX_INNER:
                archives[name] = load()
    except DAMAGED:
        raise Problem('the archive is damaged') from None
    for name, data in ({} if copies else archives).items():
        inner = copies_in_archive(io.BytesIO(data), wanted, outermost=False)
        copies.update({f'{name}/{root}': files for root, files in inner.items()})
    return copies


def one_member(file, kind, size, load):
    if kind == 'link':
        return Problem(f'{file} is a link')
    if kind != 'file':
        return Problem(f'{file} is no regular file')
    if size > LARGEST_FILE:
        return Problem(f'{file} has more than {LARGEST_FILE} bytes')
    return load()
