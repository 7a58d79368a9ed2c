# course/submission_test.py  how submissions are read: python3 tests/course/submission_test.py [NAME...]
"""Each function test_... is a test; submission_test.cpp runs them one by one."""
import io
import os
import pathlib
import sys
import tarfile
import tempfile
import zipfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / 'src/course'))
import reports
import submission
import testing
from submission import Problem
from testing import expect

A, B = 'src/world/a.h', 'src/path/b.h'
RIGHT = {A: b'the one', B: b'the other'}


def tar_of(files, mode='w:gz', root='penumbra-starter/'):
    buffer = io.BytesIO()
    with tarfile.open(fileobj=buffer, mode=mode) as tar:
        for name, data in files.items():
            info = tarfile.TarInfo(root + name)
            info.size = len(data)
            tar.addfile(info, io.BytesIO(data))
    return buffer.getvalue()


def zip_of(files, root='penumbra-starter/'):
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, 'w', zipfile.ZIP_DEFLATED) as packed:
        for name, data in files.items():
            packed.writestr(root + name, data)
    return buffer.getvalue()


def folder_of(files, root=''):
    return {root + name: data for name, data in files.items()}


def read(files):
    """What is read of students who handed in {path: bytes}: name -> (number, {file: bytes or sentence})."""
    with tempfile.TemporaryDirectory() as temporary:
        for name, data in files.items():
            path = pathlib.Path(temporary) / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(data)
        return {s.name: (s.number, {f: str(d) if isinstance(d, Problem) else d
                                    for f, d in submission.read(s.paths, [A, B]).items()})
                for s in submission.submissions(temporary)}


def test_every_archive_that_students_make_is_read():
    for name, data in (('x.tar.gz', tar_of(RIGHT)), ('x.tgz', tar_of(RIGHT)), ('x.tar', tar_of(RIGHT, 'w')),
                       ('x.tar.xz', tar_of(RIGHT, 'w:xz')), ('x.tar.bz2', tar_of(RIGHT, 'w:bz2')), ('x.zip', zip_of(RIGHT)),
                       ('x.zip', tar_of(RIGHT)), ('x.ZIP', zip_of(RIGHT, '')), ('x.zip', zip_of({'y.tar.gz': tar_of(RIGHT)})),
                       ('x.tar.gz', tar_of({'y.zip': zip_of(RIGHT)})), ('x/y.zip', zip_of(RIGHT)),
                       ('x/y/z.tar.xz', tar_of(RIGHT, 'w:xz'))):
        expect(read({name: data}) == {'x': ('', RIGHT)}, name, read({name: data}))


def test_downloads_of_moodle_and_canvas_are_students_with_their_numbers():
    packed = tar_of(RIGHT)
    for name, student in (('Ada Lovelace_4711_assignsubmission_file_/starter.tar.gz', 'Ada Lovelace'),
                          ('Ada Lovelace_4711_assignsubmission_file/starter.tar.gz', 'Ada Lovelace'),
                          ('Ada Lovelace_4711_assignsubmission_file_starter.tar.gz', 'Ada Lovelace'),
                          ('lovelaceada_4711_99_starter.tar.gz', 'lovelaceada'),
                          ('lovelaceada_LATE_4711_99_starter-1.tar.gz', 'lovelaceada')):
        expect(read({name: packed}) == {student: ('4711', RIGHT)}, name, read({name: packed}))
    both = read({'Ada_1_assignsubmission_file_/a.zip': zip_of(RIGHT), 'Ada_2_assignsubmission_file_/a.zip': zip_of(RIGHT)})
    expect(both == {'Ada_1': ('1', RIGHT), 'Ada_2': ('2', RIGHT)}, both)
    text = read({'Ada_1_assignsubmission_file_/a.zip': zip_of(RIGHT), 'Ada_1_assignsubmission_onlinetext_/onlinetext.html': b'hi'})
    expect(text == {'Ada': ('1', RIGHT)}, text)


