"""One contract for every place: what is published is whole or not there, and stays as it is."""

from __future__ import annotations

import errno
import os
import signal
import subprocess
import traceback
from collections.abc import Iterator
from pathlib import Path

import psycopg
import pytest

from core.sharing import shared_git
from core.sharing.connection_string import parsed, with_tls
from core.sharing.git_command import GitCommand
from core.sharing.shared_database import SharedDatabase
from core.sharing.shared_git import SharedGit
from core.sharing.shared_place import Published, SharedPlace
from core.sharing.sharing_errors import Cause, SharingError
from core.sharing.version_record import DeskState, new_version
from tests.sharing.rigs import GitRig, PostgresRig, PowerCut, Rig, rig_of

AT = "2026-01-02T03:04:05.678Z"
HOME = "0" * 31 + "1"


def published(number: int, program: str = "PART.NC") -> Published:
    text = b"G00 X%d\n" % number
    return Published(new_version(program, text, (), "LATHE 1", AT, "saved"), text)


def state(*versions: Published) -> DeskState:
    return DeskState(HOME, "LATHE 1", AT, {each.version.program: each.version.id for each in versions})


def cause_of(call: object, *args: object) -> tuple[Cause, str]:
    assert callable(call)
    with pytest.raises(SharingError) as raised:
        call(*args)
    assert "\n" not in str(raised.value)
    return raised.value.cause, str(raised.value)


def test_what_one_desk_publishes_another_finds_and_reads(rig: Rig) -> None:
    one, two = published(1), published(2, "ÄÖ 2.NC")
    rig.place(1).put([one, two], state(one, two))
    other = rig.place(2)
    found = other.look({})
    assert set(found.fresh) == {one.version, two.version}
    assert found.there == {one.version.id, two.version.id}
    assert found.desks == (state(one, two),)
    assert [other.text(each.version) for each in (one, two)] == [one.text, two.text]


def test_what_is_known_is_told_as_there_and_not_read_again(rig: Rig) -> None:
    one, two = published(1), published(2)
    place = rig.place()
    place.put([one], state(one))
    place.put([two], state(two))
    found = place.look({one.version.id: one.version})
    assert (found.fresh, found.there) == ((two.version,), {one.version.id, two.version.id})


def test_publishing_the_same_again_changes_nothing(rig: Rig) -> None:
    one = published(1)
    place = rig.place()
    place.put([one], state(one))
    place.put([one], state(one))
    found = place.look({})
    assert (found.fresh, found.strays, len(found.desks)) == ((one.version,), (), 1)


def test_a_desk_tells_another_state_in_the_place_of_its_own(rig: Rig) -> None:
    one, place = published(1), rig.place()
    place.put([one], state(one))
    other = DeskState("f" * 32, "LATHE 2", AT, {})
    rig.place(2).put([], other)
    place.put([], state())
    desks = {each.home: each for each in rig.place(2).look({}).desks}
    assert desks == {HOME: state(), "f" * 32: other}


def test_laying_out_again_leaves_all_as_it_is(rig: Rig) -> None:
    one = published(1)
    rig.place().put([one], state(one))
    rig.place(2).begin()
    assert rig.place().look({}).fresh == (one.version,)


def test_a_place_away_is_told_as_away_and_goes_on_when_it_is_back(rig: Rig) -> None:
    one, two, place = published(1), published(2), rig.place()
    place.put([one], state(one))
    rig.leave()
    asked = [cause_of(place.look, {}), cause_of(place.put, [two], state(two))]
    rig.come_back()
    assert [cause for cause, _ in asked] == [rig.away_cause] * 2
    place.put([two], state(two))
    assert {each.id for each in place.look({}).fresh} == {one.version.id, two.version.id}


def test_a_newer_layout_is_refused_and_left_alone(rig: Rig) -> None:
    one, place = published(1), rig.place()
    rig.make_newer()
    for cause, words in (
        cause_of(place.look, {}),
        cause_of(place.put, [one], state(one)),
        cause_of(place.begin),
    ):
        assert (cause, "newer TurnDesk (format 2)" in words) == (Cause.NEWER, True)


