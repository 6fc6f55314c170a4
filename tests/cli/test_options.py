"""No option is ignored: each acts or is refused, before or behind the command, once and in full."""

from __future__ import annotations

import argparse
import json
from collections.abc import Iterator
from io import BytesIO, TextIOWrapper
from pathlib import Path

import pytest

from app.cli.command_parser import PRE_COMMAND_OPTIONS
from app.cli.main import build_parser, main
from core.message import CodedError, Message
from tests.cli.conftest import Turndesk
from tests.extras.modules import of_extras
from tests.texts import text as wording

PART = (
    "G90G94F300\nT1\nM03S1000\nX.5Z.1\n/G95F.004Z-.2\nM97I10C1P1\nM01(LOOK)\nG94F300Z1\nM30\n}1\nG04F2\nM99\n"
)
FAR = "[tool.1]\nx = 0.0\nz = -9.0\n"


@pytest.fixture
def part(tmp_path: Path) -> Path:
    path = tmp_path / "part.nc"
    path.write_text(PART)
    return path


@pytest.fixture
def far(tmp_path: Path) -> Path:
    path = tmp_path / "far.toml"
    path.write_text(FAR)
    return path


def parsers() -> Iterator[tuple[str, argparse.ArgumentParser]]:
    """Each command with each of its actions, such as ``offsets set``."""

    def below(name: str, parser: argparse.ArgumentParser) -> Iterator[tuple[str, argparse.ArgumentParser]]:
        actions = [each for each in parser._actions if isinstance(each, argparse._SubParsersAction)]
        if not actions:
            yield name, parser
        for each in actions:
            for word, sub in each.choices.items():
                yield from below(f"{name} {word}".strip(), sub)

    return below("", build_parser())


def options() -> list[tuple[str, str]]:
    return [
        (name, each.option_strings[-1])
        for name, parser in parsers()
        for each in parser._actions
        if each.option_strings and "--help" not in each.option_strings
    ]


# Each option of each command, and the test of this suite that sees what it does or what refuses it.
COVERED = {
    **{(command, option): "test_program_options_affect_the_proof"
       for command in ("prove", "expand", "trace", "run")
       for option in ("--machine", "--offsets", "--inputs", "--block-delete", "--strict", "--dialect",
                      "--optional-stop", "--json")},
    ("prove", "--ideal"): "test_program_options_affect_the_proof",
    ("prove", "--stick-out"): "test_stick_out_option_adds_the_chuck_to_the_proof",
    ("prove", "--tools"): "test_tools_given_in_a_file_are_not_reported_as_assumed",
    ("prove", "--keep-stock"): "test_stock_of_a_program_is_saved_in_the_store",
    ("prove", "--stock"): "test_stock_json_has_its_keys_in_cubic_inches",
    ("prove", "--jobs"): "test_files_given_twice_are_proved_once",
    ("prove", "--compare"): "tests/cli/test_compare.py",
    ("prove", "--report"): "tests/cli/test_report.py",
    ("prove", "--paper"): "tests/cli/test_report_pdf.py",
    ("prove", "--no-cache"): "test_no_cache_option_neither_stores_nor_reads_proofs",
    ("expand", "--ideal"): "test_program_options_affect_the_proof",
    ("trace", "--dt"): "tests/cli/test_trace.py",
    ("trace", "--out"): "tests/cli/test_trace.py",
    **{("run", option): "tests/cli/test_run_part.py"
       for option in ("--stock", "--tools", "--stick-out", "--keep-stock")},
    **{("report-bug", option): "tests/cli/test_report_bug.py" for option in ("--machine", "--out", "--yes")},
    ("run", "--anew"): "tests/cli/test_run.py",
    ("run", "--headless"): "tests/cli/test_run.py",
    ("run", "--realtime"): "tests/cli/test_run.py",
    ("offsets show", "--json"): "tests/cli/test_offsets.py",
    ("offsets history", "--json"): "tests/cli/test_offsets.py",
    ("offsets history", "--limit"): "tests/cli/test_offsets.py",
    ("offsets set", "--yes"): "tests/cli/test_offsets.py",
    ("offsets set", "--machine"): "tests/cli/test_offsets.py",
    ("store import", "--machine"): "tests/cli/test_offsets.py",
    ("store import", "--yes"): "tests/cli/test_offsets.py",
    ("offsets set", "--why"): "tests/cli/test_offsets.py",
    ("offsets clear", "--why"): "tests/cli/test_offsets.py",
    ("offsets undo", "--why"): "tests/cli/test_offsets.py",
    ("store verify", "--json"): "tests/cli/test_store.py",
    ("machine check", "--json"): "tests/cli/test_machine.py",
    ("machine hal", "--out"): "tests/cli/test_machine_hal.py",
    ("machine hal", "--json"): "tests/cli/test_machine_hal.py",
    ("alarms", "--json"): "tests/cli/test_alarms.py",
    ("scope", "--csv"): "tests/cli/test_scope.py",
    ("scope", "--json"): "tests/cli/test_scope.py",
    **{(f"serial {way}", option): "tests/drivers/transfer" for way in ("send", "receive")
       for option in ("--machine", "--port", "--baud", "--bits", "--parity", "--stop", "--flow", "--wrap",
                      "--dc-codes")},
    ("setup save", "--machine"): "tests/cli/test_setup.py",
    ("setup load", "--check"): "tests/cli/test_setup.py",
    ("setup desktop", "--autostart"): "tests/cli/test_setup.py",
    ("setup desktop", "--remove"): "tests/cli/test_setup.py",
    **{(command, "--as"): "tests/cli/test_access.py"
       for command in ("prove", "run", "offsets set", "offsets clear", "offsets undo", "store restore",
                       "store import", "setup load", "machine accept", "serial receive")},
    ("where", "--machine"): "tests/cli/test_where.py",
    ("where", "--json"): "tests/cli/test_where.py",
    ("serial receive", "--out"): "tests/drivers/transfer",
    ("serial send", "--eol"): "tests/drivers/transfer",
    ("serial send", "--wait"): "tests/drivers/transfer",
    ("serial send", "--leader"): "tests/drivers/transfer",
}  # fmt: skip
REST: dict[str, list[str]] = {}  # arguments that commands of optional features need
for each in of_extras("options"):
    COVERED |= each.COVERED
    REST |= getattr(each, "REST", {})


