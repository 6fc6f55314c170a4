"""The set-up of a fresh machine (``environment.sh``): one true sentence for what is missing or damaged."""

from __future__ import annotations

import hashlib
import os
import subprocess
import sys
import zipfile
from importlib.metadata import version as metadata_version
from importlib.util import find_spec
from pathlib import Path

import pytest

from resources.setup.lock import SETUP_FOLDER

pytestmark = pytest.mark.skipif(os.name != "posix", reason="the set-up is a shell script")
needs_pip = pytest.mark.skipif(find_spec("pip") is None, reason="this environment was made without pip")
STUB = """#!/bin/sh
case $2 in *"sys.exit"*) exit {unsupported} ;; *ensurepip*) exit {bare} ;; *) echo {version} ;; esac
"""


def tell(script: str, **environment: str) -> subprocess.CompletedProcess[str]:
    """Sources environment.sh and runs a line behind it, as app/start.sh does."""
    return subprocess.run(
        ["/bin/sh", "-euc", f'. "{SETUP_FOLDER / "environment.sh"}"; {script}', "start.sh"],
        env={"PATH": os.environ["PATH"], "LC_ALL": "C", "ROOT": str(SETUP_FOLDER.parents[1])} | environment,
        capture_output=True,
        text=True,
        check=False,
    )


def executable(path: Path, text: str) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")
    path.chmod(0o755)
    return path


def python_named(folder: Path, name: str, version: str, *, supported: bool, bare: bool = False) -> None:
    """A stand-in for a Python of some version, with or without venv."""
    executable(folder / name, STUB.format(unsupported=int(not supported), bare=int(bare), version=version))


def fedora(folder: Path, *installed: str) -> str:
    """The PATH of a system with dnf and without apt-get, on which only the named packages are installed."""
    executable(folder / "dnf", "#!/bin/sh\nexit 1\n")
    names = "|".join(installed)
    executable(folder / "rpm", f"#!/bin/sh\ncase $2 in {names}) exit 0 ;; esac\nexit 1\n")
    return str(folder)


ON_FEDORA = "system_packages ca-certificates $QT_LIBRARIES $WINDOW_LIBRARIES $WAYLAND_LIBRARIES python3-venv"


def test_missing_packages_have_their_names_on_fedora(tmp_path: Path) -> None:
    told = tell(ON_FEDORA, PATH=fedora(tmp_path, "ca-certificates", "glib2"))
    assert (told.returncode, told.stdout) == (0, "")
    assert told.stderr == (
        "TurnDesk was not tested on Fedora. It needs these packages: sudo dnf install libglvnd-glx "
        "libglvnd-egl libxkbcommon dbus-libs fontconfig krb5-libs xcb-util-cursor libxkbcommon-x11 "
        "xcb-util-wm xcb-util-keysyms libxcb libXi libwayland-client libwayland-cursor libwayland-egl\n"
    )


def test_nothing_is_named_if_fedora_has_all_packages(tmp_path: Path) -> None:
    assert (
        tell("system_packages python3 libgl1", PATH=fedora(tmp_path, "python3", "libglvnd-glx")).stderr == ""
    )


def test_system_with_another_package_manager_is_referred_to_the_readme(tmp_path: Path) -> None:
    assert "see README" in tell("system_packages libgl1", PATH=str(tmp_path)).stderr


def test_every_package_of_the_setup_has_a_name_on_fedora() -> None:
    script = (
        "for name in $QT_LIBRARIES $WINDOW_LIBRARIES $WAYLAND_LIBRARIES; do fedora_name $name; done | wc -l"
    )
    assert int(tell(script).stdout) == 7 + 6 + 3


@pytest.mark.parametrize("version", ["3.10", "3.15"])
def test_unsupported_python_is_reported_in_one_sentence(tmp_path: Path, version: str) -> None:
    python_named(tmp_path, "python3", version, supported=False)
    told = tell("find_python", PATH=str(tmp_path))
    assert told.returncode == 2
    assert told.stderr == (
        f"TurnDesk needs Python 3.11, 3.12, 3.13 or 3.14; here is {version}. "
        "Install one of them, then start again.\n"
    )


def test_another_installed_python_is_used_if_supported(tmp_path: Path) -> None:
    python_named(tmp_path, "python3", "3.15", supported=False)
    python_named(tmp_path, "python3.13", "3.13", supported=True)
    assert tell('find_python; echo "$PYTHON"', PATH=str(tmp_path)).stdout == "python3.13\n"