def test_garbage_is_named_and_hides_nothing(rig: Rig) -> None:
    one, place = published(1), rig.place()
    place.put([one], state(one))
    rig.litter()
    found = place.look({})
    assert (found.fresh, found.desks, len(found.strays)) == ((one.version,), (state(one),), 3)
    assert found.there == {one.version.id}


def test_cut_in_the_middle_of_publishing_each_version_is_whole_or_not_there(
    rig: Rig, monkeypatch: pytest.MonkeyPatch
) -> None:
    first, more = published(0), [published(number) for number in range(1, 6)]
    place = rig.place()
    place.put([first], state(first))
    with monkeypatch.context() as patch:
        rig.cut_in_put(patch)
        with pytest.raises((SharingError, PowerCut)):
            place.put(more, state(*more))
    rig.mend()
    there = rig.place(2).look({})
    assert first.version in there.fresh  # what was acknowledged
    assert (there.strays, there.desks) == ((), (state(first),))
    assert {each.id for each in there.fresh} <= {each.version.id for each in (first, *more)}
    rig.place().put(more, state(*more))
    after = rig.place(2).look({})
    assert {each.id for each in after.fresh} == {each.version.id for each in (first, *more)}
    assert after.desks == (state(*more),)
    assert [rig.place(2).text(each.version) for each in more] == [each.text for each in more]


def test_a_text_that_is_not_there_is_refused(rig: Rig) -> None:
    rig.place().put([], state())
    cause, words = cause_of(rig.place().text, published(7).version)
    assert cause in {Cause.DAMAGED, Cause.NOT_THERE}
    assert rig.place().name in words


def test_a_place_that_was_not_begun_says_how(rig: Rig) -> None:
    empty = _emptied(rig)
    cause, words = cause_of(empty.look, {})
    assert (cause, "turndesk share begin" in words) == (Cause.NOT_BEGUN, True)
    assert cause_of(empty.put, [published(1)], state())[0] is Cause.NOT_BEGUN
    empty.begin()
    assert empty.look({}).there == frozenset()


def _emptied(rig: Rig) -> SharedPlace:
    inside = rig.folder / "inside"
    inside.mkdir()
    if isinstance(rig, PostgresRig):
        rig.server.sql("DROP SCHEMA turndesk CASCADE", rig.database)
        return rig.place()
    return type(rig)(inside).place()


# --- of one kind only -----------------------------------------------------------------------------------