def test_every_option_of_every_command_is_in_the_table() -> None:
    assert sorted(options()) == sorted(COVERED)


@pytest.mark.parametrize("name", [name for name, _ in parsers()])
@pytest.mark.parametrize("option", PRE_COMMAND_OPTIONS)
def test_option_before_a_command_takes_effect_or_is_rejected(
    name: str,
    option: str,
    capsys: pytest.CaptureFixture[str],
    refusals: list[CodedError],
    tmp_path: Path,
) -> None:
    """With a file that is not there: whoever takes the option says so, everybody else refuses the option."""
    has = {each for command, each in options() if command == name}
    exported = tmp_path / "export"
    (exported / "programs").mkdir(parents=True)
    rest = {
        "store import": [str(exported)],
        "offsets set": ["T1", "x=1"],
        "offsets clear": ["D"],
        "machine peer": ["gt75-bench"],
        "setup completion": ["bash"],
        **REST,
    }
    bare = {
        "show",
        "history",
        "undo",
        "verify",
        "upgrade",
        "ports",
        "receive",
        "alarms",
        "desktop",
        "list",
        "clear",
        "table",
        "reset",
        "begin",
        "status",
        "publish",
        "where",
    }
    words = rest.get(name, [] if name.rpartition(" ")[2] in bare else [str(tmp_path / "part.nc")])
    (tmp_path / "part.nc").write_text(PART)
    headless = ["--headless"] if name == "run" else []
    status = main([f"--{option}", str(tmp_path / "missing"), *name.split(), *words, *headless])
    said = capsys.readouterr().err
    assert status == 2
    if f"--{option}" in has:
        assert "missing" in said
    else:
        (error,) = refusals
        assert error.code == "option-before-command"
        (message,) = error.args
        assert isinstance(message, Message)
        assert (message.values["name"], message.values["words"]) == (option, name)
        assert said.startswith(f"turndesk: --{option} ")


def test_machine_and_offsets_work_before_and_after_the_command(
    turndesk: Turndesk, part: Path, far: Path
) -> None:
    behind = turndesk("prove", part, "--offsets", far, "--json")
    before = turndesk("--offsets", far, "prove", part, "--json")
    assert behind.status == before.status == 1  # T1 nine inches out
    assert behind.lines == before.lines
    lathe = ("--machine", "sinumerik-linear")  # no input 10, no T offsets beyond its travel
    assert turndesk(*lathe, "prove", part, "--json").lines == turndesk("prove", part, *lathe, "--json").lines
    assert turndesk("prove", part, "--json").lines != turndesk("prove", part, *lathe, "--json").lines


OFFSETS_TWICE = wording("cli.option-twice", option="--offsets")
OFFSETS_AROUND = wording("cli.option-twice-around", name="offsets", command="prove")


