"""One contract for every place: what is published is whole or not there, and stays as it is."""

from __future__ import annotations

import errno
import os
import traceback
from collections.abc import Iterator
from pathlib import Path

import psycopg
import pytest

from core.extras.sharing.shared_database import SharedDatabase, parsed, with_tls
from core.extras.sharing.shared_place import Cause, Published, SharedPlace, SharingError
from core.extras.sharing.version_record import DeskState, new_version
from tests.extras.sharing.rigs import PostgresRig, PowerCut, Rig, rig_of

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
    assert ("TLS certificate not verified" in SharedDatabase(conninfo).name) is (mode == "prefer")


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