def test_what_is_handed_in_twice_counts_if_both_are_the_same():
    other = {**RIGHT, B: b'a later version'}
    same = ({**folder_of(RIGHT, 'x/a/'), **folder_of(RIGHT, 'x/b/')}, {'x/1.zip': zip_of(RIGHT), 'x/2.tar.gz': tar_of(RIGHT)},
            {'x.zip': zip_of({**folder_of(RIGHT, 'a/'), **folder_of(RIGHT, 'b/')})},
            {'x_7_1_a.zip': zip_of(RIGHT), 'x_7_2_a-1.zip': zip_of(RIGHT)},
            # The archive that was handed out lies beside the work.
            {**folder_of(RIGHT, 'x/'), 'x/starter.tar.gz': tar_of(other)})
    for files in same:
        [(_, found)] = read(files).values()
        expect(found == RIGHT, list(files), found)
    for files in ({**folder_of(RIGHT, 'x/a/'), **folder_of(other, 'x/b/')}, {'x/1.zip': zip_of(RIGHT), 'x/2.zip': zip_of(other)},
                  {'x_7_1_a.zip': zip_of(RIGHT), 'x_7_2_a-1.zip': zip_of(other)}):
        [(_, found)] = read(files).values()
        for sentence in found.values():
            expect('2 copies of src that differ' in sentence, list(files), sentence)


def test_what_cannot_be_read_says_why():
    whole = zip_of(RIGHT)
    at = whole.rindex(b'PK\x05\x06')
    link = zipfile.ZipInfo(A)
    link.external_attr = 0o120777 << 16
    linked = io.BytesIO()
    with zipfile.ZipFile(linked, 'w') as packed:
        packed.writestr(link, '/etc/passwd')
    for name, data, says in (('x.zip', whole[:200], 'the archive is damaged'), ('x.zip', b'', 'the archive is damaged'),
                             ('x.tar.xz', tar_of(RIGHT, 'w:xz')[:99], 'the archive is damaged'),
                             ('x.7z', b'7z\xbc\xaf', 'is neither a folder nor an archive'),
                             ('x.zip', zip_of({'main.cpp': b''}), 'holds no src/'),
                             ('x.zip', linked.getvalue(), 'is a link'),
                             ('x.zip', zip_of({A: b'x' * (2 << 20)}), 'more than 1048576 bytes'),
                             ('x.zip', whole[:at + 12] + b'\xff\xff\xff\x7f' + whole[at + 16:], 'more than 20000 files'),
                             ('x.zip', zip_of({f'{i}': b'' for i in range(20001)}), 'more than 20000 files')):
        [(_, found)] = read({name: data}).values()
        expect(says in str(found[A]), name, found[A])
    deep = tar_of({'z.zip': zip_of({'y.zip': zip_of(RIGHT)})})
    [(_, found)] = read({'x.tar.gz': deep}).values()
    expect('holds no src/' in found[A], found[A])


def test_a_bomb_is_not_unpacked():
    for data in (tar_of({'zeros': bytes(300 << 20)}, 'w:xz'), tar_of({'zeros': bytes(300 << 20)}, 'w:bz2')):
        [(_, found)] = read({'x.tar': data}).values()
        expect('more than 268435456 bytes' in found[A], found[A])


def test_tables_hold_all_of_a_long_course():
    exercises = {f'{w}.{n}': {'points': 2, 'of': 2, 'look': f'src/world/file{w}{n}.h is missing'}
                 for w in range(1, 8) for n in range(1, 8)}
    grade = {'student': 'Ada', 'number': '4711', 'sum': 98, 'of': 98, 'exercises': exercises}
    with tempfile.TemporaryDirectory() as folder:
        reports.tables(folder, list(exercises), [grade])
        for name, last in (('moodle.csv', '7.7: 2 of 2'), ('grades.csv', '7.7: src/world/file77.h is missing')):
            text = (pathlib.Path(folder) / name).read_text()
            expect(text.endswith(last + '\n') and '...' not in text, name, text)


if __name__ == '__main__':
    testing.run(globals())
