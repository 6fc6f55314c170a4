"""Forked workers: every result is reported as if there were none, and a worker that dies fails the run."""

from __future__ import annotations

import os
import subprocess
import sys
import xml.etree.ElementTree as ET
from pathlib import Path

import pytest

from tests.named import ROOT

pytestmark = pytest.mark.skipif(not hasattr(os, "fork"), reason="this system cannot fork")
TEN = """
import os
import warnings

import pytest

@pytest.fixture(scope="session")
def own(tmp_path_factory):
    yield tmp_path_factory.mktemp("own")
    print("the last test of a worker ends its fixtures")

@pytest.mark.parametrize("number", range(6))
def test_any(number, own, tmp_path, capfd):
    os.write(1, b"%d" % number)
    assert capfd.readouterr().out == str(number)
    assert tmp_path.parent == own.parent

def test_wrong():
    print("seen before it failed")
    assert 1 + 1 == 3

def test_left_out():
    pytest.skip("a reason")

def test_odd():
    warnings.warn("something odd", stacklevel=1)

@pytest.fixture
def broken():
    raise OSError("no set-up")

def test_not_set_up(broken):
    pass
"""


def run(folder: Path, text: str, *options: str) -> subprocess.CompletedProcess[str]:
    """Run pytest with forked workers on one file of tests."""
    (folder / "test_ten.py").write_text(text)
    words = [sys.executable, "-m", "pytest", "-p", "tests.forked_workers", "-p", "no:cacheprovider", *options]
    environment = os.environ | {"PYTHONPATH": str(ROOT), "PYTEST_ADDOPTS": ""}
    return subprocess.run(words, cwd=folder, env=environment, capture_output=True, text=True, check=False)


def results(folder: Path) -> dict[str, str]:
    """Return the result of each test in the JUnit report."""
    cases = ET.parse(folder / "report.xml").getroot().iter("testcase")
    return {case.attrib["name"]: case[0].tag if len(case) else "passed" for case in cases}


def test_results_texts_and_exit_status_are_those_of_one_process(tmp_path: Path) -> None:
    done = run(tmp_path, TEN, "--forked-workers", "3", "-rs", "--junitxml", "report.xml")
    assert done.returncode == pytest.ExitCode.TESTS_FAILED
    expected = {f"test_any[{number}]": "passed" for number in range(6)}
    expected |= {"test_wrong": "failure", "test_left_out": "skipped", "test_odd": "passed"}
    assert results(tmp_path) == expected | {"test_not_set_up": "error"}
    for text in ("assert (1 + 1) == 3", "seen before it failed", "a reason", "something odd", "no set-up"):
        assert text in done.stdout
    assert "1 failed, 7 passed, 1 skipped, 1 warning, 1 error" in done.stdout


def test_run_without_a_failure_succeeds(tmp_path: Path) -> None:
    done = run(tmp_path, TEN, "--forked-workers", "2", "-k", "any")
    assert done.returncode == pytest.ExitCode.OK, done.stdout
    assert "6 passed" in done.stdout


def test_first_failure_ends_the_run_if_asked_for(tmp_path: Path) -> None:
    text = "def test_wrong():\n    assert False\n" + "".join(
        f"def test_{n}():\n    pass\n" for n in range(40)
    )
    done = run(tmp_path, text, "--forked-workers", "1", "-x")
    assert done.returncode == pytest.ExitCode.TESTS_FAILED
    assert "stopping after 1 failures" in done.stdout
    assert "40 passed" not in done.stdout


def test_worker_that_dies_fails_the_run_and_its_test_is_named(tmp_path: Path) -> None:
    text = "import os\ndef test_dies():\n    os._exit(3)\ndef test_lost():\n    pass\n"
    done = run(tmp_path, text, "--forked-workers", "1")
    assert done.returncode == pytest.ExitCode.TESTS_FAILED
    assert "FAILED test_ten.py::test_dies - worker 0 died with exit status 3" in done.stdout
    assert "passed" not in done.stdout


def test_file_that_cannot_be_collected_fails_the_run_and_no_test_runs(tmp_path: Path) -> None:
    (tmp_path / "test_bad.py").write_text("import no_such_module\n")
    done = run(tmp_path, TEN, "--forked-workers", "2")
    assert done.returncode == pytest.ExitCode.INTERRUPTED
    assert "no_such_module" in done.stdout
    assert "passed" not in done.stdout


@pytest.mark.parametrize("number", ["-1", "0", "two"])
def test_invalid_number_of_workers_is_rejected(tmp_path: Path, number: str) -> None:
    done = run(tmp_path, TEN, "--forked-workers", number)
    assert done.returncode == pytest.ExitCode.USAGE_ERROR
    assert "--forked-workers" in done.stderr
