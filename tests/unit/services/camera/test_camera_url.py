"""URLs of cameras: what they name, what is ours in them, and what is said of those that make no sense."""

from pathlib import Path

import pytest

from services.camera.camera_url import parse_camera_url
from services.camera.kinds import find_camera


@pytest.mark.parametrize(
    ("text", "scheme"),
    [
        ("osc://192.168.1.1", "osc"),
        ("v4l2:/dev/video0", "v4l2"),
        ("https://camera.example/video", "https"),
        ("rtsp://192.168.1.20:8554/live", "rtsp"),
        ("file:/pictures", "file"),
        ("/pictures", "file"),
        ("pictures", "file"),
    ],
)
def test_the_scheme_says_what_kind_of_source_it_is(text, scheme):
    assert find_camera(text).url.scheme == scheme


def test_what_is_ours_is_taken_out_and_the_rest_stays_with_the_camera():
    url = parse_camera_url("http://10.0.0.2:8080/video?fisheye=/c.json&size=3&mask_deg=4")
    assert url.fisheye == Path("/c.json")
    assert url.mask_deg == 4.0
    assert url.plain == "http://10.0.0.2:8080/video?size=3"


def test_a_password_is_used_and_never_shown():
    url = parse_camera_url("osc://THETA:secret@10.0.0.2")
    assert (url.user, url.password) == ("THETA", "secret")
    assert "secret" not in url.shown
    assert "secret" not in repr(url)
    assert "secret" in url.plain


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "got none"),
        ("ftp://host/x", "a camera's URL such as osc://"),
        ("osc:", "names no host"),
        ("osc://host:port", "is no URL"),
        ("osc://host?widht=3", "option 'widht'.*there are width, rate, fisheye, mask_deg"),
        ("osc://host?width=9", "option 'width'"),
        ("v4l2:/dev/video0?fourcc=mjpg", "option 'fourcc'"),
        ("/pictures?rate=0", "option 'rate'"),
        ("/pictures?mask_deg=99", "mask_deg must be degrees from 0 to 30, got '99'"),
        ("/pictures?mask_deg=wide", "mask_deg must be"),
    ],
)
def test_what_makes_no_sense_is_named_in_one_line(text, said):
    with pytest.raises(ValueError, match=said) as told:
        find_camera(text)
    assert "\n" not in str(told.value)


def test_only_a_stepped_folder_waits_for_its_features():
    assert find_camera("/pictures?step=true").stepped
    assert not find_camera("/pictures").stepped
    assert not find_camera("osc://192.168.1.1").stepped