def test_two_desks_that_push_at_once_both_arrive(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    rig = GitRig(tmp_path)
    one, two = published(1), published(2)
    first, second = rig.place(1), rig.place(2)
    first.begin()
    push = SharedGit._push
    come = iter([lambda: second.put([two], DeskState("2" * 32, "LATHE 2", AT, {}))])

    def late(place: SharedGit) -> bool:
        if place is first and (other := next(come, None)) is not None:
            other()
        return push(place)

    monkeypatch.setattr(SharedGit, "_push", late)
    first.put([one], state(one))
    found = second.look({})
    assert (set(found.fresh), len(found.desks)) == ({one.version, two.version}, 2)


def test_a_branch_that_somebody_has_emptied_is_begun_anew_on_top(tmp_path: Path) -> None:
    """The sentence says so: turndesk share begin. What he has put there himself stays."""
    rig = GitRig(tmp_path)
    place, one = rig.place(), published(1)
    place.begin()
    place.put([one], state(one))
    blob = rig.git("hash-object", "-w", "--stdin", at=rig.remote, data=b"our notes").strip()
    tree = rig.git("mktree", at=rig.remote, data=b"100644 blob %s\tnotes.txt\n" % blob).strip().decode()
    emptied = rig.git("commit-tree", "-m", "emptied", tree, at=rig.remote).strip().decode()
    rig.git("update-ref", "refs/heads/turndesk", emptied, at=rig.remote)
    assert cause_of(place.look, {})[0] is Cause.NOT_BEGUN
    place.begin()
    assert place.look({}).there == frozenset()
    place.put([one], state(one))
    assert rig.place(2).look({}).fresh == (one.version,)
    assert rig.git("show", "turndesk:notes.txt", at=rig.remote) == b"our notes"


def test_a_remote_that_refuses_is_told_in_its_own_words(tmp_path: Path) -> None:
    rig = GitRig(tmp_path)
    place = rig.place()
    place.begin()
    rig.hook("echo only the office may push >&2; exit 1")
    cause, words = cause_of(place.put, [published(1)], state())
    assert (cause, "hook declined" in words) == (Cause.REFUSED, True)


@pytest.mark.parametrize(
    ("told", "cause"),
    [
        ("Host key verification failed.", Cause.UNKNOWN_HOST),
        (
            "@@@@\nHost key for [127.0.0.1]:22823 has changed and you have requested strict checking.",
            Cause.OTHER_HOST,
        ),
        ("root@shop: Permission denied (publickey,password).", Cause.NO_RIGHT),
        ("fatal: detected dubious ownership in repository at '/srv/shop.git'", Cause.NO_RIGHT),
        ("error: remote unpack failed: unable to create temporary object directory", Cause.NO_RIGHT),
        (
            "fatal: unable to access 'https://shop/x/': server certificate verification failed. CAfile: none",
            Cause.GIT_NOT_TRUSTED,
        ),
        ("fatal: Authentication failed for 'https://shop/x/'", Cause.NO_RIGHT),
        ("ssh -oBatchMode=yes: 1: ssh: not found", Cause.NO_SSH),
        ("error: cannot run ssh: No such file or directory", Cause.NO_SSH),
        ("sh: 1: git-upload-pack: not found", Cause.NO_GIT_THERE),
        ("fatal: protocol error: bad line length character: This", Cause.NO_GIT_THERE),
        ("ssh: connect to host shop port 4013: Connection refused", Cause.AWAY),
        ("fatal: unable to access 'https://shop/x/': The requested URL returned error: 403", Cause.NO_RIGHT),
        ("Connection timed out during banner exchange", Cause.AWAY),
    ],
)
def test_what_ssh_and_its_server_say_is_told_by_its_cause(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, told: str, cause: Cause
) -> None:
    """As OpenSSH 9.2 and git 2.39 said it against a server on this computer."""
    (tmp_path / "git").write_text(
        f'#!/bin/sh\ncat >&2 <<"END"\n{told}\nfatal: Could not read from remote repository.\nEND\nexit 128\n'
    )
    (tmp_path / "git").chmod(0o755)
    monkeypatch.setenv("PATH", str(tmp_path), prepend=os.pathsep)
    command = GitCommand(tmp_path / "copy.git", "the repository")
    found, words = cause_of(command.run, ["fetch"])
    assert (found, "@@" in words) == (cause, False)


def test_a_token_that_git_repeats_is_not_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    said = "fatal: unable to access 'https://me:secret@shop/x/': Could not resolve host: shop"
    (tmp_path / "git").write_text(f'#!/bin/sh\ncat >&2 <<"END"\n{said}\nEND\nexit 128\n')
    (tmp_path / "git").chmod(0o755)
    monkeypatch.setenv("PATH", str(tmp_path), prepend=os.pathsep)
    cause, words = cause_of(GitCommand(tmp_path / "copy.git", "the repository").run, ["fetch"])
    assert (cause, "https://shop/x/" in words) == (Cause.AWAY, True)


def test_a_file_longer_than_any_of_ours_is_a_stray_in_git(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, request: pytest.FixtureRequest
) -> None:
    with rig_of("git", tmp_path, request) as rig:
        place, one = rig.place(1), published(1)
        place.begin()
        place.put([one], state(one))
        monkeypatch.setattr(shared_git, "LONGEST", 100)
        assert rig.place(2).look({}).fresh == ()


def test_no_address_of_a_repository_can_be_an_option_of_git(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "git").write_text(f'#!/bin/sh\nprintf "%s\\n" "$@" >>{tmp_path}/said\n')
    (tmp_path / "git").chmod(0o755)
    monkeypatch.setenv("PATH", str(tmp_path), prepend=os.pathsep)
    place = SharedGit("--upload-pack=x", tmp_path / "copy.git")
    cause_of(place.look, {})
    place._push()
    words = (tmp_path / "said").read_text().splitlines()
    for own in ("--upload-pack=x", str(tmp_path / "copy.git")):
        assert {words[at - 1] for at, word in enumerate(words) if word == own} == {"--"}


def test_ctrl_c_ends_git_with_all_that_it_started(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "git").write_text("#!/bin/sh\nread nothing < /dev/zero\n")
    (tmp_path / "git").chmod(0o755)
    monkeypatch.setenv("PATH", str(tmp_path))
    started = list[subprocess.Popen[bytes]]()
    talk = subprocess.Popen.communicate

    def press(process: subprocess.Popen[bytes], *args: object, **words: object) -> object:
        if not started:
            started.append(process)
            raise KeyboardInterrupt
        return talk(process)

    monkeypatch.setattr(subprocess.Popen, "communicate", press)
    with pytest.raises(KeyboardInterrupt):
        GitCommand(tmp_path / "copy.git", "the repository").run(["fetch"])
    assert started[0].returncode == -signal.SIGKILL


def test_git_that_is_not_there_or_does_not_answer(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    place = GitRig(tmp_path).place()
    stuck = tmp_path / "bin"
    stuck.mkdir()
    monkeypatch.setenv("PATH", str(stuck))
    assert cause_of(place.begin)[0] is Cause.NO_GIT
    (stuck / "git").write_text("#!/bin/sh\nread nothing < /dev/zero\n")
    (stuck / "git").chmod(0o755)
    command = GitCommand(tmp_path / "copy.git", "the repository", patience=0.01)
    cause, words = cause_of(command.run, ["fetch"])
    assert (cause, "no response for 0.01 s" in words) == (Cause.AWAY, True)


def test_a_damaged_copy_of_the_repository_is_made_again(tmp_path: Path) -> None:
    rig = GitRig(tmp_path)
    one, place = published(1), rig.place()
    place.begin()
    place.put([one], state(one))
    (tmp_path / "copy-1.git" / "config").write_text("[core")
    for each in (tmp_path / "copy-1.git" / "objects").rglob("*.pack"):
        each.chmod(0o644)
        each.write_bytes(b"PACK")
    assert place.look({}).fresh == (one.version,)


@pytest.mark.parametrize(
    ("number", "cause"),
    [
        (errno.ENOSPC, Cause.FULL),
        (errno.EDQUOT, Cause.FULL),
        (errno.EROFS, Cause.NO_RIGHT),
        (errno.EACCES, Cause.NO_RIGHT),
        (errno.EHOSTDOWN, Cause.AWAY),
        (errno.ESTALE, Cause.AWAY),
    ],
)
def test_what_the_system_refuses_is_told_by_its_cause(
    folder_rig: Rig, monkeypatch: pytest.MonkeyPatch, number: int, cause: Cause
) -> None:
    def refused(_file: int) -> None:
        raise OSError(number, os.strerror(number))

    place = folder_rig.place()
    with monkeypatch.context() as patch:
        patch.setattr(os, "fsync", refused)
        assert cause_of(place.put, [published(1)], state())[0] is cause
    assert place.look({}).there == frozenset()
    place.put([published(1)], state())
    assert place.look({}).strays == ()


def test_a_version_that_was_cut_off_on_the_disk_is_no_version_and_comes_again(folder_rig: Rig) -> None:
    one, place = published(1), folder_rig.place()
    place.put([one], state(one))
    (file,) = (folder_rig.folder / "shop" / "versions").iterdir()
    file.write_bytes(file.read_bytes()[:-3])
    assert place.look({one.version.id: one.version}).there == frozenset()
    assert place.look({}).strays == (file.name,)
    assert cause_of(place.text, one.version)[0] is Cause.DAMAGED
    place.put([one], state(one))
    assert place.text(one.version) == one.text
    assert place.look({}).strays == (f"{file.name}.damaged",)  # what was there is not lost either


@pytest.mark.parametrize("text", ["", "[]", '{"format": "1"}', "[" * 100_000])
def test_a_mark_that_is_none_of_ours_is_refused(folder_rig: Rig, text: str) -> None:
    (folder_rig.folder / "shop" / "turndesk-share.json").write_text(text)
    assert cause_of(folder_rig.place().look, {})[0] is Cause.OTHER


@pytest.fixture
def database(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[PostgresRig]:
    with rig_of("postgresql", tmp_path, request) as made:
        assert isinstance(made, PostgresRig)
        made.place().begin()
        yield made


def test_a_user_without_rights_is_told_so(database: PostgresRig) -> None:
    database.server.sql("CREATE ROLE visitor LOGIN", database.database)
    try:
        visitor = SharedDatabase(database.server.conninfo(database.database, "visitor"))
        assert cause_of(visitor.look, {})[0] is Cause.NO_RIGHT
        assert cause_of(SharedDatabase(database.server.conninfo("nowhere")).look, {})[0] is Cause.NOT_THERE
        stranger = SharedDatabase(database.server.conninfo(database.database, "stranger"))
        assert cause_of(stranger.look, {})[0] in {Cause.NO_RIGHT, Cause.NOT_THERE}
        database.server.sql(
            "GRANT USAGE ON SCHEMA turndesk TO visitor;"
            "GRANT SELECT ON ALL TABLES IN SCHEMA turndesk TO visitor",
            database.database,
        )
        assert visitor.look({}).there == frozenset()
        assert cause_of(visitor.put, [published(1)], state())[0] is Cause.NO_RIGHT
    finally:
        database.server.sql("DROP OWNED BY visitor; DROP ROLE visitor", database.database)


def test_tables_of_somebody_else_are_refused(database: PostgresRig) -> None:
    database.server.sql("ALTER TABLE turndesk.versions RENAME COLUMN record TO recipe", database.database)
    one = published(1)
    database.server.sql(
        f"INSERT INTO turndesk.versions VALUES ('{one.version.id}', 'x', 'x')", database.database
    )
    assert cause_of(database.place().look, {})[0] is Cause.OTHER


def test_without_psycopg_one_sentence_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("importlib.util.find_spec", lambda _name: None)
    cause, words = cause_of(SharedDatabase("host=shop-pc password=secret dbname=shop").look, {})
    assert (cause, "turndesk[postgresql]" in words) == (Cause.NO_PSYCOPG, True)


@pytest.mark.parametrize(
    "conninfo",
    [
        "host=h password=secret dbname=d",
        "host=h password = secret dbname=d",
        "host=h password = 'top secret' dbname=d",
        "host=h sslpassword= secret dbname=d",
        "postgresql://lathe:secret@h:5432/d?sslpassword=secret",
        "postgresql://lathe@h/d?password=secret",
        "postgresql://lathe:se/cret@h/d",
        "host=h password=top secret dbname=d",
        "host=h passwort=secret",
        "host=h port=secret",
    ],
)
def test_no_password_stands_in_a_sentence_or_a_crash_file(
    conninfo: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    def away(**_values: object) -> None:
        raise psycopg.OperationalError("no answer")

    monkeypatch.setattr(psycopg, "connect", away)
    place = SharedDatabase(conninfo)
    with pytest.raises(SharingError) as refused:
        place.look({})
    assert "cret" not in place.name + "".join(traceback.format_exception(refused.value))


def test_a_database_is_named_by_what_libpq_reads() -> None:
    name = SharedDatabase("postgresql://lathe:secret@127.0.0.1:5432/d").name
    assert name == "the database user=lathe host=127.0.0.1 port=5432 dbname=d"


@pytest.mark.parametrize("conninfo", ["host=h passwort=x", "host=h port=x", "postgresql://a:b/c@h/d"])
def test_what_libpq_cannot_read_is_told_as_such(conninfo: str) -> None:
    assert cause_of(SharedDatabase(conninfo).look, {})[0] is Cause.UNREADABLE


@pytest.mark.parametrize(
    ("conninfo", "mode"),
    [
        ("host=shop-pc", "verify-full"),
        ("hostaddr=10.0.0.7 host=localhost", "verify-full"),
        ("host=localhost,shop-pc", "verify-full"),
        ("service=shop", "verify-full"),
        ("host=shop-pc sslmode=prefer", "prefer"),
        ("host=localhost", None),
        ("host=/run/postgresql", None),
        ("host=127.0.0.1,::1", None),
        ("dbname=d", None),
    ],
)
def test_a_server_elsewhere_has_to_prove_who_it_is(
    conninfo: str, mode: str | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in ("PGHOST", "PGSSLMODE", "PGSSLROOTCERT"):
        monkeypatch.delenv(name, raising=False)
    values = with_tls(parsed(conninfo))
    assert values.get("sslmode") == mode
    assert ("sslrootcert" in values) is (mode == "verify-full")
    assert ("TLS not verified" in SharedDatabase(conninfo).name) is (mode == "prefer")


_AT = 'connection failed: connection to server at "10.0.0.7", port 5432 failed: '


@pytest.mark.parametrize(
    ("said", "cause", "why"),
    [
        (
            f'{_AT}FATAL:  password authentication failed for user "u"\n{_AT}FATAL:  no pg_hba.conf entry '
            'for host "10.0.0.7", user "u", database "d", no encryption',
            Cause.WRONG_PASSWORD,
            "password authentication failed",
        ),
        (f"{_AT}fe_sendauth: no password supplied", Cause.WRONG_PASSWORD, "no password supplied"),
        (f"{_AT}SSL error: certificate verify failed", Cause.NOT_TRUSTED, "certificate verify failed"),
        (
            f'{_AT}server certificate for "shop-pc" does not match host name "10.0.0.7"',
            Cause.NOT_TRUSTED,
            "does not match",
        ),
        (f'{_AT}root certificate file "/a" does not exist\nEither', Cause.NOT_TRUSTED, "/a"),
        (f"{_AT}server does not support SSL, but SSL was required", Cause.NO_TLS, "does not support"),
        (
            f'{_AT}FATAL:  no pg_hba.conf entry for host "10.0.0.7", user "u", database "d", no encryption',
            Cause.TLS_ONLY,
            "no encryption",
        ),
        (
            f'{_AT}FATAL:  no pg_hba.conf entry for host "10.0.0.7", user "u", database "d", SSL encryption',
            Cause.NO_RIGHT,
            "no pg_hba.conf entry",
        ),
        (f'{_AT}FATAL:  database "d" does not exist', Cause.NOT_THERE, "does not exist"),
        (f"{_AT}Connection refused\n\tIs the server running?", Cause.AWAY, "Connection refused"),
    ],
)
def test_what_a_server_says_at_the_door_has_its_cause(
    said: str, cause: Cause, why: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As libpq 17 and a server of version 15 have said it."""

    def refuses(**_values: object) -> None:
        raise psycopg.OperationalError(said)

    monkeypatch.setattr(psycopg, "connect", refuses)
    found, words = cause_of(SharedDatabase("host=10.0.0.7 dbname=d").look, {})
    assert (found, why in words) == (cause, True)


def test_nor_does_that_of_a_repository(tmp_path: Path) -> None:
    name = SharedGit("https://lathe:secret@shop-pc/programs.git", tmp_path).name
    assert name == "the git repository https://shop-pc/programs.git"
    assert (
        SharedGit("git@shop-pc:programs.git", tmp_path).name == "the git repository git@shop-pc:programs.git"
    )
