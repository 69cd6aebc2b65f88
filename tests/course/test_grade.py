"""Grading many folders: one loops, one has NaN, one lacks its file, one does not compile; none stops another."""

import signal
import time
from concurrent.futures import ThreadPoolExecutor

import pytest

from aolab import course
from aolab.course.grade import Processes, checked_apart, located
from aolab.course.results import COMPILES
from aolab.errors import FileError, ParameterError

# many seconds on every driver, and no driver can leave it out: its end depends on the data
ENDLESS = """
    float spin = receiver.viewPos.z;
    for (int a = 0; a < 60000; ++a) for (int b = 0; b < 60000; ++b) spin = sin(spin) + 1e-3 * float(b);
    blockedDirections += spin;
"""


@pytest.fixture(scope="module")
def folders(tmp_path_factory):
    """{name: folder} of students."""
    place, one = tmp_path_factory.mktemp("students"), course.exercise("hemisphere")
    right = one.solution["ssao.frag"]
    texts = {
        "right": right,
        "flipped": right.replace("receiver.viewPos + way * along,", "receiver.viewPos - way * along,"),
        "endless": right.replace("float blockedDirections = 0.0;", f"float blockedDirections = 0.0;\n{ENDLESS}"),
        "nan": right.replace("pow(1.0 - blockedDirections", "pow(-1.0 - blockedDirections"),
        "broken": right.replace("float blockedDirections = 0.0;", "float blockedDirections = vec3(0.0);"),
        "without_function": right.replace("bool isWayBlocked(", "bool isDirectionBlocked("),
        "missing": None,
    }
    for name, text in texts.items():
        course.start("hemisphere", place / name)
        if text is None:
            (place / name / "ssao.frag").unlink()
        else:
            (place / name / "ssao.frag").write_text(text)
    (place / "binary").mkdir()
    (place / "binary" / "aolab.toml").write_text('exercise = "hemisphere"')
    (place / "binary" / "ssao.frag").write_bytes(b"\xff\xfe\x00\x81")
    (place / "empty").mkdir()
    return {path.name: path for path in sorted(place.iterdir())}


@pytest.fixture(scope="module")
def graded(folders):
    """{name: result}, all graded at once."""
    found = course.grade(folders.values(), limit=30)
    assert [one.folder for one in found] == list(folders.values())
    return {one.folder.name: one for one in found}


@pytest.mark.slow
def test_a_right_folder_has_all_points_whatever_the_others_do(graded):
    assert graded["right"].result.passed, graded["right"].result
    assert graded["right"].result.score == course.exercise("hemisphere").points


@pytest.mark.slow
def test_an_endless_loop_is_ended_at_the_time_limit(folders, graded):
    """llvmpipe leaves a loop after 65,535 steps, and computes on; on other drivers, the time limit ends the process."""
    assert graded["endless"].result.score < course.exercise("hemisphere").points
    (ended,) = course.grade([folders["endless"]], limit=1)  # less than the package takes to start and draw
    assert ended.result.score == 0
    assert "stopped after 1 s: a loop may never end" in ended.result.error
    assert ended.seconds < 30


@pytest.mark.slow
@pytest.mark.parametrize("stopped_before", [False, True])
def test_processes_of_checks_can_be_ended(folders, stopped_before):
    """Also a process that starts after the end, in a thread that was about to start it."""
    processes = Processes()
    with ThreadPoolExecutor(1) as pool:
        if stopped_before:
            processes.end()
        waiting = pool.submit(checked_apart, folders["right"], processes=processes)
        while not processes.running and not waiting.done():
            time.sleep(0.001)
        if not stopped_before:
            processes.end()
        assert waiting.result(timeout=60).error == f"the check ended with code {-signal.SIGKILL}"
    assert not processes.running


@pytest.mark.slow
def test_an_error_ends_the_other_checks(folders):
    """As an interrupt does. Checks that are ended have no result."""
    seen = []

    def fail(graded):
        seen.append(graded.folder.name)
        raise RuntimeError("no more")

    with pytest.raises(RuntimeError, match="no more"):
        course.grade([folders["empty"], folders["right"], folders["right"]], workers=2, done=fail)
    assert seen == ["empty"]


@pytest.mark.slow
def test_a_mistake_costs_the_points_of_its_step_and_has_a_hint(graded):
    result = graded["flipped"].result
    assert [step.name for step in result.steps if not step.passed] == ["point"]
    assert result["point"].mistake == "hemisphere flipped"
    assert "hints" in graded["flipped"].columns
    assert graded["flipped"].columns["hints"] == "point: hemisphere flipped"


@pytest.mark.slow
def test_nan_is_named_with_its_share(graded):
    result = graded["nan"].result
    assert [step.name for step in result.steps if not step.passed] == ["mean"]
    assert "'visibility' is NaN or infinite in 100 % of the surfaces' pixels" in str(result)


@pytest.mark.slow
def test_a_compile_error_names_the_students_file_and_line(graded):
    result = graded["broken"].result
    message = result[COMPILES].checks[0].message
    assert "ssao.frag:" in message
    assert "vec3(0.0)" in message
    assert [step.name for step in result.steps if not step.passed] == [COMPILES, "mean"]


@pytest.mark.slow
def test_a_missing_function_a_missing_file_and_no_text_are_named(graded):
    assert "the function 'isWayBlocked' is missing; did you mean" in str(graded["without_function"].result)
    assert "no file ssao.frag in" in graded["missing"].result.error
    assert "ssao.frag is no text in UTF-8" in graded["binary"].result.error
    assert "no aolab.toml in" in graded["empty"].result.error
    assert {graded[name].result.score for name in ("missing", "binary", "empty")} == {0}


def test_an_unpacked_archive_is_found_one_folder_below(tmp_path):
    inside = course.start("positions", tmp_path / "jane" / "positions")
    assert located(tmp_path / "jane") == inside
    assert located(inside) == inside


def test_wrong_folders_are_refused_before_the_work(tmp_path):
    with pytest.raises(ParameterError, match="no folder to grade"):
        course.grade([])
    with pytest.raises(FileError, match=r"no folder .*nobody"):
        course.grade([tmp_path / "nobody"])
