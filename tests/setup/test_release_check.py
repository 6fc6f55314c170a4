"""Release check: which artifacts are tried where, what counts as lost, and what a removal may leave."""

from __future__ import annotations

import csv
import hashlib
import io
import sqlite3
import subprocess
import zipfile
from collections.abc import Callable, Iterator
from contextlib import closing, nullcontext
from pathlib import Path

import pytest

from app import VERSION
from core.store.store_file import STORE_FILE_NAME
from resources.setup import release_check
from resources.setup.artifact_checks import artifacts, earlier_artifact, minimal_root, store_data
from resources.setup.artifact_checks.artifacts import Artifact, ArtifactKind
from resources.setup.bundle import BundleError
from resources.setup.wheel_merge import merge_packages

STEM = "turndesk-0.1.0-20261201-1a2b3c4"
KINDS = {
    "turndesk_0.1.0~202612010830.1a2b3c4+debian12_amd64.deb": (ArtifactKind.DEBIAN_PACKAGE, ("bookworm",)),
    "turndesk_0.1.0+debian13_arm64.deb": (ArtifactKind.DEBIAN_PACKAGE, ("trixie",)),
    "turndesk_0.1.0+ubuntu24.04_amd64.deb": (ArtifactKind.DEBIAN_PACKAGE, ()),
    f"{STEM}-linux-x86_64.run": (ArtifactKind.BUNDLE, ("bookworm", "trixie")),
    f"{STEM}-linux-x86_64-python3.11.tar.gz": (ArtifactKind.FOLDER, ("bookworm",)),
    f"{STEM}-linux-x86_64-python3.12.tar.gz": (ArtifactKind.FOLDER, ()),
    "turndesk-0.1.0-py3-none-any.whl": (ArtifactKind.WHEEL, ("bookworm", "trixie")),
    "turndesk-0.1.0.tar.gz": (ArtifactKind.SOURCE_DISTRIBUTION, ("bookworm", "trixie")),
}
"""Kind and releases of files, by hand: Debian 12 has Python 3.11, Debian 13 has 3.13, neither has 3.12."""


@pytest.mark.parametrize("name", KINDS)
def test_artifact_is_checked_on_the_releases_for_which_it_is_made(name: str) -> None:
    found = artifacts.identify_artifact(Path("/release") / name)
    assert found is not None
    assert (found.kind, found.releases) == KINDS[name]


@pytest.mark.parametrize(
    "name", [f"{STEM}-documents.tar.gz", "SHA256SUMS", "sbom.cdx.json", "other-0.1.0.tar.gz", "turndesk.deb"]
)
def test_files_without_turndesk_are_not_installed(name: str) -> None:
    assert artifacts.identify_artifact(Path(name)) is None


def release_folder(folder: Path, names: list[str]) -> Path:
    lines = [f"{hashlib.sha256(b'x').hexdigest()}  {name}\n" for name in names]
    for name in names:
        (folder / name).write_bytes(b"x")
    (folder / "SHA256SUMS").write_text("".join(lines))
    return folder


def test_folder_of_a_release_has_all_its_artifacts(tmp_path: Path) -> None:
    found = artifacts.find_artifacts(release_folder(tmp_path, list(KINDS)))
    assert {each.path.name for each in found} == set(KINDS)


@pytest.mark.parametrize("kind", ArtifactKind)
def test_release_without_a_kind_of_artifact_is_rejected(kind: ArtifactKind, tmp_path: Path) -> None:
    names = [name for name, (each, _) in KINDS.items() if each is not kind]
    with pytest.raises(BundleError, match=f"no {kind}"):
        artifacts.find_artifacts(release_folder(tmp_path, names))


def test_file_that_differs_from_its_checksum_is_rejected(tmp_path: Path) -> None:
    folder = release_folder(tmp_path, list(KINDS))
    (folder / "turndesk-0.1.0.tar.gz").write_bytes(b"y")
    with pytest.raises(BundleError, match="sha256sum"):
        artifacts.find_artifacts(folder)


def test_file_that_is_no_artifact_is_rejected(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "x.zip").touch()
    assert release_check.main([str(tmp_path / "x.zip")]) == 1
    assert "x.zip is not an artifact" in capsys.readouterr().err


def test_first_part_may_take_exactly_five_minutes() -> None:
    assert "first part 300 s" in release_check.check_first_part_time(300.0)


def test_later_first_part_is_rejected() -> None:
    with pytest.raises(BundleError, match="first part after 301 s"):
        release_check.check_first_part_time(300.6)


