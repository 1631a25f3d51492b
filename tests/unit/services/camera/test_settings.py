"""Settings of the camera service."""

import pytest

from services.camera.settings import CameraSettings


def settings(monkeypatch, **variables):
    for name, value in variables.items():
        monkeypatch.setenv(f"CAMERA_{name}", value)
    return CameraSettings.from_environment()


def test_a_camera_without_a_url_does_not_start(monkeypatch):
    with pytest.raises(ValueError, match="CAMERA_URL: a camera's URL expected"):
        settings(monkeypatch)


def test_a_password_is_not_told_when_the_url_is_wrong(monkeypatch):
    with pytest.raises(ValueError, match="CAMERA_URL") as told:
        settings(monkeypatch, URL="osc://THETA:secret@host?size=3")
    assert "secret" not in str(told.value)


def test_the_delay_is_what_is_usual_for_the_kind_unless_it_was_measured(monkeypatch):
    assert settings(monkeypatch, URL="osc://192.168.1.1", DELAY_MS="").delay_s == 0.4
    assert settings(monkeypatch, URL="osc://192.168.1.1", DELAY_MS="250").delay_s == 0.25


def test_a_mount_in_degrees_is_an_orientation_in_radians(monkeypatch):
    found = settings(monkeypatch, URL="/pictures", ROLL_DEG="180", MIRRORED="true").orientation
    assert found.roll_rad == pytest.approx(3.14159265)
    assert found.mirrored