def test_the_running_python_is_supported() -> None:
    assert tell(f'supported "{sys.executable}"').returncode == 0


def test_all_missing_packages_are_requested_at_once(tmp_path: Path) -> None:
    assert tell("python_packages", PATH=str(tmp_path)).stdout == "python3 python3-venv\n"
    python_named(tmp_path, "python3", "3.13", supported=True, bare=True)
    assert tell("python_packages", PATH=str(tmp_path)).stdout == "python3-venv\n"
    python_named(tmp_path, "python3", "3.13", supported=True)
    assert tell("python_packages", PATH=str(tmp_path)).stdout == ""


def test_user_without_install_rights_is_shown_what_to_ask_for(tmp_path: Path) -> None:
    executable(tmp_path / "id", "#!/bin/sh\n[ $1 = -u ] && echo 1000 || echo anna\n")
    executable(tmp_path / "dpkg-query", "#!/bin/sh\nexit 1\n")
    executable(tmp_path / "apt-get", "#!/bin/sh\nexit 100\n")
    executable(tmp_path / "sudo", "#!/bin/sh\nexit 1\n")
    told = tell("system_packages libegl1 python3", PATH=f"{tmp_path}:{os.environ['PATH']}")
    assert told.returncode == 2
    assert told.stderr == (
        "These packages are missing, and anna may not install them. "
        "Ask whoever looks after this computer for\n"
        "  apt-get install libegl1 python3\nas root; then start again.\n"
    )


def wheel_in(shop: Path, name: str, version: str, needs: str = "") -> Path:
    """An empty package in the folder of wheels, which may need another one."""
    wheel = shop / "wheels" / f"{name}-{version}-py3-none-any.whl"
    told = f"Metadata-Version: 2.1\nName: {name}\nVersion: {version}\n" + (
        f"Requires-Dist: {needs}\n" if needs else ""
    )
    with zipfile.ZipFile(wheel, "w") as archive:
        archive.writestr(f"{name}.py", "")
        archive.writestr(f"{name}-{version}.dist-info/METADATA", told)
        archive.writestr(f"{name}-{version}.dist-info/WHEEL", "Wheel-Version: 1.0\nRoot-Is-Purelib: true\n")
        archive.writestr(f"{name}-{version}.dist-info/RECORD", "")
    return wheel


def lock(shop: Path, *wheels: Path) -> None:
    """Locks these packages and no other."""
    lines = []
    for wheel in wheels:
        name, version, _ = wheel.name.split("-", 2)
        digest = hashlib.sha256(wheel.read_bytes()).hexdigest()
        lines += [f"{name}=={version} \\", f"    --hash=sha256:{digest}"]
    (shop / "resources/setup/locked-desk.txt").write_text("\n".join(lines) + "\n", encoding="utf-8")


@pytest.fixture
def shop(tmp_path: Path) -> Path:
    """A clone of a product that needs one package, its environment made, its packages in a folder."""
    (tmp_path / "wheels").mkdir()
    (tmp_path / "resources" / "setup").mkdir(parents=True)
    lock(tmp_path, wheel_in(tmp_path, "tiny", "1.0"))
    (tmp_path / "pyproject.toml").touch()
    (tmp_path / "setup.cfg").touch()
    version = f"{sys.version_info.major}.{sys.version_info.minor}"
    (tmp_path / ".venv" / "lib" / f"python{version}").mkdir(parents=True)
    # Only asked, never installed into: what is tried here is refused before.
    executable(tmp_path / ".venv" / "bin" / "python", f'#!/bin/sh\nexec "{sys.executable}" "$@" --dry-run\n')
    executable(tmp_path / ".venv" / "bin" / "pip", "#!/bin/sh\nexit 1\n")
    return tmp_path


def set_up(shop: Path, **environment: str) -> subprocess.CompletedProcess[str]:
    offline = {"PIP_NO_INDEX": "1", "PIP_FIND_LINKS": str(shop / "wheels"), "ROOT": str(shop)}
    return tell("python_environment desk", **offline | environment)


