"""What cannot be written ends in one line and leaves what was there before, whichever command writes it."""

import errno
import os
import shutil
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest

from fem_adhesion import cli
from fem_adhesion.common.files import NotWritten, directory_written_aside, open_store, written_aside
from fem_adhesion.curve import solve as curves

CURVE = ["curve", "--tabor", "0.5", "--rtol", "1e-2"]
SMALL_FILES = "import resource; resource.setrlimit(resource.RLIMIT_FSIZE, (2048, 2048))\n"
WRITERS = """
import os, sys
from pathlib import Path
from fem_adhesion import cli
from fem_adhesion.common.files import NotWritten, directory_written_aside, writing, written_aside
for name, kind in (("a.json", written_aside), ("fields", directory_written_aside)):
    try:
        with kind(Path(name)) as place, writing(Path(name)):
            file = place if name == "a.json" else (place / "one").open("w")
            file.write("x" * 99999)
            file.flush()
    except NotWritten as error:
        print(error)
print(cli.main(["curve", "--tabor", "0.5", "--rtol", "1e-2", "--csv", "a.csv", "--json", "b.json"]))
print(sorted(os.listdir()))
"""
OWN_DISK = "mount -t tmpfs -o size=1m tmpfs . && cd . && head -c 1044480 /dev/zero >fill; cd $PWD && exec "


def _own_disk():
    """How to run a command on a disk of one megabyte, all but a page of it in use, or None where that is forbidden."""
    inside = ["unshare", "-Urm", "sh", "-c"]
    if shutil.which("unshare") is None:
        return None
    tried = subprocess.run([*inside, "mount -t tmpfs tmpfs /mnt"], capture_output=True, check=False)
    return [*inside, OWN_DISK + '"$@"', "sh"] if tried.returncode == 0 else None


