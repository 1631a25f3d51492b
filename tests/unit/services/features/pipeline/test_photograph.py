"""Photos: their features are those of the panorama they are a part of, none at the border."""

import numpy as np
import pytest

from experiments.phone_photos.taking import Shot, taken
from services.features.matching.photo_verification import verify_photo
from services.features.matching.verification import Candidate, feature_set
from services.features.pipeline.named_pipelines import find_profile
from services.features.pipeline.pipeline import Pipeline
from shared.geometry.photo.plane import USUAL_RAD
from shared.geometry.sphere import bearings_from_lonlat
from shared.messages.features import Photo, PhotoView
from shared.messages.sensors import Frame
from shared.messages.simulation import Pose

PIPELINE = Pipeline(find_profile("sift"))


def panorama_features(picture):
    frame = Frame(
        robot="r1",
        encoding="bgr8",
        width_px=picture.shape[1],
        height_px=picture.shape[0],
        data=picture.tobytes(),
    )
    return feature_set(PIPELINE.features_of(frame))


def shot(**changes):
    choices = {"pitch_rad": 0.1, "roll_rad": 0.05, "fov_rad": 1.3, "fov_known": True, "portrait": False}
    return Shot(Pose(x_m=0.0, y_m=0.0, yaw_rad=0.9), **(choices | changes))


@pytest.mark.parametrize("portrait", [False, True])
@pytest.mark.parametrize("known", [False, True])
def test_a_photo_matches_the_panorama_it_was_cut_from_under_one_turn(room, portrait, known):
    def panorama(pose):
        return room(0.0, 0.0, pose.yaw_rad, 1024)

    photo = taken(shot(portrait=portrait, fov_known=known), panorama, USUAL_RAD)
    features = PIPELINE.features_of_photo(photo)
    assert features.photo == photo.view
    query, node = feature_set(features), Candidate(3, panorama_features(room(0.0, 0.0, 0.0, 1024)))
    (matched,) = PIPELINE.matcher.match(query, [node.features])
    answer = verify_photo(query, photo.view, node, matched, 0, with_matches=True)
    assert answer.inliers >= 12
    assert answer.inliers >= 0.6 * answer.raw_matches
    assert answer.right is not None
    assert len(answer.right) == answer.raw_matches
    assert answer.heading_rad is None  # one node alone does not tell where the photo was taken
    counted = verify_photo(query, photo.view, node, matched, 0, with_matches=False)
    assert (counted.inliers, counted.matches_rad, counted.right) == (answer.inliers, None, None)


def test_features_lie_within_the_photo_and_keep_off_its_border(room):
    photo = taken(shot(), lambda _: room(0.0, 0.0, 0.9, 1024), USUAL_RAD)
    bearing = bearings_from_lonlat(PIPELINE.features_of_photo(photo).lonlat_rad)
    half = np.tan(photo.view.fov_rad / 2.0)
    aside, up = np.abs(bearing[:, 1] / bearing[:, 0]), np.abs(bearing[:, 2] / bearing[:, 0])
    assert aside.max() < 0.99 * half
    assert up.max() < 0.99 * half * 0.75


def test_a_blank_photo_has_no_features():
    view = PhotoView(fov_rad=1.2, fov_known=False, aspect=1.0)
    blank = Photo(view=view, width_px=300, height_px=300, data=bytes(3 * 300 * 300))
    features = PIPELINE.features_of_photo(blank)
    assert features.descriptors.shape == (0, 128)