@needs_pip
def test_newer_release_of_locked_package_changes_nothing(shop: Path) -> None:
    """A package asks for another with an extra, and the index has a newer one of that without a hash here."""
    lock(shop, wheel_in(shop, "tiny", "1.0", "other[more]>=1"), wheel_in(shop, "other", "1.0"))
    wheel_in(shop, "other", "2.0")
    product = '[project]\nname = "turndesk"\nversion = "1"\n[tool.setuptools]\npy-modules = []\n'
    (shop / "pyproject.toml").write_text(product, encoding="utf-8")
    told = set_up(shop)
    assert told.returncode == 0, told.stderr
    assert (shop / ".venv" / ".turndesk-desk").exists()


@needs_pip
def test_modified_package_is_rejected(shop: Path) -> None:
    with zipfile.ZipFile(shop / "wheels" / "tiny-1.0-py3-none-any.whl", "a") as archive:
        archive.writestr("more.py", "import os")
    told = set_up(shop)
    assert told.returncode == 2
    assert "damaged on the way, or tampered with. It was not installed." in told.stderr
    assert "tiny" in told.stderr
    assert "Traceback" not in told.stderr
    assert not (shop / ".venv" / ".turndesk-desk").exists()


@needs_pip
def test_truncated_package_is_rejected(shop: Path) -> None:
    wheel = shop / "wheels" / "tiny-1.0-py3-none-any.whl"
    wheel.write_bytes(wheel.read_bytes()[:-9])
    assert "damaged on the way" in set_up(shop).stderr


@needs_pip
def test_unreachable_network_is_reported_as_such(shop: Path) -> None:
    # Port 9 of this computer: nobody is there.
    told = set_up(
        shop, PIP_NO_INDEX="0", PIP_INDEX_URL="http://127.0.0.1:9/", PIP_RETRIES="1", PIP_FIND_LINKS=""
    )
    assert told.returncode == 2
    assert "is there a network" in told.stderr
    assert "docs/integrator/install.md" in told.stderr


@needs_pip
def test_missing_package_for_this_computer_is_reported(shop: Path) -> None:
    (shop / "wheels" / "tiny-1.0-py3-none-any.whl").unlink()
    told = set_up(shop)
    assert told.returncode == 2
    assert "There are no Python packages for this computer (" in told.stderr


@pytest.mark.parametrize(
    ("pip_says", "sentence"),
    [
        ("OSError: [Errno 28] No space left on device", "No room left on the disk"),
        ("[Errno 13] Permission denied: '/x'", "may not write to"),
        ("[SSL: CERTIFICATE_VERIFY_FAILED] certificate is not yet valid", "is this computer's date right"),
        ("  x Failed to download\n  Hash mismatch for `tiny==1.0`", "tampered with"),
        ("error: something new", "pip says:\nerror: something new"),
    ],
)
def test_reported_cause_is_the_actual_cause(shop: Path, pip_says: str, sentence: str) -> None:
    python = shop / ".venv" / "bin" / "python"
    pip = f"#!/bin/sh\n[ $1 = -m ] && {{ printf '%s\\n' '{pip_says.replace(chr(39), '')}' >&2; exit 1; }}\n"
    executable(python, f'{pip}exec "{sys.executable}" "$@"\n')
    told = set_up(shop)
    assert told.returncode == 2
    assert sentence in told.stderr


def pip_that_says(shop: Path, words: str) -> None:
    python = shop / ".venv" / "bin" / "python"
    pip = f"#!/bin/sh\n[ $1 = -m ] && {{ printf '%s\\n' '{words}' >&2; exit 1; }}\n"
    executable(python, f'{pip}exec "{sys.executable}" "$@"\n')


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no full device here")
def test_full_disk_is_reported_even_if_no_log_can_be_written(shop: Path) -> None:
    pip_that_says(shop, "OSError: [Errno 28] No space left on device")
    (shop / ".venv" / ".turndesk-log").symlink_to("/dev/full")
    told = set_up(shop)
    assert told.returncode == 2
    assert "No room left on the disk" in told.stderr
    assert ".turndesk-log" not in told.stderr


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no full device here")
def test_disk_full_before_first_file_is_reported(tmp_path: Path) -> None:
    place = tmp_path / "env"
    executable(
        tmp_path / "bin" / "mkdir",
        f'#!/bin/sh\nmkdir=$(command -p -v mkdir)\n"$mkdir" "$@"\nln -s /dev/full {place}/.turndesk-place\n',
    )
    told = tell("new_environment", TURNDESK_VENV=str(place), PATH=f"{tmp_path / 'bin'}:{os.environ['PATH']}")
    assert told.returncode == 2
    assert "No room left on the disk" in told.stderr