def test_failure_of_an_artifact_does_not_end_the_check_of_the_others(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def check_artifact(artifact: Artifact, _root: Path, _files: object) -> Iterator[str]:
        yield "installed"
        if artifact.kind is ArtifactKind.BUNDLE:
            raise BundleError("no room")
        yield "removed"

    monkeypatch.setattr(release_check, "make_base_root", lambda _release, folder: folder)
    monkeypatch.setattr(release_check, "open_root_copy", nullcontext)
    monkeypatch.setattr(release_check, "_copy_artifacts", lambda *_: None)
    monkeypatch.setattr(release_check, "check_artifact", check_artifact)
    monkeypatch.setattr(release_check, "list_lintian_errors", lambda _package: [])
    folder = release_folder(tmp_path, list(KINDS))
    assert release_check.main([str(folder), "--release", "bookworm"]) == 1
    shown = capsys.readouterr()
    assert "bundle on bookworm FAILED: no room" in shown.out
    assert "wheel on bookworm: removed" in shown.out  # is checked after the bundle
    assert "ubuntu24.04_amd64.deb: not checked" in shown.out
    assert shown.err == "The check failed: bundle on bookworm\n"


@pytest.mark.parametrize(("status", "output"), [(0, ""), (2, "E: turndesk: bad-tag\nW: turndesk: other\n")])
def test_errors_of_lintian_are_listed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, status: int, output: str
) -> None:
    done = subprocess.CompletedProcess([], status, output, "")
    monkeypatch.setattr(subprocess, "run", lambda *_words, **_options: done)
    errors = ["E: turndesk: bad-tag"] if output else []
    assert release_check.list_lintian_errors(tmp_path / "a.deb") == errors


