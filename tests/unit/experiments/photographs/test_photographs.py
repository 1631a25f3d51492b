"""The command on a rendered tour, from pictures to failure pictures."""

import json
import sys

import cv2
import numpy as np
import pytest
from typer.testing import CliRunner

from experiments.commands.photographs import app
from experiments.photographs.comparing import Question, compare
from experiments.photographs.eyes import eyes
from experiments.photographs.failures import draw_failures, failures_of
from experiments.photographs.looks import Look, seen
from experiments.photographs.study import measure
from experiments.photographs.tours import read_tours
from services.features.matching.verification import Candidate
from services.features.pipeline.named_pipelines import find_profile
from services.features.pipeline.pipeline import Pipeline
from services.launcher.client.failure import ExperimentError
from services.planner.profiles import DEFAULT

TOUR_KEYS = (
    "name pictures links answered within_20 beyond_90 median_deg p90_deg edges wrong_edges recall_at_1"
)
KEYS = {"tours", "total", "tilt", "calibration", "foreign_pairs", "pipeline", "ms_per_picture", "ms_per_pair"}


@pytest.mark.render
@pytest.mark.slow
def test_the_command_measures_a_tour_and_draws_what_went_wrong(example, tmp_path):
    files = {name: str(tmp_path / name) for name in ("f.json", "f.png", "failures", "data")}
    options = ["--json", files["f.json"], "--plot", files["f.png"], "--failures", files["failures"]]
    asked = ["--tours", str(example), *options, "--data-dir", files["data"], "--quick", "--jobs", "1"]
    asked += ["--pipeline", "fast"]
    ran = CliRunner().invoke(app, asked, catch_exceptions=False)
    assert ran.exit_code == 0
    found = json.loads((tmp_path / "f.json").read_text())
    assert found.keys() == KEYS
    (tour,) = found["tours"]
    assert list(tour) == list(found["total"]) == TOUR_KEYS.split()
    assert tour["pictures"] == 4
    assert tour["median_deg"] < 20.0
    assert [row["deg"] for row in found["tilt"]] == [1.0, 2.0, 5.0, 10.0]
    assert found["ms_per_picture"] > 0.0 < found["ms_per_pair"]
    assert cv2.imread(files["f.png"]) is not None
    page = (tmp_path / "failures" / "index.md").read_text()
    drawn = sorted(path.name for path in (tmp_path / "failures").glob("*.png"))
    assert all(name in page for name in drawn)
    assert "apartment_rendered" in ran.output


@pytest.mark.render
def test_figures_do_not_depend_on_the_number_of_processes(example):
    tours, headings = read_tours(example), []
    for jobs in (1, 2):
        with eyes("orb", DEFAULT, 1, jobs, lambda _: None) as looking:
            looks = [Look(path) for path in tours[0].paths[:3]]
            features = [one.features for one in looking.look(looks, "pictures")]
            others = tuple(Candidate(n, features[n]) for n in (1, 2))
            (found,) = looking.compare([Question(0, features[0], others)], "pairs")
            headings.append([(one.inliers, one.heading_deg) for one in found.answers])
    assert headings[0] == headings[1]


@pytest.mark.render
def test_a_picture_is_most_similar_to_itself_and_no_edge_of_it(example):
    pipeline = Pipeline(find_profile("sift"))
    features = [seen(Look(path), pipeline).features for path in read_tours(example)[0].paths[:2]]
    question = Question(0, features[0], (Candidate(1, features[1]), Candidate(2, features[0])))
    found = compare(question, pipeline, DEFAULT, seed=1)
    assert found.most_similar == 2
    assert found.answers[1].status == "no_baseline"
    assert not found.answers[1].edge
    assert found.answers[1].ms > 0.0


def test_pictures_without_anything_in_them_are_unanswered_and_drawn(write_tour, tmp_path):
    tours = read_tours(write_tour(size_px=(256, 128)).parent)
    with eyes("sift", DEFAULT, 1, 1, lambda _: None) as looking:
        found = measure(tours, looking, quick=True)
        (failure,) = failures_of(found)
        page = draw_failures(tmp_path / "failures", found, looking, lambda _: None)
        again = draw_failures(tmp_path / "failures", found, looking, lambda _: None)
    assert failure.kind == "unanswered"
    assert found.tours[0].recalled == [False, False]
    assert page.read_text() == again.read_text()
    assert "001-unanswered-flat_a-flat_b.png" in page.read_text()


def test_nothing_else_is_deleted_for_failures(write_tour, tmp_path):
    tours = read_tours(write_tour(size_px=(256, 128)).parent)
    kept = tmp_path / "failures" / "holiday.png"
    kept.parent.mkdir()
    kept.write_bytes(b"")
    with eyes("sift", DEFAULT, 1, 1, lambda _: None) as looking:
        found = measure(tours, looking, quick=True)
        with pytest.raises(ExperimentError, match="expected an empty folder or one of earlier failures"):
            draw_failures(kept.parent, found, looking, lambda _: None)
    assert kept.exists()


def test_a_damaged_picture_is_named(tmp_path):
    path = tmp_path / "a.jpg"
    _, data = cv2.imencode(".jpg", np.zeros((64, 128, 3), np.uint8))
    path.write_bytes(data.tobytes()[:-200])
    with pytest.raises(ExperimentError, match=r"a\.jpg: JPEG .*: export the picture again"):
        seen(Look(path), Pipeline(find_profile("sift")))


def test_without_tours_the_command_says_what_it_needs(tmp_path):
    with pytest.raises(ExperimentError, match="expected --tours DIR"):
        CliRunner().invoke(app, ["--data-dir", str(tmp_path)], catch_exceptions=False)


def test_a_peer_that_is_missing_says_how_to_get_it(write_tour, monkeypatch, tmp_path):
    monkeypatch.setitem(sys.modules, "pycolmap", None)
    asked = ["--tours", str(write_tour().parent), "--peer", "pycolmap", "--data-dir", str(tmp_path)]
    with pytest.raises(ExperimentError, match=r"pip install './experiments\[peers\]'"):
        CliRunner().invoke(app, asked, catch_exceptions=False)