def test_full_disk_is_reported_even_if_python_error_omits_it(shop: Path) -> None:
    pip_that_says(shop, "Error: ensurepip returned non-zero exit status 1")
    df = "#!/bin/sh\necho Filesystem\necho tmpfs 2048 2048 0 100% /x\n"
    executable(shop / "bin" / "df", df)
    told = set_up(shop, PATH=f"{shop / 'bin'}:{os.environ['PATH']}")
    assert "No room left on the disk" in told.stderr


def test_full_disk_during_system_package_install_is_reported(tmp_path: Path) -> None:
    executable(tmp_path / "dpkg-query", "#!/bin/sh\nexit 1\n")
    executable(tmp_path / "id", "#!/bin/sh\necho 0\n")
    executable(tmp_path / "apt-get", "#!/bin/sh\necho 'cannot copy: No space left on device'; exit 100\n")
    told = tell("system_packages libegl1", PATH=f"{tmp_path}:{os.environ['PATH']}")
    assert told.returncode == 2
    assert "Its disk is full" in told.stderr


def test_progress_is_shown_at_least_every_ten_seconds(tmp_path: Path) -> None:
    """Two signs of life; the command ends when the third is being waited for."""
    os.mkfifo(tmp_path / "end")
    executable(
        tmp_path / "sleep",
        f'#!/bin/sh\necho $1 >>"{tmp_path}/slept"\n'
        f'[ $(wc -l <"{tmp_path}/slept") -lt 3 ] && exit 0\n'
        f'echo over >"{tmp_path}/end"\nexec tail -f /dev/null\n',
    )
    told = tell(
        f'patiently "It works" sh -c "read word <{tmp_path}/end; echo \\$word"; echo "$said"',
        PATH=f"{tmp_path}:{os.environ['PATH']}",
    )
    assert (told.returncode, told.stdout) == (0, "over\n")
    assert told.stderr.count("It works: ") == 2
    assert all(int(seconds) <= 10 for seconds in (tmp_path / "slept").read_text().split())


def test_progress_output_ends_when_setup_is_terminated(tmp_path: Path) -> None:
    """The end of its output comes when nobody has it open any more."""
    executable(tmp_path / "sleep", "#!/bin/sh\nexit 0\n")
    script = f'. "{SETUP_FOLDER / "environment.sh"}"; patiently "It works" kill -9 "$$"'
    around = {"PATH": f"{tmp_path}:{os.environ['PATH']}", "ROOT": str(SETUP_FOLDER.parents[1])}
    with subprocess.Popen(["/bin/sh", "-euc", script], env=around, stderr=subprocess.PIPE) as told:
        assert told.wait(60) == -9
        assert told.stderr is not None
        told.stderr.read()


@pytest.mark.parametrize("status", [0, 3])
def test_output_and_exit_status_of_command_are_preserved(status: int) -> None:
    told = tell(
        f'patiently "It works" sh -c "echo out; echo err >&2; exit {status}" || echo "$?"; echo "$said"'
    )
    assert told.stdout == ("" if status == 0 else f"{status}\n") + "out\nerr\n"


def test_folder_name_that_looks_like_an_option_is_a_folder(tmp_path: Path) -> None:
    assert tell('echo "$PYTHON_ENV"', TURNDESK_VENV="-rf").stdout == "./-rf\n"


def test_environment_moved_from_another_location_is_recreated(shop: Path) -> None:
    place = shop / ".venv" / ".turndesk-place"
    place.write_text(f"{shop} {shop / '.venv'}", encoding="utf-8")
    assert tell("right_environment", ROOT=str(shop)).returncode == 0
    place.write_text("/home/old/turndesk /home/old/turndesk/.venv", encoding="utf-8")
    assert tell("right_environment", ROOT=str(shop)).returncode == 1


def test_environment_without_its_python_is_recreated(shop: Path) -> None:
    (shop / ".venv" / "bin" / "python").unlink()
    assert tell("right_environment", ROOT=str(shop)).returncode == 1


