"""``turndesk report-bug``: what must never be in it, what must be, and that it is shown first."""

from __future__ import annotations

import io
import json
import stat
from pathlib import Path

import pytest

from app import VERSION
from app.cli.bug_report import bug_report
from app.cli.bug_report.private_texts import mask_machine_file, mask_program_texts, remove_scope_record_name
from app.cli.bug_report.replaced_names import PrivateValueReplacer
from core.message import Message
from core.store.store import Store
from core.store.user_records import UserRow
from tests.cli.conftest import Turndesk

MACHINE = """\
# Lathe of Hopkins & Sons, hall 3
[machine]
name = "Hopkins 1"  # bought from Quimby
units = "inch"
backend = "sim"
[io.in]
hold = { at = "n3.in5" }
[sharing]
postgresql = "host=db7 user=quimby password=s3cr3t"
folder = '/srv/hopkins/programs'
[announce]
broker = "broker7"
"""
PROGRAM = 'G90 (WOBURN FLANGE FOR ACME)\nT1 ; QUIMBY\nMSG("ACME")\nX1.25\n'
SECRETS = (
    *("ACME", "WOBURN", "Hopkins", "QUIMBY", "s3cr3t", "db7", "broker7", "CROFTON"),
    *("10.1.2.3", "fe80::1:2", "00:1A:2B:3C:4D:5E", "hopkins.example.com", "WIDGET", "lathe-seven"),
)


