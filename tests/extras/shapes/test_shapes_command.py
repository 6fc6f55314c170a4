"""``turndesk shapes FORM.toml``: the forms of the editor from a file; the page writes the same lines."""

from __future__ import annotations

from io import BytesIO, TextIOWrapper
from pathlib import Path

import pytest

from app.extras.shapes import shapes_command
from app.extras.shapes.shapes_command import _ABOUT
from tests.cli.conftest import Turndesk
from tests.cli.json_output import declared_alone, whole
from tests.extras.shapes.hand import Programmer

HEAD = '[[step]]\nkind = "head"\n'
TURN = '[[step]]\nkind = "turn"\n'
# By the keys that a programmer strikes at the page, and by the steps of a file.
ALIKE = {
    "points": (
        "n§t.5⏎z-.5⏎.7⏎z-1.1⏎1§",
        TURN + "points = [{x = 0, z = 0}, {x = .5}, {z = -.5}, {x = .7}, {z = -1.1}, {x = 1}]\n",
    ),
    "arc": (
        "n§t.4⏎z-.2⏎z-.5a.635⏎z-.7⏎.6§",
        TURN + "points = [{x = 0, z = 0}, {x = .4}, {z = -.2}, {z = -.5, a = .635}, {z = -.7}, {x = .6}]\n",
    ),
    "two": (
        "n§f.5⏎0§d.5⏎.3§",
        '[[step]]\nkind = "face"\nfrom = .5\nto = 0\n[[step]]\nkind = "drill"\ndia = .5\ndeep = .3\n',
    ),
}


@pytest.fixture
def form(tmp_path: Path) -> Path:
    path = tmp_path / "form.toml"
    path.write_text(HEAD + ALIKE["points"][1])
    return path


@pytest.mark.parametrize("name", ALIKE)
def test_form_file_writes_the_same_program_as_the_page(name: str, form: Path, turndesk: Turndesk) -> None:
    keys, steps = ALIKE[name]
    form.write_text(HEAD + steps)
    page = Programmer().strike(keys).close()
    (told,) = turndesk("shapes", form, "--json").lines
    assert told["program"] == page


def test_a_program_is_written_proved_and_never_replaced(form: Path, turndesk: Turndesk) -> None:
    out = form.with_name("part.nc")
    told = turndesk("shapes", form, "--out", out)
    assert (told.status, told.err) == (0, "")
    assert "steps: 2" in told.out
    assert turndesk("prove", out).status == 0
    again = turndesk("shapes", form, "--out", out)
    assert (again.status, again.code) == (2, "file-exists")


def test_file_extension_selects_sinumerik(form: Path, turndesk: Turndesk) -> None:
    out = form.with_name("part.mpf")
    assert turndesk("shapes", form, "--out", out).status == 0
    assert "DIAMON" in out.read_text()
    assert turndesk("shapes", form, "--out", form.with_name("part.h")).status == 2