@pytest.mark.parametrize(("words", "refusal"), [
    (["prove", "{part}", "--offsets", "{far}", "--offsets", "{far}"], OFFSETS_TWICE),
    (["--offsets", "{far}", "prove", "{part}", "--offsets", "{far}"], OFFSETS_AROUND),
    (["--offsets", "{far}", "--offsets", "{far}", "prove", "{part}"], OFFSETS_TWICE),
    (["trace", "{part}", "--dt", ".1", "--dt=.2"], wording("cli.option-twice", option="--dt")),
    (["expand", "{part}", "--machine", "gt75", "--machine", "gt75"],
     wording("cli.option-twice", option="--machine")),
    (["serial", "send", "{part}", "--baud", "9600", "--baud", "4800"],
     wording("cli.option-twice", option="--baud")),
    (["offsets", "set", "T1", "x=1", "--why", "a", "--why", "b"],
     wording("cli.option-twice", option="--why")),
])  # fmt: skip
def test_repeated_option_is_rejected(
    words: list[str], refusal: str, part: Path, far: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    try:
        status = main([word.format(part=part, far=far) for word in words])
    except SystemExit as ended:
        status = int(str(ended.code))
    assert status == 2
    assert refusal in capsys.readouterr().err


@pytest.mark.parametrize("words", [
    ["prove", "a.nc", "--off", "b"], ["--mach", "a"], ["run", "a.nc", "--head"],
    ["prove", "a.nc", "--block"], ["trace", "a.nc", "--o", "b"],
])  # fmt: skip
def test_abbreviated_option_is_rejected(words: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        main(words)
    assert ended.value.code == 2
    said = capsys.readouterr().err
    assert "unrecognized arguments" in said or "invalid choice" in said


def test_version_with_any_other_word_is_rejected(part: Path, refusals: list[CodedError]) -> None:
    assert main(["--version", "prove", str(part)]) == 2
    assert main(["--version", "--machine", "gt75"]) == 2
    assert [each.code for each in refusals] == ["version-alone"] * 2


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--version", "--json"], "--json is a command option"),
        (["--json"], "--json is a command option"),
        (["--json", "prove", "a.nc"], "--json is a command option"),
        (["offsets", "show", "--why", "x"], "this command has no option --why"),
    ],
)
def test_option_of_another_command_is_not_suggested_as_remedy(
    words: list[str], said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as ended:
        main(words)
    err = capsys.readouterr().err
    assert (ended.value.code, err.count("\n")) == (2, 1)
    assert said in err
    assert "did you mean" not in err


def test_program_options_affect_the_proof(
    turndesk: Turndesk, part: Path, offsets: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    on = tmp_path / "on.toml"
    on.write_text("[inputs]\n10 = true\n")
    given = (part, "--offsets", offsets, "--json")

    def figures(*more: object) -> tuple[float, int, int]:
        (report,) = turndesk("prove", *given, *more).lines
        return report["cycle_time_s"], report["elementary"], report["stops"]

    plain = figures()
    assert figures("--inputs", on)[0] == pytest.approx(plain[0] + 2.0, abs=0.1)
    assert figures("--block-delete")[1] == plain[1] - 1
    assert (plain[2], figures("--optional-stop")[2]) == (0, 1)
    assert figures("--ideal")[0] < plain[0]
    assert turndesk("prove", *given, "--strict").status == 0
    part.write_text(PART.replace("T1", "T01"))
    assert turndesk("prove", *given, "--strict").status == 1
    assert turndesk("prove", *given, "--dialect", "klartext").status == 1


@pytest.mark.parametrize("command", ["prove", "expand", "trace", "run"])
@pytest.mark.parametrize("option", ["--machine", "--offsets", "--inputs", "--block-delete", "--strict",
                                    "--dialect"])  # fmt: skip
def test_program_options_change_the_output_of_every_program_command(
    command: str, option: str, turndesk: Turndesk, part: Path, offsets: Path, far: Path, tmp_path: Path
) -> None:
    part.write_text(PART.replace("T1", "T01"))
    on = tmp_path / "on.toml"
    on.write_text("[inputs]\n10 = true\n")
    value = {"--machine": "ac-table-mill", "--offsets": far, "--inputs": on, "--dialect": "klartext"}.get(
        option
    )
    more = [option, value] if value else [option]
    given = [] if option == "--offsets" else ["--offsets", offsets]
    headless = ["--headless", "--json"] if command == "run" else []

    def told(*words: object) -> tuple[int, object, str]:
        ended = turndesk(command, part, *given, *words, *headless)
        shown = [{**line, "events": ""} for line in ended.lines] if headless else ended.out
        return ended.status, shown, ended.err

    assert told(*more) != told()


@pytest.mark.parametrize("command", ["prove", "expand", "trace"])
@pytest.mark.parametrize("option", ["--strict", "--inputs"])
def test_omniturn_option_is_rejected_for_other_languages(
    command: str, option: str, tmp_path: Path, refusals: list[CodedError]
) -> None:
    part, inputs = tmp_path / "a.mpf", tmp_path / "i.toml"
    part.write_text("N10 G90\nN20 M30\n")
    inputs.write_text("[inputs]\n10 = true\n")
    words = [option, str(inputs)] if option == "--inputs" else [option]
    assert main([command, str(part), *words]) == 2
    (error,) = refusals
    assert error.code == "omniturn-only"
    assert option in str(error)


def test_input_that_the_machine_does_not_have_is_rejected(
    part: Path, tmp_path: Path, refusals: list[CodedError]
) -> None:
    inputs = tmp_path / "i.toml"
    inputs.write_text("[inputs]\n99 = true\n")
    assert main(["prove", str(part), "--inputs", str(inputs)]) == 2
    (error,) = refusals
    assert error.code == "unknown-key"
    assert "99" in str(error)


def test_trace_in_json_needs_a_file_for_the_setpoints(
    turndesk: Turndesk, part: Path, offsets: Path, tmp_path: Path
) -> None:
    told = turndesk("trace", part, "--json")
    assert (told.status, told.code) == (2, "json-needs-file")
    told = turndesk("trace", part, "--offsets", offsets, "--out", tmp_path / "a.csv", "--json")
    (report,) = told.lines
    assert (told.status, report["out"]) == (0, str(tmp_path / "a.csv"))
    rows = (tmp_path / "a.csv").read_text().splitlines()
    assert report["cycle_time_s"] == pytest.approx(float(rows[-1].split(",")[0]), abs=0.001)


def test_run_accepts_json_with_headless(turndesk: Turndesk, part: Path, offsets: Path) -> None:
    told = turndesk("run", part, "--headless", "--json", "--offsets", offsets)
    assert json.loads(told.out.splitlines()[-1])["state"] == "complete"


@pytest.mark.parametrize("command", [
    ["prove", "{part}"], ["offsets", "show"], ["store", "verify"], ["alarms"],
    ["run", "{part}", "--headless"], ["machine", "check"],
])  # fmt: skip
@pytest.mark.parametrize("below", ["", "/deeper/still"])
def test_home_that_is_a_file_is_reported(
    command: list[str], below: str, part: Path, monkeypatch: pytest.MonkeyPatch,
    refusals: list[CodedError],
) -> None:  # fmt: skip
    monkeypatch.setenv("TURNDESK_HOME", f"{part}{below}")
    assert main([word.format(part=part) for word in command]) == 2
    (error,) = refusals
    assert error.code == "not-a-folder"
    assert "TURNDESK_HOME" in str(error)


@pytest.mark.parametrize("words", [["offsets", "show"], ["setup", "desktop"], ["store", "verify"]])
def test_user_without_a_home_folder_is_asked_to_name_one(
    words: list[str],
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    refusals: list[CodedError],
) -> None:
    def nowhere(*_: object, **__: object) -> Path:
        raise RuntimeError("Could not determine home directory.")

    for name in ("TURNDESK_HOME", "XDG_DATA_HOME", "XDG_CONFIG_HOME"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setattr("platformdirs.user_data_path", nowhere)
    monkeypatch.setattr("pathlib.Path.home", nowhere)
    assert main(words) == 2
    assert [each.code for each in refusals] == ["no-home"]
    assert capsys.readouterr().err.count("\n") == 1


@pytest.mark.parametrize(("words", "meant"), [
    (["prov", "a.nc"], "did you mean prove?"), (["offsets", "sho"], "did you mean show?"),
    (["prove", "a.nc", "--ofsets", "b"], "did you mean --offsets?"),
])  # fmt: skip
def test_misspelled_option_is_reported_with_a_suggestion(
    words: list[str], meant: str, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as ended:
        main(words)
    assert ended.value.code == 2
    assert meant in capsys.readouterr().err


def test_a_program_from_stdin_is_proved_as_from_a_file(
    turndesk: Turndesk, part: Path, offsets: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from_file = turndesk("prove", part, "--offsets", offsets, "--json").lines[0]
    monkeypatch.setattr("sys.stdin", TextIOWrapper(BytesIO(PART.encode())))
    (told,) = turndesk("prove", "-", "--offsets", offsets, "--json").lines
    assert told["cycle_time_s"] == from_file["cycle_time_s"]
    assert turndesk("prove", "-", part).status == 2
    monkeypatch.setattr("sys.stdin", TextIOWrapper(BytesIO(b"")))
    assert turndesk("prove", "-").status == 2  # nothing came


def test_help_has_no_none_where_a_text_is_missing(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as stopped:
        main(["help"])
    assert stopped.value.code == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[lines.index("commands:") + 1].split() == ["COMMAND"]
    assert [name for name, parser in parsers() if "None" in parser.format_help().split()] == []


@pytest.mark.parametrize("word", ["None", "no-such-command"])
def test_help_rejects_a_command_that_does_not_exist(word: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as stopped:
        main(["help", word])
    assert stopped.value.code == 2
    assert word in capsys.readouterr().err
