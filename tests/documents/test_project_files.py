"""Files that hosting services look for: they exist, are named by others, and the workflows need no secret."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import pytest

from app import VERSION
from tests.documents.pages import ROOT, Page

DOCUMENTS = (
    *("CHANGELOG.md", "CODE_OF_CONDUCT.md", "CONTRIBUTING.md", "README.md", "SECURITY.md", "SUPPORT.md"),
    *("CITATION.cff", "LICENSE"),
)
SETTINGS = ("pyproject.toml", "MANIFEST.in", "setup.cfg")
WORKFLOWS = sorted((ROOT / ".github" / "workflows").glob("*.yml"))
FORMS = sorted((ROOT / ".github" / "ISSUE_TEMPLATE").glob("*.yml"))
UNTRIED = {"windows.yml": "Windows", "macos.yml": "macOS"}
each_workflow = pytest.mark.parametrize("path", WORKFLOWS, ids=lambda path: path.name)


def mistakes_of_workflow(text: str) -> list[str]:
    """Return the kind of each deviation from the rules for workflows."""
    named = re.findall(r"\b(?:app|core|drivers|resources|tests)(?:/[\w.-]+)+", text)
    found = ["secret"] if re.search(r"\bsecrets\b|GITHUB_TOKEN|pull_request_target", text) else []
    found += [] if "permissions:\n  contents: read\n" in text else ["rights"]
    found += [] if text.count("runs-on:") == text.count("timeout-minutes:") else ["no-time-limit"]
    found += ["tab"] if "\t" in text else []
    return found + [f"missing:{name}" for name in named if not (ROOT / name).exists()]


@pytest.mark.parametrize("name", DOCUMENTS)
def test_project_document_exists_and_is_linked(name: str) -> None:
    assert (ROOT / name).read_text(encoding="utf-8").strip()
    named = {
        target for page in (ROOT / "README.md", ROOT / "docs" / "index.md") for _, target in Page(page).links
    }
    assert name == "README.md" or {name, f"../{name}"} & named


def test_the_top_level_has_only_documents_settings_and_dotfiles() -> None:
    command = ["git", "ls-files", "--cached", "--others", "--exclude-standard"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    if done.returncode:
        pytest.skip("this copy is not a clone")
    top = {line for line in done.stdout.splitlines() if "/" not in line and not line.startswith(".")}
    assert top - {*DOCUMENTS, *SETTINGS} == set()


@each_workflow
def test_workflow_has_read_only_permissions_and_existing_files(path: Path) -> None:
    assert mistakes_of_workflow(path.read_text(encoding="utf-8")) == []


@pytest.mark.parametrize("name", UNTRIED)
def test_untested_systems_are_marked_as_untried(name: str) -> None:
    text = (ROOT / ".github" / "workflows" / name).read_text(encoding="utf-8")
    assert "UNTRIED" in text
    assert UNTRIED[name] in (ROOT / "docs" / "integrator" / "install.md").read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("good", "bad", "kind"),
    [
        ("contents: read", "contents: write", "rights"),
        ("fetch-depth: 0", "token: ${{ secrets.KEY }}", "secret"),
        ("pull_request:", "pull_request_target:", "secret"),
        ("    timeout-minutes: 120\n", "", "no-time-limit"),
        ("tests/run.sh", "tests/runs.sh", "missing:tests/runs.sh"),
        ("    steps", "\tsteps", "tab"),
    ],
)
def test_wrong_workflow_is_detected(good: str, bad: str, kind: str) -> None:
    text = (ROOT / ".github" / "workflows" / "linux.yml").read_text(encoding="utf-8")
    assert good in text
    assert kind in mistakes_of_workflow(text.replace(good, bad, 1))


def test_each_issue_form_has_required_fields_and_unique_ids() -> None:
    forms = [path for path in FORMS if path.name != "config.yml"]
    assert [path.name for path in forms] == ["fault.yml", "hardware.yml", "wish.yml"]
    for path in forms:
        text = path.read_text(encoding="utf-8")
        ids = re.findall(r"^    id: (\w+)$", text, re.MULTILINE)
        assert len(ids) == len(set(ids)) >= 3
        assert text.count("required: true") >= 2


def test_citation_does_not_state_a_version() -> None:
    """A version here would be a second place to change."""
    text = (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    assert "cff-version: 1.2.0" in text
    assert VERSION not in text.replace("cff-version: 1.2.0", "")
    assert not re.search(r"^version:", text, re.MULTILINE)
