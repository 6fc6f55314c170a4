"""Artifacts of an earlier version, from which the checks upgrade.

As long as no earlier release exists, they are made of the new artifacts: the same code as version 0.0.0.
"""

from __future__ import annotations

import io
import re
import shutil
import tempfile
import zipfile
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

from app import VERSION
from resources.setup.artifact_checks.artifacts import Artifact, ArtifactKind, find_artifacts
from resources.setup.bundle import BundleError, run, write_bundle_file
from resources.setup.packages.reproducible_archives import write_tar_gz
from resources.setup.wheel_merge import write_wheel

EARLIER_VERSION = "0.0.0"
_VERSION_LINE = re.compile(rf'^(Version: |VERSION = "){re.escape(VERSION)}', re.MULTILINE)


def find_previous_artifact(artifact: Artifact, folder: Path) -> Path:
    """Return the artifact of the same kind for the same systems in the folder of the previous release.

    Raises BundleError if the folder has no such artifact.
    """
    for each in find_artifacts(folder):
        if (each.kind, each.releases) == (artifact.kind, artifact.releases):
            return each.path
    raise BundleError(f"{folder} contains no {artifact.kind} like {artifact.path.name}")


def make_earlier_artifact(artifact: Artifact, folder: Path) -> Path:
    """Write the artifact as version 0.0.0 to a folder, and return its path."""
    return _MAKERS[artifact.kind](artifact.path, folder)


def change_version(text: str) -> str:
    """Return a version or metadata file with version 0.0.0. Raises BundleError if it has another version."""
    changed, count = _VERSION_LINE.subn(rf"\g<1>{EARLIER_VERSION}", text)
    if not count:
        raise BundleError(f"a file does not state version {VERSION}: {text[:80]!r}")
    return changed


def _change_version_files(folder: Path) -> None:
    """Change the version in the files of the installed package ``turndesk`` below a folder."""
    [package] = folder.rglob("site-packages/turndesk/app/__init__.py")
    [metadata] = folder.rglob("site-packages/turndesk-*.dist-info/METADATA")
    for path in (package, metadata):
        path.write_text(change_version(path.read_text(encoding="utf-8")), encoding="utf-8")


def _make_debian_package(package: Path, folder: Path) -> Path:
    root = folder / "earlier"
    run("dpkg-deb", "--raw-extract", package, root)
    version = next((root / "opt" / "turndesk").iterdir())
    _change_version_files(version)
    version.rename(version.with_name(EARLIER_VERSION))
    command = root / "usr" / "bin" / "turndesk"
    command.unlink()
    command.symlink_to(f"/opt/turndesk/{EARLIER_VERSION}/bin/turndesk")
    for path in (root / "DEBIAN").iterdir():
        text = path.read_text(encoding="utf-8").replace(version.name, EARLIER_VERSION)
        path.write_text(
            re.sub(r"^Version: .*$", f"Version: {EARLIER_VERSION}", text, flags=re.MULTILINE),
            encoding="utf-8",
        )
    made = folder / f"turndesk_{EARLIER_VERSION}.deb"
    run("dpkg-deb", "--root-owner-group", "-Znone", "--build", root, made)
    shutil.rmtree(root)
    return made


def _make_bundle(bundle: Path, folder: Path) -> Path:
    with tempfile.TemporaryDirectory(dir=folder) as work:
        run("sh", bundle, "--unpack", work)
        [wheel] = Path(work).glob("turndesk-*.whl")
        _make_wheel(wheel, Path(work))
        wheel.unlink()
        (Path(work) / "VERSION").write_text(EARLIER_VERSION, encoding="utf-8")
        machine = bundle.stem.rpartition("-linux-")[2]
        made = folder / f"turndesk-{EARLIER_VERSION}-linux-{machine}.run"
        write_bundle_file(Path(work), made, machine)
    return made


def _make_folder(archive: Path, folder: Path) -> Path:
    with _unpack(archive, folder) as unpacked:
        _change_version_files(unpacked)
        return _pack(unpacked, folder / f"turndesk-{EARLIER_VERSION}-folder.tar.gz")


def _make_source_distribution(archive: Path, folder: Path) -> Path:
    with _unpack(archive, folder) as unpacked:
        for path in (unpacked / "app/__init__.py", unpacked / "PKG-INFO"):
            path.write_text(change_version(path.read_text(encoding="utf-8")), encoding="utf-8")
        return _pack(unpacked, folder / f"turndesk-{EARLIER_VERSION}.tar.gz")


@contextmanager
def _unpack(archive: Path, folder: Path) -> Iterator[Path]:
    """Yield the folder that is packed in an archive."""
    with tempfile.TemporaryDirectory(dir=folder) as work:
        run("tar", "--extract", "--file", archive, "--directory", work)
        yield next(Path(work).iterdir())


def _pack(unpacked: Path, target: Path) -> Path:
    write_tar_gz(unpacked, target, target.name.removesuffix(".tar.gz"))
    return target


def _make_wheel(wheel: Path, folder: Path) -> Path:
    with zipfile.ZipFile(io.BytesIO(wheel.read_bytes())) as archive:
        files = {_change_name(name): archive.read(name) for name in archive.namelist()}
    for name in ("turndesk/app/__init__.py", f"turndesk-{EARLIER_VERSION}.dist-info/METADATA"):
        files[name] = change_version(files[name].decode()).encode()
    made = folder / f"turndesk-{EARLIER_VERSION}-py3-none-any.whl"
    made.write_bytes(write_wheel(files))
    return made


def _change_name(name: str) -> str:
    return name.replace(f"turndesk-{VERSION}.dist-info/", f"turndesk-{EARLIER_VERSION}.dist-info/")


_MAKERS: Mapping[ArtifactKind, Callable[[Path, Path], Path]] = {
    ArtifactKind.DEBIAN_PACKAGE: _make_debian_package,
    ArtifactKind.BUNDLE: _make_bundle,
    ArtifactKind.FOLDER: _make_folder,
    ArtifactKind.WHEEL: _make_wheel,
    ArtifactKind.SOURCE_DISTRIBUTION: _make_source_distribution,
}