@pytest.fixture
def shop(home: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A data folder with names in every place from which the report reads; the current folder."""
    monkeypatch.setattr("socket.gethostname", lambda: "lathe-seven")
    monkeypatch.setattr("getpass.getuser", lambda: "crofton")
    monkeypatch.chdir(tmp_path)
    Path("hopkins.toml").write_text(MACHINE)
    Path("WIDGET 77.nc").write_text(PROGRAM)
    with Store.open(home) as store:
        store.settings.save_setting("machine in use", str(tmp_path / "hopkins.toml")).result(60)
        store.people.save_user(UserRow("QUIMBY", 3, b"", b"")).result(60)
        store.programs.save_version("WIDGET 77.nc", PROGRAM.encode(), "saved", author="Quimby").result(60)
        store.runs.record_run_start("WIDGET 77.nc").result(60)
        text = Message("{name} loaded by {who}, {count} blocks", name="WIDGET 77", who="QUIMBY", count=12)
        store.events.log_event("load", text).result(60)
        store.events.log_event("refused", "WIDGET 77 NOT FOUND").result(60)
    logs = home / "logs"
    logs.mkdir(exist_ok=True)
    (logs / "crash-20260101-000000.txt").write_text(
        f'2026-01-01 turndesk prove WIDGET 77.nc\nFile "{tmp_path}/app/cli/main.py", line 3, in main\n'
        "OSError: /home/crofton/ACME/part.nc: no route from 10.1.2.3:502 or fe80::1:2, 00:1A:2B:3C:4D:5E\n"
        "postgresql://quimby:s3cr3t@hopkins.example.com/db, mail quimby@hopkins.example.com\n"
    )
    (logs / "turndesk.log").write_text("ERROR Crofton on lathe-seven could not read widget 77\n")
    event = {"t": 1, "kind": "load", "text": "WIDGET 77.nc", "line": 0, "record": "ACME.scope"}
    (logs / "20260101T000000000000-WIDGET 77.jsonl").write_text(json.dumps(event) + "\n")
    return tmp_path


@pytest.mark.parametrize("named", [[], ["WIDGET 77.nc", "--machine", "hopkins.toml"]])
def test_bug_report_contains_no_private_values(named: list[str], shop: Path, turndesk: Turndesk) -> None:
    told = turndesk("report-bug", *named, "--yes")
    text = (shop / "turndesk-report.txt").read_text()
    assert told.status == 0
    assert [each for each in SECRETS if each.casefold() in text.casefold()] == []
    assert [each for each in ("srv", "home/", str(shop)) if each in text] == []


def test_bug_report_contains_the_details_that_explain_the_fault(shop: Path, turndesk: Turndesk) -> None:
    text = turndesk("report-bug", "--yes").out
    wanted = (
        *(f"turndesk {VERSION}", "Python 3.", 'backend = "sim"', "n3.in5", "X1.25", "…/app/cli/main.py"),
        *(
            'units = "inch"',
            "line 3, in main",
            "loaded by {who}, {count} blocks",
            "'count': 12",
            "no route from",
        ),
    )
    assert [each for each in wanted if each not in text] == []


@pytest.mark.parametrize(
    ("answer", "is_written"), [("y\n", True), ("yes\n", True), ("n\n", False), ("", False)]
)
def test_bug_report_is_shown_before_confirmation(
    answer: str, is_written: bool, shop: Path, turndesk: Turndesk, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("sys.stdin", io.StringIO(answer))
    told = turndesk("report-bug", "--out", "out.txt")
    assert told.status == 0
    assert told.out.index(f"turndesk {VERSION}") < told.out.index("[y/N]")
    assert Path("out.txt").exists() is is_written


def test_bug_report_file_is_private_and_matches_the_output(shop: Path, turndesk: Turndesk) -> None:
    told = turndesk("report-bug", "--yes", "--out", "out.txt")
    assert told.out == Path("out.txt").read_text() + "written: out.txt\n"
    assert stat.S_IMODE(Path("out.txt").stat().st_mode) == 0o600


def test_an_existing_file_is_not_replaced(shop: Path, turndesk: Turndesk) -> None:
    Path("out.txt").write_text("mine")
    told = turndesk("report-bug", "--yes", "--out", "out.txt")
    assert (told.status, told.code, told.out) == (2, "file-exists", "")
    assert Path("out.txt").read_text() == "mine"


@pytest.mark.parametrize("words", [["none.nc"], ["--machine", "none.toml"]])
def test_a_named_file_must_be_readable(words: list[str], shop: Path, turndesk: Turndesk) -> None:
    told = turndesk("report-bug", "--yes", *words)
    assert (told.status, told.code) == (2, "cannot-read")
    assert not Path("turndesk-report.txt").exists()


def test_missing_output_folder_is_an_error(shop: Path, turndesk: Turndesk) -> None:
    assert turndesk("report-bug", "--yes", "--out", "none/out.txt").code == "cannot-write"


def test_damaged_store_is_reported_without_ending_bug_report(
    home: Path, shop: Path, turndesk: Turndesk
) -> None:
    (home / "turndesk.db").write_bytes(b"rubbish" * 100)
    told = turndesk("report-bug", "--yes")
    assert told.status == 0
    assert "cannot be read: not-a-database" in told.out
    assert "QUIMBY" not in told.out.upper().replace("PERSON", "")


def test_a_new_installation_has_a_report(home: Path, tmp_path: Path, turndesk: Turndesk) -> None:
    told = turndesk("report-bug", "--yes", "--out", tmp_path / "out.txt")
    assert (told.status, "the shipped simulated lathe" in told.out) == (0, True)
    assert not home.exists()


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("C:\\Users\\jo\\a b.nc", "PATH-1"),
        ("see ~/private/x", "see PATH-1"),
        ("at 192.168.1.20:8080 now", "at ADDRESS-1 now"),
        ("2001:db8:0:1::5", "ADDRESS-1"),
        ("http://office.lan/x?y=1", "URL-1"),
        ("nas.local", "HOST-1"),
        ("password = x1", "password = SECRET"),
        ("flange9.nc and FLANGE9.NC", "FILE-1.nc and FILE-1.NC"),
    ],
)
def test_private_values_are_recognized_by_format(text: str, expected: str) -> None:
    replaced = PrivateValueReplacer()(text)
    assert replaced.startswith(expected)
    assert not any(
        each in replaced for each in ("jo", "private", "192", "2001", "office", "nas", "x1", "flange")
    )


@pytest.mark.parametrize(
    "text",
    [
        *(
            "G01X1.25Z-.5F.003",
            "alarm 204 at 10:15:30",
            "numpy 2.4.6",
            "/dev/ttyUSB0",
            "…/core/message.py:12",
        ),
        *("gt75.toml", "1e-05 mm/s", "Python 3.11.7", "X+0.0013 in/rev", "24/7", "PROGRAM-1.nc"),
    ],
)
def test_technical_values_are_not_replaced(text: str) -> None:
    assert PrivateValueReplacer(public=("gt75.toml",))(text) == text


def test_name_is_replaced_in_any_case_but_only_as_a_whole_word() -> None:
    replacements = PrivateValueReplacer(people=["Ann", "A"], programs=["PIN.nc"])
    assert replacements("ANN ran pin.nc; PIN is loaded, A, Annex, spinning") == (
        "PERSON-1 ran PROGRAM-1.nc; PROGRAM-1 is loaded, A, Annex, spinning"
    )


def test_shipped_programs_and_machines_are_public() -> None:
    assert {"bushing.nc", "gt75.toml"} <= bug_report._shipped_names()


@pytest.mark.parametrize(
    ("line", "hidden"),
    [
        ("G01 X1 (ACME) Z2", "G01 X1 (xxxx) Z2"),
        ("G01 X1 (ACME", "G01 X1 (xxxx"),
        ("X1 ; ACME 7", "X1 ; xxxx x"),
        ("0 BEGIN PGM ACME MM", "0 BEGIN PGM xxxx MM"),
        ("7 * - ACME FLANGE", "7 * - xxxx xxxxxx"),
        ("%_N_ACME_MPF", "%xxxxxxxxxxx"),
        ('MSG("ACME")', 'MSG(xxxx")'),
        ("Q1 = 3.5", "Q1 = 3.5"),
    ],
)
def test_program_comments_and_names_are_masked(line: str, hidden: str) -> None:
    found = mask_program_texts(line)
    assert "ACME" not in found
    assert found == hidden or '"' in line


@pytest.mark.parametrize(
    ("line", "expected"),
    [
        ('a = "x\\" y" # c', 'a = "TEXT-1"'),
        ("a = 'it is' ", 'a = "TEXT-1" '),
        ('a = "open', 'a = "TEXT'),
        ('port = "known"', 'port = "known"'),
        ("# only a comment", ""),
    ],
)
def test_machine_file_strings_are_masked(line: str, expected: str) -> None:
    assert mask_machine_file(line, {"known"}, PrivateValueReplacer()) == expected


def test_log_line_that_is_not_json_is_unchanged() -> None:
    assert remove_scope_record_name("{broken") == "{broken"
    assert remove_scope_record_name("[1]") == "[1]"
    assert json.loads(remove_scope_record_name('{"text": "READY", "record": "PIN.scope"}')) == {
        "text": "READY"
    }
