"""What is said of a camera, and what is wrong with it."""

from dataclasses import replace

import pytest

from services.camera.checking.report import Mount, Report, lines, problems

WELL = Report(
    source="osc://192.168.1.1", live=True, pictures=50, repeated=0, bad=0, stamp_delay_s=0.4,
    stamp_is_usual=True, flashed=False, lenses=False, model="THETA", mode="image", battery=0.5,
    width_px=1024, height_px=512, passed_on=True, rate_hz=10.0, longest_pause_s=0.2,
    mount=Mount(0.5, 0.3, 0.3, 0.4), seam=1.1, from_deg=-90.0, to_deg=90.0, blank=0.0,
)  # fmt: skip


def test_of_a_camera_that_is_well_all_is_said_and_nothing_is_wrong():
    assert problems(WELL) == []
    assert [word for word, _ in lines(WELL)] == [
        "camera", "rate", "frames", "stamp", "level", "seam", "coverage",
    ]  # fmt: skip
    assert lines(WELL)[0][1] == "osc://192.168.1.1, THETA, mode image, battery 50 %"
    assert dict(lines(WELL))["coverage"] == "the whole sphere"
    assert WELL.figures()["problems"] == []


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"pictures": 0, "ended": "no connection: refused"}, "no picture that can be used: no connection"),
        ({"pictures": 0, "bad_why": "it is cut short"}, "no picture that can be used: it is cut short"),
        (
            {"width_px": 0, "bad_why": "twice as wide as high, expected"},
            "no frame can be made of its pictures",
        ),
        ({"bad": 10, "bad_why": "cut short"}, "10 of 60 pictures cannot be used, most: cut short"),
        ({"repeated": 400}, "400 of 450 pictures are the one before"),
        ({"ended": "timed out"}, "it broke off: timed out"),
        ({"rate_hz": 2.0}, "2.0 pictures a second: the robot stands between them"),
        ({"longest_pause_s": 1.5}, "no picture for 1.5 s"),
        ({"clock_jump_s": -3.0}, "this machine's clock was set by -3.0 s"),
        ({"delay_s": 0.25, "flashed": True}, "set CAMERA_DELAY_MS=250"),
        ({"flashed": True}, "no screen seen"),
        ({"mount": Mount(5.0, 0.3, -3.0, 4.0)}, "set CAMERA_ROLL_DEG=-3.0 and CAMERA_PITCH_DEG=4.0"),
        ({"seam": 9.0}, "left and right edge of the picture do not meet (9.0)"),
        ({"seam": 9.0, "lenses": True}, "the two fisheyes do not fit at their seam (9.0)"),
        ({"blank": 0.3}, "30 % of what is within 55 degrees of the horizon is black"),
    ],
)
def test_what_is_wrong_is_said_with_what_to_do(change, said):
    (only,) = problems(replace(WELL, **change))
    assert said in only


@pytest.mark.parametrize(
    "change",
    [
        {"live": False, "rate_hz": 1.0, "longest_pause_s": 2.0, "ended": "no further picture"},
        {"bad": 1, "bad_why": "cut short"},
        {"delay_s": 0.45, "flashed": True},
        {"mount": Mount(2.5, 0.9, 1.0, 2.0)},
        {"mount": None},
    ],
    ids=["a folder", "one bad picture", "nearly the usual delay", "a lean that is not sure", "no edges"],
)
def test_what_is_no_fault_is_not_called_one(change):
    assert problems(replace(WELL, **change)) == []
    assert lines(replace(WELL, **change))


def test_a_stamp_says_where_its_delay_comes_from():
    assert "usual for such a camera: --flash measures it" in dict(lines(WELL))["stamp"]
    assert "as CAMERA_DELAY_MS says" in dict(lines(replace(WELL, stamp_is_usual=False)))["stamp"]
    measured = dict(lines(replace(WELL, delay_s=0.38)))["stamp"]
    assert measured == "frames are stamped 400 ms before they come; measured: 380 ms from exposure to arrival"