@pytest.mark.parametrize(
    ("kind", "reason"),
    [
        ("disk", "(No space left on device); free some space or choose another disk"),
        ("limit", "(File too large); raise the limit on the size of files, ulimit -f"),
    ],
)
def test_what_cannot_grow_ends_in_one_line_and_leaves_nothing(kind, reason, tmp_path):
    before = _own_disk() if kind == "disk" else []
    if before is None:
        pytest.skip("no disk of our own without privileges here; the other case limits the size of files")
    code = (SMALL_FILES if kind == "limit" else "") + WRITERS
    done = subprocess.run([*before, sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True)
    left = ["fill"] if kind == "disk" else []
    assert done.stdout.splitlines()[-2:] == ["1", str(left)], done.stderr
    for said in (*done.stdout.splitlines()[:2], done.stderr):
        assert f"cannot be written {reason}" in said
    assert done.stderr.count("\n") == 1


def _full(*_args, **_kwargs):
    raise OSError(errno.ENOSPC, "No space left on device")


@pytest.mark.parametrize("command", ["speed", "greenwood", "finite-sphere"])
def test_a_full_disk_ends_each_study_and_leaves_nothing(command, tmp_path, monkeypatch, refused):
    for study, work, made in (
        ("speed", "measure", None),
        ("greenwood", "compute", None),
        ("finite_sphere", "run", [SimpleNamespace(status="solved", failed=False)]),
    ):
        monkeypatch.setattr(f"fem_adhesion.{study}.page.write", _full)
        monkeypatch.setattr(f"fem_adhesion.{study}.study.{work}", lambda *_, made=made, **__: made)
    words = f"{tmp_path / 'out'} cannot be written (No space left on device)"
    refused(command, "--out", tmp_path / "out", words=words, code=1)
    assert not list(tmp_path.iterdir())


def test_a_defect_is_not_taken_for_a_full_disk(tmp_path, monkeypatch):
    monkeypatch.setattr("fem_adhesion.speed.study.measure", _full)
    with pytest.raises(OSError, match="No space left"):
        cli.main(["speed", "--out", str(tmp_path / "out")])
    assert not list(tmp_path.iterdir())


def test_what_is_refused_at_once_is_bad_input(tmp_path, monkeypatch, refused):
    monkeypatch.setattr("fem_adhesion.curve.solve.solve", lambda *_: pytest.fail("worked"))
    monkeypatch.setattr(os, "access", lambda *_: False)
    monkeypatch.setattr(Path, "mkdir", lambda _: (_ for _ in ()).throw(OSError(errno.EROFS, "Read-only file system")))
    for option, words in (("--json", "choose a folder that exists and is yours"), ("--vtk", "choose a disk that is")):
        refused(*CURVE, option, tmp_path / "a", words=words)


@pytest.mark.parametrize(("option", "name"), [("--json", "a.json"), ("--csv", "a.csv"), ("--vtk", ".")])
def test_a_folder_that_vanishes_meanwhile_is_named(option, name, tmp_path, monkeypatch, refused):
    folder = tmp_path / "folder"
    folder.mkdir()
    solve = curves.solve

    def vanishing(question, step):
        shutil.rmtree(folder)
        return solve(question, step)

    monkeypatch.setattr(curves, "solve", vanishing)
    more = ["--points", "0"] if option == "--vtk" else []
    words = f"{folder / name} cannot be written (No such file or directory); choose a folder that exists"
    refused(*CURVE, option, folder / name, *more, words=words, code=1)
    assert not folder.exists()


def test_a_file_that_cannot_be_replaced_keeps_its_content(tmp_path, monkeypatch):
    file = tmp_path / "a.txt"
    file.write_text("old")
    monkeypatch.setattr(Path, "replace", _full)
    with pytest.raises(NotWritten), written_aside(file) as aside:
        aside.write("new")
    assert file.read_text() == "old"
    with pytest.raises(NotWritten), directory_written_aside(tmp_path / "out") as folder:
        (folder / "b.txt").write_text("new")
    assert list(tmp_path.iterdir()) == [file]


def test_a_directory_in_use_is_refused_unless_forced(tmp_path):
    (tmp_path / "mine").write_text("kept")
    for place, told in ((tmp_path, r"holds 1 files, limit 0; .* --force"), (tmp_path / "mine", "is a file; ")):
        with pytest.raises(ValueError, match=told), directory_written_aside(place):
            pytest.fail("the work was begun")
    with directory_written_aside(tmp_path, force=True) as directory:
        (directory / "new").write_text("new")
    assert {file.name for file in tmp_path.iterdir()} == {"mine", "new"}


def test_nothing_is_left_of_work_that_ends_badly(tmp_path):
    def interrupted(place):
        with directory_written_aside(place) as directory:
            (directory / "half").write_text("")
            raise KeyboardInterrupt

    (tmp_path / "there").mkdir()
    for name in ("there", "new"):
        with pytest.raises(KeyboardInterrupt):
            interrupted(tmp_path / name)
    with pytest.raises(ZeroDivisionError), written_aside(tmp_path / "a") as file:
        file.write(f"half {1 / 0}")
    assert [*tmp_path.rglob("*")] == [tmp_path / "there"]


def test_what_a_link_leads_to_is_written_and_keeps_its_mode(tmp_path):
    (tmp_path / "far").mkdir()
    real, link, dangling = tmp_path / "far" / "a.txt", tmp_path / "link", tmp_path / "dangling"
    real.write_text("old")
    real.chmod(0o640)
    link.symlink_to(real)
    dangling.symlink_to(tmp_path / "far" / "b.txt")
    for path in (link, dangling):
        with written_aside(path) as file:
            file.write("new")
        assert path.is_symlink()
        assert path.read_text() == "new"
    assert real.stat().st_mode & 0o777 == 0o640
    assert sorted(file.name for file in (tmp_path / "far").iterdir()) == ["a.txt", "b.txt"]


def test_links_of_a_directory_are_written_through(tmp_path):
    (tmp_path / "out").symlink_to(tmp_path / "real")
    for force, text in ((False, "first"), (True, "second")):
        with directory_written_aside(tmp_path / "out", force=force) as folder:
            (folder / "a.txt").write_text(text)
        assert (tmp_path / "out").is_symlink()
        assert (tmp_path / "real" / "a.txt").read_text() == text
        (tmp_path / "real" / "a.txt").chmod(0o640)
    (tmp_path / "real" / "a.txt").rename(tmp_path / "elsewhere")
    (tmp_path / "real" / "a.txt").symlink_to(tmp_path / "elsewhere")
    with directory_written_aside(tmp_path / "out", force=True) as folder:
        (folder / "a.txt").write_text("third")
    assert (tmp_path / "real" / "a.txt").is_symlink()
    assert (tmp_path / "elsewhere").read_text() == "third"
    assert (tmp_path / "elsewhere").stat().st_mode & 0o777 == 0o640


def test_a_device_and_a_pipe_are_written_to_whole_or_not_at_all(tmp_path):
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    reader = os.open(pipe, os.O_RDONLY | os.O_NONBLOCK)
    with pytest.raises(ZeroDivisionError), written_aside(pipe) as file:
        file.write(f"{'half' * 9999} {1 / 0}")
    with written_aside(pipe) as file:
        file.write("wh")
        file.flush()
        file.buffer.write(b"ole")
    assert os.read(reader, 99) == b"whole"
    os.close(reader)
    assert pipe.is_fifo()
    full = r"/dev/full cannot be written \(No space left on device\)"
    with pytest.raises(NotWritten, match=full), written_aside(Path("/dev/full")) as file:
        file.write("lost")


TO_OUTPUT = """
import pathlib, sys
from fem_adhesion.common.files import written_aside
for name in sys.argv[1:]:
    with written_aside(pathlib.Path(name)) as file:
        file.write("line\\n")
print("end")
"""


def test_standard_output_by_name_is_written_to_where_it_leads(tmp_path):
    """Links of our own to what /dev/stdout is a link to: that one, were it replaced, would be missed by others."""
    names = [str(tmp_path / "link"), str(tmp_path / "again")]
    for name in names:
        Path(name).symlink_to("/proc/self/fd/1")
    for out in ("file", subprocess.PIPE):
        with (tmp_path / "file").open("w") as file:
            command = [sys.executable, "-c", TO_OUTPUT, *names]
            done = subprocess.run(command, stdout=file if out == "file" else out, text=True, check=True)
        assert (done.stdout or (tmp_path / "file").read_text()) == "line\nline\nend\n"
    assert all(Path(name).is_symlink() for name in names)


STORING = """
import sys, time, pathlib
from fem_adhesion.common.files import open_store
place, name = pathlib.Path(sys.argv[1]), sys.argv[2]
store = open_store(place / "study", "code", resume=True)
(place / name).touch()
while not all((place / each).exists() for each in "ab"):
    time.sleep(0.001)
for number in range(100):
    store.put({"shared": number}, {"by": "either"})
    store.put({name: number}, {"by": name})
"""


def test_two_processes_that_store_at_once_lose_no_case(tmp_path):
    """Half of the cases are the same for both, the others their own."""
    processes = [subprocess.Popen([sys.executable, "-c", STORING, str(tmp_path), name]) for name in "ab"]
    assert [process.wait() for process in processes] == [0, 0]
    store = open_store(tmp_path / "study", "code", resume=True)
    for number in range(100):
        assert store.get({"shared": number}) == {"by": "either"}
        assert [store.get({name: number}) for name in "ab"] == [{"by": "a"}, {"by": "b"}]
    assert not store.notes
    assert len(list((tmp_path / "study" / "cases").iterdir())) == 300
