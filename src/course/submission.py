# course/submission.py  10  what a student handed in: the regions of his exercises, and nothing else
#
# A submission is a folder or a .tar.gz, both in the hands of someone who may mean harm.  An archive is
# never unpacked: what is wanted of it is read into memory.  A folder is walked without following links,
# and only regular files are opened.  All that is wrong becomes a sentence for its exercise, and no error.
import os
import re
import stat
import tarfile
import zlib

LARGEST_FILE = 1 << 20      # bytes of a source file; those of the house have some 20 000
LARGEST_REGION = 1 << 16
LARGEST_ARCHIVE = 1 << 28   # bytes, unpacked: a starter has fewer than 2 million
MOST_ENTRIES = 20000        # of an archive or a folder
DEPTH = 4                   # folders above src/
ARCHIVES = ('.tar.gz', '.tgz', '.tar')


class Problem(Exception):
    """What is wrong with a submission, a file or a region, as a sentence to its student."""


# ---- Submissions ---------------------------------------------------------------------------------

def submissions(folder):
    """Names and paths of all that lies in the folder, sorted; a name is used once."""
    found, names = [], set()
    for entry in sorted(os.listdir(folder)):
        path = os.path.join(folder, entry)
        if entry.startswith('.'):
            continue
        name = next((entry[:-len(end)] for end in ARCHIVES if entry.endswith(end) and not os.path.isdir(path)), entry)
        if not name or name in names:
            name = entry
        names.add(name)
        found.append((name, path))
    return found


def read(path, wanted):
    """The bytes, or the Problem, of each wanted file ('src/world/warp.h') of a submission."""
    try:
        mode = os.lstat(path).st_mode
        if stat.S_ISLNK(mode):
            raise Problem('the submission is a link')
        if stat.S_ISDIR(mode):
            return read_folder(path, wanted)
        if stat.S_ISREG(mode) and path.endswith(ARCHIVES):
            return read_archive(path, wanted)
        raise Problem('the submission is neither a folder nor a .tar.gz')
    except Problem as problem:
        return {file: problem for file in wanted}
    except OSError as error:
        return {file: Problem(f'the submission cannot be read: {error.strerror}') for file in wanted}


def the_root(paths, wanted):
    """The folder that holds the wanted files, of all those paths; '' is the submission itself."""
    roots = set()
    for path in paths:
        for file in wanted:
            if path == file or path.endswith('/' + file):
                roots.add(path[:-len(file)])
    roots = {root for root in roots if root.count('/') <= DEPTH and not re.search(r'(^|/)(\.|__MACOSX|build/)', root)}
    if len(roots) > 1:
        named = ', '.join(sorted(root or 'itself' for root in roots)[:3])
        raise Problem(f'the submission holds {len(roots)} copies of src ({named}): which one counts?')
    if not roots:
        raise Problem('the submission holds no src/ with the files of the exercises')
    return roots.pop()


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
            if len(paths) > MOST_ENTRIES:
                raise Problem(f'the submission holds more than {MOST_ENTRIES} files')
            if path.count('/') <= DEPTH + 3 and entry.is_dir(follow_symlinks=False):
                waiting.append(path + '/')
    return paths


def read_folder(top, wanted):
    paths = all_paths(top)
    root, found = the_root(paths, wanted), {}
    for file in wanted:
        try:
            found[file] = read_regular(top, root + file, file)
        except Problem as problem:
            found[file] = problem
    return found


def read_regular(top, path, file):
    """The bytes of top/path, of which no folder is a link, and which is a regular file."""
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
        with open(os.open(name, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK, dir_fd=folder), 'rb') as opened:
            if not stat.S_ISREG(os.fstat(opened.fileno()).st_mode):
                raise Problem(f'{file} is no regular file')
            return whole(opened.read(LARGEST_FILE + 1), file)
    except FileNotFoundError:
        raise Problem(f'{file} is missing') from None
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


def inflated(path):
    """The bytes of the tar inside, as they are asked for."""
    class Inflated:
        def __init__(self):
            self.file = open(path, 'rb')
            self.gzip = self.file.read(2) == b'\x1f\x8b'
            self.file.seek(0)
            self.machine, self.ready = zlib.decompressobj(31), b''

        def read(self, size):
            if not self.gzip:
                return self.file.read(size)
            while len(self.ready) < size and not self.machine.eof:
                packed = self.machine.unconsumed_tail or self.file.read(1 << 14)
                if not packed:
                    raise EOFError('the archive is cut off')
                self.ready += self.machine.decompress(packed, 1 << 18)
            taken, self.ready = self.ready[:size], self.ready[size:]
            return taken
    return Inflated()


def read_archive(path, wanted):
    """One pass over the members; what several of them claim to be is a Problem."""
    kept = {}
    try:
        with tarfile.open(fileobj=Limited(inflated(path)), mode='r|') as archive:
            for count, member in enumerate(archive):
                if count > MOST_ENTRIES:
                    raise Problem(f'the archive holds more than {MOST_ENTRIES} files')
                name = re.sub(r'^(\./)+', '', member.name)
                file = next((file for file in wanted if name == file or name.endswith('/' + file)), None)
                if file is None:
                    continue
                kept[name] = Problem(f'the archive holds {file} twice') if name in kept else one_member(archive, member, file)
    except (tarfile.TarError, zlib.error, EOFError, ValueError, OverflowError, RecursionError):
        raise Problem('the archive is damaged') from None
    root = the_root(kept, wanted)
    return {file: kept.get(root + file, Problem(f'{file} is missing')) for file in wanted}


def one_member(archive, member, file):
    if member.issym() or member.islnk():
        return Problem(f'{file} is a link')
    if not member.isreg() or member.issparse():
        return Problem(f'{file} is no regular file')
    if member.size > LARGEST_FILE:
        return Problem(f'{file} has more than {LARGEST_FILE} bytes')
    return archive.extractfile(member).read()