def test_failure_of_lintian_itself_is_reported(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    done = subprocess.CompletedProcess([], 1, "", "cannot read a.deb\n")
    monkeypatch.setattr(subprocess, "run", lambda *_words, **_options: done)
    with pytest.raises(BundleError, match=r"cannot read a\.deb"):
        release_check.list_lintian_errors(tmp_path / "a.deb")


# --- earlier artifact ------------------------------------------------------------------------------------

INFO = f"turndesk-{VERSION}.dist-info/"


def write_new_wheel(folder: Path, version: str) -> Path:
    made = io.BytesIO()
    with zipfile.ZipFile(made, "w") as archive:
        archive.writestr("app/__init__.py", f'VERSION = "{version}"\n')
        archive.writestr(f"{INFO}METADATA", f"Metadata-Version: 2.4\nName: turndesk\nVersion: {version}\n")
        archive.writestr(f"{INFO}RECORD", "")
    path = folder / f"turndesk-{version}-py3-none-any.whl"
    path.write_bytes(merge_packages(made.getvalue()))
    return path


def test_earlier_wheel_has_its_version_in_all_places(tmp_path: Path) -> None:
    new = Artifact(write_new_wheel(tmp_path, VERSION), ArtifactKind.WHEEL, ("bookworm",))
    earlier = earlier_artifact.make_earlier_artifact(new, tmp_path)
    assert earlier.name == "turndesk-0.0.0-py3-none-any.whl"
    with zipfile.ZipFile(earlier) as archive:
        names = archive.namelist()
        assert [name for name in names if VERSION in name] == []
        assert archive.read("turndesk/app/__init__.py") == b'VERSION = "0.0.0"\n'
        assert b"\nVersion: 0.0.0\n" in archive.read("turndesk-0.0.0.dist-info/METADATA")
        rows = csv.reader(archive.read("turndesk-0.0.0.dist-info/RECORD").decode().splitlines())
        assert sorted(row[0] for row in rows) == sorted(names)


def test_artifact_of_another_version_is_rejected(tmp_path: Path) -> None:
    with pytest.raises(BundleError, match="does not state version"):
        earlier_artifact.change_version('VERSION = "7.8.9"\n')


def test_previous_artifact_is_that_for_the_same_system(tmp_path: Path) -> None:
    folder = release_folder(tmp_path, list(KINDS))
    new = Artifact(Path("turndesk_0.2.0+debian13_amd64.deb"), ArtifactKind.DEBIAN_PACKAGE, ("trixie",))
    found = earlier_artifact.find_previous_artifact(new, folder)
    assert found.name == "turndesk_0.1.0+debian13_arm64.deb"
    with pytest.raises(BundleError, match="no Debian package like"):
        earlier_artifact.find_previous_artifact(new._replace(releases=("forky",)), folder)


# --- data before and after an upgrade --------------------------------------------------------------------

DATA = "CREATE TABLE t (a, b); INSERT INTO t VALUES (1, 'x'), (1, 'x'), (2, 'y'); CREATE TABLE u (c);"


def data_of(folder: Path, script: str) -> store_data.StoredData:
    folder.mkdir()
    (folder / "programs").mkdir()
    (folder / "programs" / "pin.nc").write_text("G90")
    (folder / "logs").mkdir()
    (folder / "logs" / "log").write_text(folder.name)
    with closing(sqlite3.connect(folder / STORE_FILE_NAME)) as connection:
        connection.executescript(script)
        connection.commit()
    return store_data.read_stored_data(folder)


@pytest.mark.parametrize(
    "change",
    [
        "INSERT INTO t VALUES (3, 'z')",
        "CREATE TABLE v (d)",
        "ALTER TABLE t ADD COLUMN e DEFAULT 5",
        "DROP TABLE u",  # it has no rows
    ],
)
def test_upgrade_that_only_adds_data_loses_nothing(change: str, tmp_path: Path) -> None:
    before = data_of(tmp_path / "before", DATA)
    assert store_data.list_losses(before, data_of(tmp_path / "after", f"{DATA};{change}")) == []
    assert (store_data.count_rows(before), len(before.files)) == (3, 1)


@pytest.mark.parametrize(
    ("change", "loss"),
    [
        ("UPDATE t SET b = 'z' WHERE a = 2", "table t, row {'a': 2, 'b': 'y'}"),
        ("DELETE FROM t WHERE rowid = 1", "table t, row {'a': 1, 'b': 'x'}"),
        ("ALTER TABLE t DROP COLUMN b", "table t, column b"),
        ("DROP TABLE t", "table t"),
    ],
)
def test_lost_rows_columns_and_tables_are_found(change: str, loss: str, tmp_path: Path) -> None:
    before = data_of(tmp_path / "before", DATA)
    after = data_of(tmp_path / "after", f"{DATA};{change}")
    assert store_data.list_losses(before, after) == [loss]
    with pytest.raises(BundleError, match="lost or changed"):
        release_check.check_losses(before, after)


def test_changed_program_is_a_loss(tmp_path: Path) -> None:
    before = data_of(tmp_path / "data", DATA)
    (tmp_path / "data" / "programs" / "pin.nc").write_text("G91")
    after = store_data.read_stored_data(tmp_path / "data")
    assert store_data.list_losses(before, after) == ["file programs/pin.nc"]


def test_data_folder_without_a_store_is_rejected(tmp_path: Path) -> None:
    with pytest.raises(BundleError, match="no store"):
        store_data.read_stored_data(tmp_path)


# --- root file system ------------------------------------------------------------------------------------


def test_minimal_root_uses_package_sources_of_its_own_release(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("platform.freedesktop_os_release", lambda: {"VERSION_CODENAME": "bookworm"})
    own, root = tmp_path / "own", tmp_path / "root"
    (own / "sources.list.d").mkdir(parents=True)
    root.mkdir()
    (root / "sources.list").write_text("deb http://a trixie main\n")  # of debootstrap
    (own / "sources.list.d" / "debian.sources").write_text("Suites: bookworm bookworm-updates\n")
    (own / "sources.list.d" / "other.sources").write_text("Suites: nodistro\n")
    minimal_root.copy_package_sources(own, root, "trixie")
    assert (root / "sources.list.d" / "debian.sources").read_text() == "Suites: trixie trixie-updates\n"
    assert [path.name for path in root.rglob("*") if path.is_file()] == ["debian.sources"]


@pytest.mark.parametrize(
    ("path", "is_compared"),
    [
        ("/etc/gshadow-", False),
        ("/var/lib/dpkg/status", False),
        ("/etc/gshadow", True),
        ("/etc/turndesk-", True),
        ("/opt/turndesk/0.1.0/bin/turndesk", True),
    ],
)
def test_purge_may_only_leave_files_of_the_system(
    path: str, is_compared: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(release_check, "run_in_root", lambda *_: f"{path}\n")
    assert (path in release_check.list_files(Path("/unused"))) is is_compared


@pytest.fixture
def certificate(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A file with certificates of this computer, which only one of the variables names."""
    path = tmp_path / "own.pem"
    path.write_text("certificate")
    for name in minimal_root._CERTIFICATE_VARIABLES:
        monkeypatch.setenv(name, str(tmp_path / "missing.pem"))
    monkeypatch.setenv("SSL_CERT_FILE", str(path))
    return path


def commands_in_root(root: Path, monkeypatch: pytest.MonkeyPatch, *, has_network: bool = True) -> list[str]:
    ran: list[str] = []

    def run(*words: object) -> str:
        ran.extend(map(str, words))
        return ""

    monkeypatch.setattr(minimal_root, "run", run)
    minimal_root.run_in_root(root, "pip --version", has_network=has_network)
    return ran


@pytest.mark.usefixtures("certificate")
def test_root_reaches_the_package_index_as_this_computer_does(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PIP_FIND_LINKS", "/only/on/this/computer")
    root = tmp_path / "root"
    minimal_root.copy_index_settings(root)
    words = commands_in_root(root, monkeypatch)
    [named] = {word.partition("=")[2] for word in words if word.startswith(("PIP_CERT=", "SSL_CERT_FILE="))}
    assert (root / named.lstrip("/")).read_text() == "certificate"
    assert named != "/etc/ssl/certs/ca-certificates.crt"  # the package ca-certificates writes this file
    assert not any("/only/on/this/computer" in word for word in words)


def test_root_without_own_certificates_uses_those_of_its_system(
    certificate: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    certificate.unlink()
    minimal_root.copy_index_settings(tmp_path / "root")
    assert not any("CERT" in word for word in commands_in_root(tmp_path / "root", monkeypatch))


def test_command_without_a_network_runs_in_its_own_network_namespace(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert commands_in_root(tmp_path, monkeypatch, has_network=False)[:2] == ["unshare", "--net"]
    assert "unshare" not in commands_in_root(tmp_path, monkeypatch)


@pytest.fixture
def root_with(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Callable[[str], Path]:
    """A root file system whose commands print stated files, and which has a data folder."""

    def make(files: str) -> Path:
        def run_in_root(_root: Path, command: str, **_: object) -> str:
            return files if command.startswith("find") else "none\n"

        monkeypatch.setattr(release_check, "run_in_root", run_in_root)
        (tmp_path / "root/.local/share/turndesk").mkdir(parents=True)
        return tmp_path

    return make


@pytest.mark.parametrize("kind", [ArtifactKind.DEBIAN_PACKAGE, ArtifactKind.BUNDLE])
def test_removal_may_leave_the_data_folder(kind: ArtifactKind, root_with: Callable[[str], Path]) -> None:
    root = root_with("/etc/x\n/root/.local/share/turndesk/turndesk.db\n/var/lib/dpkg/status\n")
    assert "only the data folder" in release_check.check_removal(root, {"/etc/x"}, kind)


@pytest.mark.parametrize(
    ("kind", "files", "reason"),
    [
        (ArtifactKind.DEBIAN_PACKAGE, "/etc/x\n/etc/y\n", "left: /etc/y"),
        (ArtifactKind.DEBIAN_PACKAGE, "/etc/x\n/root/.config/turndesk\n", "left: /root/.config/turndesk"),
        (ArtifactKind.DEBIAN_PACKAGE, "", "files of others: /etc/x"),
        (ArtifactKind.WHEEL, "/etc/x\n/root/.local/bin/turndesk\n", "left: /root/.local/bin/turndesk"),
    ],
)
def test_removal_that_leaves_or_removes_other_files_is_rejected(
    kind: ArtifactKind, files: str, reason: str, root_with: Callable[[str], Path]
) -> None:
    with pytest.raises(BundleError, match=reason):
        release_check.check_removal(root_with(files), {"/etc/x"}, kind)


def test_removal_that_deletes_the_data_folder_is_rejected(root_with: Callable[[str], Path]) -> None:
    root = root_with("/etc/x\n")
    (root / "root/.local/share/turndesk").rmdir()
    with pytest.raises(BundleError, match="deleted the data folder"):
        release_check.check_removal(root, {"/etc/x"}, ArtifactKind.FOLDER)


def test_purge_check_ignores_only_files_that_change_anyway() -> None:
    ignored = release_check._IGNORED
    assert [
        name
        for name in (
            "/root/.local/share/turndesk/turndesk.db",
            "/root/.cache/pip/wheels/x",
            "/var/cache/x",
            "/var/lib/dpkg/x",
            "/tmp/x",
        )
        if not ignored.match(name)
    ] == []
    kept = (
        "/opt/turndesk/x",
        "/etc/x",
        "/usr/x",
        "/var/lib/turndesk/x",
        "/rootkit",
        "/root/.config/turndesk",
    )
    assert [name for name in kept if ignored.match(name)] == []
