"""One contract for every place: what is published is whole or not there, and stays as it is."""

from __future__ import annotations

import errno
import os
import traceback
from collections.abc import Iterator
from pathlib import Path

import psycopg
import pytest

from core.extras.sharing.shared_database import SharedDatabase, parse_conninfo, require_tls
from core.extras.sharing.shared_location import (
    PublishedVersion,
    SharedLocation,
    SharingError,
    SharingErrorCause,
)
from core.extras.sharing.version_record import PublishedMachineState, make_version
from tests.extras.sharing.rigs import PostgresRig, PowerCut, Rig, rig_of

AT = "2026-01-02T03:04:05.678Z"
HOME = "0" * 31 + "1"


def published(number: int, program: str = "PART.NC") -> PublishedVersion:
    text = b"G00 X%d\n" % number
    return PublishedVersion(make_version(program, text, (), "LATHE 1", AT, "saved"), text)


def state(*versions: PublishedVersion) -> PublishedMachineState:
    return PublishedMachineState(
        HOME, "LATHE 1", AT, {each.version.program: each.version.id for each in versions}
    )


def cause_of(call: object, *args: object) -> tuple[SharingErrorCause, str]:
    assert callable(call)
    with pytest.raises(SharingError) as raised:
        call(*args)
    assert "\n" not in str(raised.value)
    return raised.value.cause, str(raised.value)


def test_version_published_by_one_machine_is_read_by_another(rig: Rig) -> None:
    one, two = published(1), published(2, "ÄÖ 2.NC")
    rig.place(1).publish_versions([one, two], state(one, two))
    other = rig.place(2)
    found = other.read_contents({})
    assert set(found.unknown_versions) == {one.version, two.version}
    assert found.stored_ids == {one.version.id, two.version.id}
    assert found.machine_states == (state(one, two),)
    assert [other.read_text(each.version) for each in (one, two)] == [one.program_text, two.program_text]


def test_known_version_is_listed_but_not_read_again(rig: Rig) -> None:
    one, two = published(1), published(2)
    place = rig.place()
    place.publish_versions([one], state(one))
    place.publish_versions([two], state(two))
    found = place.read_contents({one.version.id: one.version})
    assert (found.unknown_versions, found.stored_ids) == ((two.version,), {one.version.id, two.version.id})


def test_publishing_the_same_again_changes_nothing(rig: Rig) -> None:
    one = published(1)
    place = rig.place()
    place.publish_versions([one], state(one))
    place.publish_versions([one], state(one))
    found = place.read_contents({})
    assert (found.unknown_versions, found.foreign_item_names, len(found.machine_states)) == (
        (one.version,),
        (),
        1,
    )


def test_machine_state_replaces_its_previous_state(rig: Rig) -> None:
    one, place = published(1), rig.place()
    place.publish_versions([one], state(one))
    other = PublishedMachineState("f" * 32, "LATHE 2", AT, {})
    rig.place(2).publish_versions([], other)
    place.publish_versions([], state())
    desks = {each.machine_id: each for each in rig.place(2).read_contents({}).machine_states}
    assert desks == {HOME: state(), "f" * 32: other}


def test_repeated_setup_changes_nothing(rig: Rig) -> None:
    one = published(1)
    rig.place().publish_versions([one], state(one))
    rig.place(2).set_up()
    assert rig.place().read_contents({}).unknown_versions == (one.version,)


def test_unreachable_location_is_reported_and_works_when_it_returns(rig: Rig) -> None:
    one, two, place = published(1), published(2), rig.place()
    place.publish_versions([one], state(one))
    rig.leave()
    asked = [cause_of(place.read_contents, {}), cause_of(place.publish_versions, [two], state(two))]
    rig.come_back()
    assert [cause for cause, _ in asked] == [rig.away_cause] * 2
    place.publish_versions([two], state(two))
    assert {each.id for each in place.read_contents({}).unknown_versions} == {one.version.id, two.version.id}


def test_newer_format_is_rejected_and_left_unchanged(rig: Rig) -> None:
    one, place = published(1), rig.place()
    rig.make_newer()
    for cause, words in (
        cause_of(place.read_contents, {}),
        cause_of(place.publish_versions, [one], state(one)),
        cause_of(place.set_up),
    ):
        assert (cause, "newer TurnDesk (format 2)" in words) == (SharingErrorCause.NEWER, True)


def test_garbage_is_listed_and_hides_nothing(rig: Rig) -> None:
    one, place = published(1), rig.place()
    place.publish_versions([one], state(one))
    rig.litter()
    found = place.read_contents({})
    assert (found.unknown_versions, found.machine_states, len(found.foreign_item_names)) == (
        (one.version,),
        (state(one),),
        3,
    )
    assert found.stored_ids == {one.version.id}


