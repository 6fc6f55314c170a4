"""The player of the part view: along the time line, while the run leads, and where there is no part."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import pytest

import resources
from app.compose.machine.machine_files import load_machine, parse_machine
from app.compose.program_proving import create_loading_steps
from app.compose.stored_offsets import NO_OFFSETS, Offsets
from app.desk.background_work import LatestRequestWorker
from app.path.part_player import FAST_FACTOR, PartPlayer, PartPlayers, SolidImageRequest
from app.path.path_aspects import PathViewKind, list_available_views
from app.path.path_picture import ProgramPicture
from core.interpreter.shared.job_setup import ToolOffset
from core.language.source import ProgramSource
from core.part.picture.solid_view import SolidView
from tests.texts import begins

HEAD = "G90G94F300\nM03S1500\nT1\n"
SHAFT = HEAD + "X.6Z.05\nX.4\nG95F.004Z-.5\nX.45Z-.6\nX.55\nG94F300Z.05\nX.3\nG95F.004Z-.3\nX.55\nM30\n"
RAPID = SHAFT.replace("G95F.004Z-.3", "G00Z-.3")


def picture(text: str) -> ProgramPicture:
    tools = {n: ToolOffset(-12.7, -50.8) for n in range(1, 4)}
    machine = load_machine(None)
    steps = create_loading_steps(machine, lambda: Offsets(tools, {}, {}))
    job = steps.make_job(ProgramSource("part.nc", text), False)
    steps.prove_job(job, lambda _count: None)
    return steps.draw_path(job, lambda _count: None)


class Clock:
    now = 0.0

    def __call__(self) -> float:
        return self.now


@pytest.fixture
def clock() -> Clock:
    return Clock()


@pytest.fixture
def player(clock: Clock) -> Iterator[PartPlayer]:
    made = PartPlayer(read_time_s=clock)
    yield made
    made.close()


def settled(player: PartPlayer) -> PartPlayer:
    player.wait_for_result(60.0)
    return player


def line(player: PartPlayer) -> int:
    shown = settled(player).latest_result
    assert shown is not None
    return shown.part_instant.line_number


def test_loaded_program_is_shown_at_its_end(player: PartPlayer) -> None:
    player.load_picture(picture(SHAFT))
    assert player.program_time_s == player.duration_s > 5.0
    assert line(player) == 13


def test_player_without_program_shows_nothing_and_ignores_keys(player: PartPlayer) -> None:
    player.toggle_playback()
    player.step_by_blocks(1)
    player.seek_line(3)
    player.update()
    assert (player.latest_result, player.is_playing, player.program_time_s, player.is_outdated) == (
        None,
        False,
        0.0,
        False,
    )


def test_unloaded_program_is_not_shown(player: PartPlayer) -> None:
    player.load_picture(picture(SHAFT))
    settled(player)
    player.load_picture(None)
    player.update()
    assert player.latest_result is None


def test_playback_at_end_restarts_and_follows_clock(player: PartPlayer, clock: Clock) -> None:
    player.load_picture(picture(SHAFT))
    player.toggle_playback()
    assert player.program_time_s == 0.0
    clock.now += 0.2
    player.update()
    assert player.program_time_s == pytest.approx(0.2)
    player.toggle_fast_playback()
    clock.now += 0.2
    player.update()
    assert player.program_time_s == pytest.approx(0.2 + 0.2 * FAST_FACTOR)
    player.toggle_playback()
    clock.now += 0.2
    player.update()
    assert player.program_time_s == pytest.approx(0.2 + 0.2 * FAST_FACTOR)


def test_playback_stops_at_end(player: PartPlayer, clock: Clock) -> None:
    player.load_picture(picture(SHAFT))
    player.seek_time(player.duration_s - 0.1)
    player.toggle_playback()
    clock.now += 0.2
    player.update()
    assert (player.is_playing, player.program_time_s) == (False, player.duration_s)


def test_playback_does_not_jump_after_screen_was_blocked(player: PartPlayer, clock: Clock) -> None:
    player.load_picture(picture(SHAFT))
    player.toggle_playback()
    clock.now += 5.0
    player.update()
    assert player.program_time_s <= 0.25


def test_steps_go_from_block_to_block(player: PartPlayer) -> None:
    player.load_picture(picture(SHAFT))
    player.seek_time(0.0)
    lines = []
    for _ in range(4):
        player.step_by_blocks(1)
        lines.append(line(player))
    assert lines == [4, 5, 6, 7]
    player.step_by_blocks(-1)
    assert line(player) == 6
    for _ in range(9):
        player.step_by_blocks(-1)
    assert player.program_time_s == 0.0


def test_seek_line_shows_part_at_line(player: PartPlayer) -> None:
    player.load_picture(picture(SHAFT))
    player.seek_line(6)
    assert line(player) == 6
    shown = player.latest_result
    assert shown is not None
    assert shown.part_instant.tool is not None
    assert shown.part_instant.tool.control_point == pytest.approx((-12.7, 10.16))


def test_keys_are_ignored_while_player_follows_run(player: PartPlayer) -> None:
    player.load_picture(picture(SHAFT))
    player.follows_run = True
    at = player.program_time_s
    player.toggle_playback()
    player.step_by_blocks(-1)
    player.seek_line(1)
    assert (player.program_time_s, player.is_playing) == (at, False)


def test_player_follows_run_to_tool_position(player: PartPlayer) -> None:
    player.load_picture(picture(SHAFT))
    player.follows_run = True
    turning = player._picture.find_block_for_line(6) if player._picture else 0
    player.follow_run(turning, (0.55 * 25.4 / 2, 0.0))
    shown = settled(player).latest_result
    assert shown is not None
    assert shown.part_instant.tool is not None
    assert shown.part_instant.tool.control_point == pytest.approx((-0.225 * 25.4, 10.16))


def test_errors_have_their_times(player: PartPlayer) -> None:
    made = picture(RAPID)
    player.load_picture(made)
    settled(player)
    (mark,) = player.find_error_times().tolist()
    assert mark == made.ends[made.find_block_for_line(11)]


def test_failed_picture_is_reported(player: PartPlayer, monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(*_given: object) -> None:
        raise ValueError("no such tool")

    monkeypatch.setattr("core.proving.part_history.PartHistory.__init__", broken)
    player.load_picture(picture(SHAFT))
    settled(player)
    assert (player.latest_result, player.error_text) == (None, "no such tool")


def test_program_with_errors_is_shown_up_to_its_first_error(player: PartPlayer) -> None:
    player.load_picture(picture(SHAFT.replace("X.45Z-.6", "X.45Q7Z-.6")))
    assert line(player) >= 6


def test_mill_program_has_no_turned_part() -> None:
    machine = parse_machine(resources.read_machine_file("ac-table-mill.toml"), "mill")
    steps = create_loading_steps(machine, lambda: NO_OFFSETS)
    job = steps.make_job(ProgramSource("roof.h", "BEGIN PGM A MM\nL X+1 Y+1 Z+1 F100\nEND PGM A MM\n"), False)
    steps.prove_job(job, lambda _count: None)
    assert steps.draw_path(job, lambda _count: None).part is None


def test_players_close_with_turndesk() -> None:
    players = PartPlayers([PartPlayer()])
    players.close()
    players[0].load_picture(picture(SHAFT))
    assert not players[0].worker.is_busy


def test_too_long_program_shows_reason(player: PartPlayer, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("core.proving.part_history.MAX_MOVES", 5)
    made = picture(SHAFT)
    assert list_available_views(made, has_part=True)[-1] == (PathViewKind.SECTION,)
    assert list_available_views(made) == [(PathViewKind.PATH,)]
    player.load_picture(made)
    assert begins(player.error_text, "findings.part-too-long", blocks=12, most=5)
    assert settled(player).latest_result is None


def test_blocks_before_line_are_counted() -> None:
    made = picture(SHAFT)
    # M03S1500, T1, then one block a line: before line 6 are those of lines 2 to 5.
    assert made.count_blocks_before_line(6) == 4
    assert made.count_blocks_before_line(1) == 0


def test_seek_block_shows_its_line(player: PartPlayer) -> None:
    player.load_picture(picture(SHAFT))
    player.seek_block(4)
    player.update()
    assert line(player) == 5
    player.follows_run = True
    player.seek_block(9)
    player.update()
    assert line(player) == 5


MILLED = HEAD + (
    "X.6Z.05\nX.45\nG95F.004Z-.5\nX.55\nG94F300X.6Z.5\nT2(END MILL)\nX-.6Z.5\nM05\nM15\nM19\nZ-.1\nF4X-.43\n"
    "F300X-.6\nZ-.4\nX-.4\nX-.6\nZ1\nM16\nM30\n"
)


@pytest.mark.parametrize(
    ("program", "red"), [(MILLED, True), (MILLED.replace("X-.4\n", "F4X-.4\nF300"), False)]
)
def test_live_tool_collision_in_rapid_is_red_in_3d_view(player: PartPlayer, program: str, red: bool) -> None:
    player.load_picture(picture(program))
    player.set_image_request(SolidImageRequest(SolidView(pixels_per_mm=5.0, center_z_mm=-10.0), 200, 150))
    shown = settled(player).latest_result
    assert shown is not None
    assert shown.picture is not None
    r, g = ((shown.picture.image >> off) & 255 for off in (16, 8))
    assert bool(((r > 90) & (r > 2.5 * g)).sum() > 50) is red


@pytest.mark.parametrize(("resting_s", "is_coarse"), [(0.05, True), (0.2, False)])
def test_image_has_full_resolution_only_while_view_is_at_rest(
    player: PartPlayer, clock: Clock, resting_s: float, is_coarse: bool
) -> None:
    player.load_picture(picture(SHAFT))
    player.set_image_request(SolidImageRequest(SolidView(pixels_per_mm=5.0, center_z_mm=-10.0), 201, 151))
    clock.now += resting_s
    player.update()
    shown = settled(player).latest_result
    assert shown is not None
    assert shown.picture is not None
    assert shown.picture.image.shape == ((76, 101) if is_coarse else (151, 201))
    assert shown.pixel_size == (2 if is_coarse else 1)


class BusyWorker(LatestRequestWorker):
    """A worker that never finishes its first request."""

    request_count = 0

    @property
    def is_busy(self) -> bool:
        return self.request_count > 0

    def request_work(self, *_request: object) -> None:
        self.request_count += 1


@pytest.mark.parametrize(
    ("resting_s", "is_view_changed", "request_count"), [(0.2, True, 2), (0.2, False, 1), (0.05, True, 1)]
)
def test_only_unfinished_image_in_full_resolution_is_replaced_by_new_view(
    clock: Clock, resting_s: float, is_view_changed: bool, request_count: int
) -> None:
    worker, view = BusyWorker("part"), SolidView(pixels_per_mm=5.0, center_z_mm=-10.0)
    player = PartPlayer(worker, clock)
    player.load_picture(picture(SHAFT))
    worker.request_count = 0
    player.set_image_request(SolidImageRequest(view, 200, 150))
    clock.now += resting_s
    player.update()
    if is_view_changed:
        player.set_image_request(SolidImageRequest(replace(view, azimuth_deg=80.0), 200, 150))
    player.update()
    assert worker.request_count == request_count
    player.close()


@pytest.mark.parametrize(("name", "metric"), [("part.nc", False), ("part.mpf", True), ("part.h", True)])
def test_picture_without_path_has_default_unit_of_language(name: str, metric: bool) -> None:
    machine = load_machine(None)
    steps = create_loading_steps(machine, lambda: NO_OFFSETS)
    job = steps.make_job(ProgramSource(name, "(NO PROGRAM]\n"), False)
    steps.prove_job(job, lambda _count: None)
    drawn = steps.draw_path(job, lambda _count: None)
    assert (drawn.blocks, drawn.metric) == (0, metric)