def test_steps_come_from_stdin(form: Path, turndesk: Turndesk, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("sys.stdin", TextIOWrapper(BytesIO(form.read_bytes())))
    assert turndesk("shapes", "-").out == turndesk("shapes", form).out


def test_help_example_makes_roughing_passes(form: Path, turndesk: Turndesk) -> None:
    """From a bar of 1 in to .5 in: one pass of .25 in before, passes of .03 in now (no sheet: CCMT 0602)."""
    lines = [line for line in _ABOUT.splitlines() if line.startswith("  ")]
    form.write_text("\n".join(lines))
    told = turndesk("shapes", form)
    assert (told.status, told.err) == (0, "")
    assert "G75I.03U.01F.005" in told.out


@pytest.mark.parametrize(("rough", "code"), [("0", "invalid-step"), (".2", "invalid-step")])
def test_pass_beyond_the_insert_limit_is_rejected_once(
    rough: str, code: str, form: Path, turndesk: Turndesk
) -> None:
    lines = [line for line in _ABOUT.splitlines() if line.startswith("  ")]
    form.write_text("\n".join([*lines, f"rough = {rough}", ""]))
    told = turndesk("shapes", form)
    assert (told.status, told.code, told.err.count("\n"), told.out) == (2, code, 1, "")
    assert "step 3, turn: rough: " in told.err


def test_steps_after_a_bar_loop_become_its_part(form: Path, turndesk: Turndesk) -> None:
    form.write_text(HEAD + '[[step]]\nkind = "bar loop"\ncount = 5\nlong = 1.0\n' + ALIKE["points"][1])
    (told,) = turndesk("shapes", form, "--json").lines
    lines = told["program"].splitlines()
    assert lines.index("M30") < next(n for n, line in enumerate(lines) if "(TURN" in line)


@pytest.mark.parametrize(
    ("steps", "said"),
    [
        ('[[step]]\nkind = "face"\n', "step 1: a program must begin with a head"),
        (HEAD + '[[step]]\nkind = "fase"\n', "step 2: kind fase does not exist; did you mean face?"),
        (HEAD + "[[step]]\nt = 1\n", "step 2 has no kind"),
        (HEAD + '[[step]]\nkind = "face"\ntoo = 1\n', "step 2, face: too is unknown; did you mean to?"),
        (HEAD + '[[step]]\nkind = "face"\nto = true\n', "step 2, face: to must be a number or a word"),
        (HEAD + '[[step]]\nkind = "face"\nfeed = -1\n', "step 2, face: feed: "),
        (HEAD + '[[step]]\nkind = "drill"\ndia = "a"\n', "step 2, drill: dia: "),
        (
            '[[step]]\nkind = "head"\nunit = "ell"\n',
            "step 1, head: unit cannot be ell; use one of inch, metric",
        ),
        (
            HEAD + '[[step]]\nkind = "turn"\npoints = [{x = 1, y = 2}]\n',
            "step 2, turn: point 1: key y is unknown",
        ),
        (HEAD + '[[step]]\nkind = "turn"\npoints = 3\n', "step 2, turn: points must be a list"),
        ("[stpe]\n", "stpe is unknown; did you mean step?"),
        ("", "has no steps"),
        ("[[step]]\nkind = \n", "is not a valid TOML file"),
    ],
)
def test_invalid_step_is_reported_by_number_and_key(
    steps: str, said: str, form: Path, turndesk: Turndesk
) -> None:
    form.write_text(steps)
    told = turndesk("shapes", form, "--out", form.with_name("part.nc"))
    assert told.status == 2
    assert said in told.err
    assert told.err.count("\n") == 1
    assert str(form) in told.err
    assert not form.with_name("part.nc").exists()


def test_program_with_errors_is_written_and_reported(form: Path, turndesk: Turndesk) -> None:
    form.write_text(HEAD + '[[step]]\nkind = "drill"\ndia = .5\ndeep = 40\n')
    told = turndesk("shapes", form, "--out", form.with_name("part.nc"))
    assert told.status == 1
    assert "limit" in told.err


def test_the_list_has_every_kind_and_key(turndesk: Turndesk) -> None:
    told = turndesk("shapes", "--list").out
    assert "edge turn: " in told
    assert "edge_kind" in told
    assert "points" in told
    (found,) = turndesk("shapes", "--list", "--json").lines
    assert found["drill"] == ["t", "dia", "deep", "start", "peck", "feed", "rpm"]
    assert turndesk("shapes").status == 2


def test_the_json_has_the_declared_keys(turndesk: Turndesk, tmp_path: Path) -> None:
    path = tmp_path / "form.toml"
    path.write_text('[[step]]\nkind = "head"\n[[step]]\nkind = "face"\nfrom = .5\nto = 0\n')
    declared_alone([whole(turndesk("shapes", path, "--json"))], shapes_command.SHAPES_OUTPUT.keys)
    declared_alone([whole(turndesk("shapes", "--list", "--json"))], shapes_command.SHAPES_LIST_OUTPUT.keys)