def test_interrupted_publishing_leaves_each_version_complete_or_absent(
    rig: Rig, monkeypatch: pytest.MonkeyPatch
) -> None:
    first, more = published(0), [published(number) for number in range(1, 6)]
    place = rig.place()
    place.publish_versions([first], state(first))
    with monkeypatch.context() as patch:
        rig.cut_in_put(patch)
        with pytest.raises((SharingError, PowerCut)):
            place.publish_versions(more, state(*more))
    rig.mend()
    there = rig.place(2).read_contents({})
    assert first.version in there.unknown_versions  # what was acknowledged
    assert (there.foreign_item_names, there.machine_states) == ((), (state(first),))
    assert {each.id for each in there.unknown_versions} <= {each.version.id for each in (first, *more)}
    rig.place().publish_versions(more, state(*more))
    after = rig.place(2).read_contents({})
    assert {each.id for each in after.unknown_versions} == {each.version.id for each in (first, *more)}
    assert after.machine_states == (state(*more),)
    assert [rig.place(2).read_text(each.version) for each in more] == [each.program_text for each in more]


def test_missing_text_is_rejected(rig: Rig) -> None:
    rig.place().publish_versions([], state())
    cause, words = cause_of(rig.place().read_text, published(7).version)
    assert cause in {SharingErrorCause.DAMAGED, SharingErrorCause.NOT_THERE}
    assert rig.place().name in words


def test_location_that_is_not_set_up_says_how_to_set_it_up(rig: Rig) -> None:
    empty = _emptied(rig)
    cause, words = cause_of(empty.read_contents, {})
    assert (cause, "turndesk share begin" in words) == (SharingErrorCause.NOT_BEGUN, True)
    assert cause_of(empty.publish_versions, [published(1)], state())[0] is SharingErrorCause.NOT_BEGUN
    empty.set_up()
    assert empty.read_contents({}).stored_ids == frozenset()


def _emptied(rig: Rig) -> SharedLocation:
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
        (errno.ENOSPC, SharingErrorCause.FULL),
        (errno.EDQUOT, SharingErrorCause.FULL),
        (errno.EROFS, SharingErrorCause.NO_RIGHT),
        (errno.EACCES, SharingErrorCause.NO_RIGHT),
        (errno.EHOSTDOWN, SharingErrorCause.AWAY),
        (errno.ESTALE, SharingErrorCause.AWAY),
    ],
)
def test_system_error_is_reported_with_its_cause(
    folder_rig: Rig, monkeypatch: pytest.MonkeyPatch, number: int, cause: SharingErrorCause
) -> None:
    def refused(_file: int) -> None:
        raise OSError(number, os.strerror(number))

    place = folder_rig.place()
    with monkeypatch.context() as patch:
        patch.setattr(os, "fsync", refused)
        assert cause_of(place.publish_versions, [published(1)], state())[0] is cause
    assert place.read_contents({}).stored_ids == frozenset()
    place.publish_versions([published(1)], state())
    assert place.read_contents({}).foreign_item_names == ()


def test_truncated_version_is_set_aside_and_published_again(folder_rig: Rig) -> None:
    one, place = published(1), folder_rig.place()
    place.publish_versions([one], state(one))
    (file,) = (folder_rig.folder / "shop" / "versions").iterdir()
    file.write_bytes(file.read_bytes()[:-3])
    assert place.read_contents({one.version.id: one.version}).stored_ids == frozenset()
    assert place.read_contents({}).foreign_item_names == (file.name,)
    assert cause_of(place.read_text, one.version)[0] is SharingErrorCause.DAMAGED
    place.publish_versions([one], state(one))
    assert place.read_text(one.version) == one.program_text
    assert place.read_contents({}).foreign_item_names == (
        f"{file.name}.damaged",
    )  # what was there is not lost either


@pytest.mark.parametrize("text", ["", "[]", '{"format": "1"}', "[" * 100_000])
def test_foreign_marker_file_is_rejected(folder_rig: Rig, text: str) -> None:
    (folder_rig.folder / "shop" / "turndesk-share.json").write_text(text)
    assert cause_of(folder_rig.place().read_contents, {})[0] is SharingErrorCause.OTHER