def test_folder_with_other_files_is_not_emptied(tmp_path: Path) -> None:
    (tmp_path / "letters").touch()
    told = tell("new_environment", TURNDESK_VENV=str(tmp_path))
    assert told.returncode == 2
    assert "is no Python environment of TurnDesk" in told.stderr
    assert (tmp_path / "letters").exists()


HEADER = "Iface\tDestination\tGateway\n"
LOOPBACK = f"{'0' * 32} 00 {'0' * 32} 00 {'0' * 32} ffffffff 00000001 00000000 00200200       lo\n"


def routes(folder: Path, version_4: str = "", version_6: str = LOOPBACK) -> str:
    """Writes the routes as Linux lists them."""
    folder.mkdir()
    (folder / "route").write_text(HEADER + version_4, encoding="utf-8")
    (folder / "ipv6_route").write_text(version_6, encoding="utf-8")
    return str(folder)


@pytest.mark.parametrize(
    ("version_4", "version_6", "found"),
    [
        ("", LOOPBACK, False),
        ("lo\t0000007F\t00000000\n", "", False),
        ("eth0\t00000000\t010200C0\n", LOOPBACK, True),
        ("", LOOPBACK.replace("lo\n", "eth0\n"), True),
    ],
)
def test_network_is_a_route_of_another_interface_than_loopback(
    tmp_path: Path, version_4: str, version_6: str, found: bool
) -> None:
    told = tell("has_network", ROUTES=routes(tmp_path / "net", version_4, version_6))
    assert (told.returncode == 0) is found


def test_proxy_counts_as_network(tmp_path: Path) -> None:
    told = tell("has_network", ROUTES=routes(tmp_path / "net"), https_proxy="http://127.0.0.1:3128")
    assert told.returncode == 0


def test_root_without_network_is_told_before_anything_is_tried(tmp_path: Path) -> None:
    executable(tmp_path / "dpkg-query", "#!/bin/sh\nexit 1\n")
    executable(tmp_path / "grep", "#!/bin/sh\nexit 1\n")  # no medium in the sources of apt
    executable(tmp_path / "id", "#!/bin/sh\necho 0\n")
    executable(tmp_path / "apt-get", f"#!/bin/sh\ntouch {tmp_path}/asked\n")
    path = f"{tmp_path}:{os.environ['PATH']}"
    told = tell("system_packages libegl1", PATH=path, ROUTES=routes(tmp_path / "net"))
    assert told.returncode == 2
    assert "This computer has no network" in told.stderr
    assert "must be downloaded: system packages libegl1." in told.stderr
    assert "docs/integrator/install.md" in told.stderr
    assert not (tmp_path / "asked").exists()


def set_up_offline(shop: Path) -> subprocess.CompletedProcess[str]:
    """Set up without a network and without a folder of wheels."""
    script = "has_own_wheels() { return 1; }; python_environment desk"
    return tell(script, ROOT=str(shop), ROUTES=routes(shop / "net"))


def test_no_python_environment_is_made_without_network(shop: Path) -> None:
    (shop / ".venv" / "bin" / "python").unlink()
    told = set_up_offline(shop)
    assert told.returncode == 2
    assert "must be downloaded: Python packages" in told.stderr
    assert "Making the Python environment" not in told.stderr


@needs_pip
def test_clone_updated_without_network_starts_if_the_packages_are_installed(shop: Path) -> None:
    """The stamp is that of another pyproject.toml; the locked package is pip itself, which is installed."""
    product = '[project]\nname = "turndesk"\nversion = "1"\n[tool.setuptools]\npy-modules = []\n'
    (shop / "pyproject.toml").write_text(product, encoding="utf-8")
    (shop / ".venv" / ".turndesk-desk").write_text("1 1\n", encoding="utf-8")
    locked = f"pip=={metadata_version('pip')} --hash=sha256:{'0' * 64}\n"
    (shop / "resources/setup/locked-desk.txt").write_text(locked, encoding="utf-8")
    told = set_up_offline(shop)
    assert told.returncode == 0, told.stderr
    assert "the Python packages are installed" in told.stderr
    assert (shop / ".venv" / ".turndesk-desk").read_text(encoding="utf-8") != "1 1\n"