@pytest.fixture
def database(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[PostgresRig]:
    with rig_of("postgresql", tmp_path, request) as made:
        assert isinstance(made, PostgresRig)
        made.place().set_up()
        yield made


def test_user_without_permissions_is_reported(database: PostgresRig) -> None:
    database.server.sql("CREATE ROLE visitor LOGIN", database.database)
    try:
        visitor = SharedDatabase(database.server.conninfo(database.database, "visitor"))
        assert cause_of(visitor.read_contents, {})[0] is SharingErrorCause.NO_RIGHT
        assert (
            cause_of(SharedDatabase(database.server.conninfo("nowhere")).read_contents, {})[0]
            is SharingErrorCause.NOT_THERE
        )
        stranger = SharedDatabase(database.server.conninfo(database.database, "stranger"))
        assert cause_of(stranger.read_contents, {})[0] in {
            SharingErrorCause.NO_RIGHT,
            SharingErrorCause.NOT_THERE,
        }
        database.server.sql(
            "GRANT USAGE ON SCHEMA turndesk TO visitor;"
            "GRANT SELECT ON ALL TABLES IN SCHEMA turndesk TO visitor",
            database.database,
        )
        assert visitor.read_contents({}).stored_ids == frozenset()
        assert cause_of(visitor.publish_versions, [published(1)], state())[0] is SharingErrorCause.NO_RIGHT
    finally:
        database.server.sql("DROP OWNED BY visitor; DROP ROLE visitor", database.database)


def test_foreign_database_tables_are_rejected(database: PostgresRig) -> None:
    database.server.sql("ALTER TABLE turndesk.versions RENAME COLUMN record TO recipe", database.database)
    one = published(1)
    database.server.sql(
        f"INSERT INTO turndesk.versions VALUES ('{one.version.id}', 'x', 'x')", database.database
    )
    assert cause_of(database.place().read_contents, {})[0] is SharingErrorCause.OTHER


def test_missing_psycopg_is_reported_in_one_sentence(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("importlib.util.find_spec", lambda _name: None)
    cause, words = cause_of(SharedDatabase("host=shop-pc password=secret dbname=shop").read_contents, {})
    assert (cause, "turndesk[postgresql]" in words) == (SharingErrorCause.NO_PSYCOPG, True)


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
def test_passwords_are_not_in_messages_or_crash_files(conninfo: str, monkeypatch: pytest.MonkeyPatch) -> None:
    def away(**_values: object) -> None:
        raise psycopg.OperationalError("no answer")

    monkeypatch.setattr(psycopg, "connect", away)
    place = SharedDatabase(conninfo)
    with pytest.raises(SharingError) as refused:
        place.read_contents({})
    assert "cret" not in place.name + "".join(traceback.format_exception(refused.value))


def test_database_name_comes_from_the_libpq_settings() -> None:
    name = SharedDatabase("postgresql://lathe:secret@127.0.0.1:5432/d").name
    assert name == "the database user=lathe host=127.0.0.1 port=5432 dbname=d"


@pytest.mark.parametrize("conninfo", ["host=h passwort=x", "host=h port=x", "postgresql://a:b/c@h/d"])
def test_invalid_libpq_settings_are_reported(conninfo: str) -> None:
    assert cause_of(SharedDatabase(conninfo).read_contents, {})[0] is SharingErrorCause.UNREADABLE


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
def test_remote_server_must_verify_its_certificate(
    conninfo: str, mode: str | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in ("PGHOST", "PGSSLMODE", "PGSSLROOTCERT"):
        monkeypatch.delenv(name, raising=False)
    values = require_tls(parse_conninfo(conninfo))
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
            SharingErrorCause.WRONG_PASSWORD,
            "password authentication failed",
        ),
        (f"{_AT}fe_sendauth: no password supplied", SharingErrorCause.WRONG_PASSWORD, "no password supplied"),
        (
            f"{_AT}SSL error: certificate verify failed",
            SharingErrorCause.NOT_TRUSTED,
            "certificate verify failed",
        ),
        (
            f'{_AT}server certificate for "shop-pc" does not match host name "10.0.0.7"',
            SharingErrorCause.NOT_TRUSTED,
            "does not match",
        ),
        (f'{_AT}root certificate file "/a" does not exist\nEither', SharingErrorCause.NOT_TRUSTED, "/a"),
        (
            f"{_AT}server does not support SSL, but SSL was required",
            SharingErrorCause.NO_TLS,
            "does not support",
        ),
        (
            f'{_AT}FATAL:  no pg_hba.conf entry for host "10.0.0.7", user "u", database "d", no encryption',
            SharingErrorCause.TLS_ONLY,
            "no encryption",
        ),
        (
            f'{_AT}FATAL:  no pg_hba.conf entry for host "10.0.0.7", user "u", database "d", SSL encryption',
            SharingErrorCause.NO_RIGHT,
            "no pg_hba.conf entry",
        ),
        (f'{_AT}FATAL:  database "d" does not exist', SharingErrorCause.NOT_THERE, "does not exist"),
        (f"{_AT}Connection refused\n\tIs the server running?", SharingErrorCause.AWAY, "Connection refused"),
    ],
)
def test_connection_error_of_the_server_is_mapped_to_its_cause(
    said: str, cause: SharingErrorCause, why: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As libpq 17 and a server of version 15 have said it."""

    def refuses(**_values: object) -> None:
        raise psycopg.OperationalError(said)

    monkeypatch.setattr(psycopg, "connect", refuses)
    found, words = cause_of(SharedDatabase("host=10.0.0.7 dbname=d").read_contents, {})
    assert (found, why in words) == (cause, True)