@needs_pip
@pytest.mark.parametrize("package", ["tiny==1.0", "pip==0.1"], ids=["missing", "other version"])
def test_missing_package_is_reported_without_network(shop: Path, package: str) -> None:
    locked = f"{package} --hash=sha256:{'0' * 64}\n"
    (shop / "resources/setup/locked-desk.txt").write_text(locked, encoding="utf-8")
    told = set_up_offline(shop)
    assert told.returncode == 2
    assert "must be downloaded: Python packages" in told.stderr
    assert not (shop / ".venv" / ".turndesk-desk").exists()


def test_no_index_is_asked_without_network(shop: Path) -> None:
    """Without the option, pip tries again for about 40 s before it fails."""
    asked = shop / "asked"
    python = shop / ".venv" / "bin" / "python"
    asks = f'[ "$1" = -m ] && {{ echo "$@" >>"{asked}"; exit 1; }}\n'
    executable(python, f'#!/bin/sh\n{asks}exec "{sys.executable}" "$@"\n')
    assert set_up_offline(shop).returncode == 2
    (words,) = asked.read_text(encoding="utf-8").splitlines()
    assert "--no-index" in words.split()


@needs_pip
def test_folder_of_wheels_needs_no_network(shop: Path) -> None:
    told = set_up(shop, ROUTES=routes(shop / "net"))
    assert "no network" not in told.stderr


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no full device here")
def test_log_is_written_to_another_disk_if_its_own_is_full(shop: Path, tmp_path: Path) -> None:
    pip_that_says(shop, "OSError: [Errno 28] No space left on device")
    (shop / ".venv" / ".turndesk-log").symlink_to("/dev/full")
    (tmp_path / "other").mkdir()
    told = set_up(shop, TMPDIR=str(tmp_path / "other"))
    (log,) = (tmp_path / "other").glob("turndesk-log-*")
    assert f"All that it said is in {log}" in told.stderr
    assert "No space left on device" in log.read_text(encoding="utf-8")


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no full device here")
def test_last_lines_are_shown_if_no_disk_takes_the_log(shop: Path) -> None:
    pip_that_says(shop, "OSError: [Errno 28] No space left on device")
    (shop / ".venv" / ".turndesk-log").symlink_to("/dev/full")
    told = set_up(shop, TMPDIR=str(shop / "missing"))
    assert "No disk has room for a log. The last lines were:\nOSError: [Errno 28]" in told.stderr
    assert "All that it said" not in told.stderr


def test_full_disk_is_named_with_its_free_space(shop: Path) -> None:
    """By hand: 10 240 KiB are 10 MB, which is less than the 500 MB that are needed."""
    pip_that_says(shop, "OSError: [Errno 28] No space left on device")
    executable(
        shop / "bin" / "df",
        "#!/bin/sh\necho Filesystem\ncase $* in *.venv*) echo /dev/sdb1 1 1 10240 99% /data ;;"
        " *) echo /dev/sda1 1 1 9999999 1% / ;; esac\n",
    )
    told = set_up(shop, PATH=f"{shop / 'bin'}:{os.environ['PATH']}")
    assert f"  /data, with {shop / '.venv'}: 10 MB free\n" in told.stderr
    assert "sda1" not in told.stderr
    assert "  /, with" not in told.stderr


def test_untrusted_package_server_of_apt_is_reported(tmp_path: Path) -> None:
    executable(tmp_path / "dpkg-query", "#!/bin/sh\nexit 1\n")
    executable(tmp_path / "id", "#!/bin/sh\necho 0\n")
    executable(
        tmp_path / "apt-get",
        "#!/bin/sh\necho 'E: Failed to fetch https://x  Certificate verification failed'; exit 100\n",
    )
    told = tell("system_packages libegl1", PATH=f"{tmp_path}:{os.environ['PATH']}")
    assert told.returncode == 2
    assert "update-ca-certificates" in told.stderr
    assert "Is there a network" not in told.stderr


@pytest.mark.parametrize("name", ["REQUESTS_CA_BUNDLE", "CURL_CA_BUNDLE"])
def test_variable_that_overrides_the_certificate_of_pip_is_named(shop: Path, name: str) -> None:
    pip_that_says(shop, "[SSL: CERTIFICATE_VERIFY_FAILED] self-signed certificate")
    assert "pip prefers it to PIP_CERT" in set_up(shop, **{name: "/etc/ssl/certs/other.crt"}).stderr
    assert "pip prefers it to PIP_CERT" not in set_up(shop).stderr
