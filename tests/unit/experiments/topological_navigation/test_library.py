"""The thesis's Python library: signatures, pictures, mapping, navigation, safe files, its own program."""

import inspect
import math
import pickle
import subprocess
import sys

import cv2
import numpy as np
import pytest
import torch

from experiments.topological_navigation import SelectKeypointDescriptor, TopologicalNavigation
from services.planner.heading.votes import latitude_votes, pair_votes
from tests.unit.services.features.room import render_room

PLACES = [(-1.2 + 0.3 * k, 0.0) for k in range(9)]
WIDTHS = {"ORB": 32, "SIFT": 128, "BEBLID": 64}


@pytest.fixture(scope="module")
def frames():
    return [render_room(x, y, 0.0, 400) for x, y in PLACES]


@pytest.fixture(scope="module")
def files(frames, tmp_path_factory):
    folder = tmp_path_factory.mktemp("frames")
    paths = [folder / f"{number}.png" for number in range(len(frames))]
    for path, frame in zip(paths, frames, strict=True):
        cv2.imwrite(str(path), frame)
    return paths


def navigator(**options):
    return TopologicalNavigation("cpu", 25, 150, 40, [400, 800], **options)


@pytest.fixture(scope="module")
def mapped(frames, tmp_path_factory):
    tp = navigator(mapping_stage=True)
    for frame in frames:
        tp.current_frame = frame
        tp.compare_current_frame_with_map()
    path = tmp_path_factory.mktemp("map") / "room.zip"
    tp.save_map(path)
    return tp, path


def test_signatures_are_those_of_appendix_a():
    parameters = inspect.signature(SelectKeypointDescriptor.__init__).parameters
    expected = (
        "self img_info kp_descriptor draw_keypoints representation crop_degree max_keypoints device "
        "matcher_selection resize kornia_apply_orinet kornia_apply_affnet ignore_border_kp"
    )
    assert list(parameters) == expected.split()
    defaults = {name: p.default for name, p in parameters.items() if p.default is not inspect.Parameter.empty}
    assert defaults["kp_descriptor"] == "ORB"
    assert defaults["representation"] == "Cartesian"
    assert defaults["max_keypoints"] == 1024
    assert defaults["kornia_apply_orinet"] is defaults["kornia_apply_affnet"] is True
    assert len(inspect.signature(TopologicalNavigation.perform_navigation).parameters) == 8


@pytest.mark.parametrize("name", WIDTHS)
@pytest.mark.parametrize("representation", ["Cartesian", "Equirectangular", "Tangent"])
def test_keypoints_have_four_columns_and_descriptors_their_width(frames, name, representation):
    tool = SelectKeypointDescriptor(frames[0], name, representation=representation, max_keypoints=200)
    keypoints, descriptors = tool.try_descriptor()
    assert keypoints.shape == (len(descriptors), 4)
    assert descriptors.shape[1] == WIDTHS[name]
    assert 100 < len(keypoints) <= 200
    assert (keypoints[:, 0] >= 0).all()
    assert (keypoints[:, 0] <= 800).all()


def test_a_picture_given_directly_needs_no_img_info(frames):
    keypoints, _ = SelectKeypointDescriptor("", "SIFT", max_keypoints=50).compute_cv2_keypoints(frames[0])
    named, _ = SelectKeypointDescriptor(frames[0], "SIFT", max_keypoints=50).try_descriptor()
    assert torch.equal(keypoints, named)


def test_a_path_an_opencv_and_a_torch_image_give_the_same(frames, files):
    rgb = torch.from_numpy(frames[0][..., ::-1].copy()).permute(2, 0, 1)[None]
    found = [
        SelectKeypointDescriptor(info, "SIFT", max_keypoints=100).try_descriptor()
        for info in (str(files[0]), frames[0], rgb, rgb.float() / 255.0)
    ]
    for keypoints, descriptors in found[1:]:
        assert torch.equal(keypoints, found[0][0])
        assert torch.equal(descriptors, found[0][1])


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"kp_descriptor": "SURF"}, "kp_descriptor must be one of"),
        ({"representation": "Mercator"}, "representation must be one of"),
        ({"matcher_selection": "SuperGlue"}, "superpoint alone"),
    ],
)
def test_wrong_choices_are_refused(options, words):
    with pytest.raises(ValueError, match=words):
        SelectKeypointDescriptor("", **options)


def test_a_picture_that_is_none_is_refused(tmp_path):
    with pytest.raises(ValueError, match="OpenCV reads"):
        SelectKeypointDescriptor(tmp_path / "none.png").try_descriptor()


def test_border_keypoints_are_left_out_when_asked(frames):
    black = frames[0].copy()
    black[:, 300:500] = 0
    tool = SelectKeypointDescriptor(
        black, "ORB", max_keypoints=400, ignore_border_kp=True, draw_keypoints=True
    )
    column = tool.try_descriptor()[0][:, 0]
    assert not ((column > 297) & (column < 503)).any()
    assert tool.drawing.shape == black.shape


def test_mapping_keeps_some_frames_as_nodes_and_joins_them(mapped):
    graph = mapped[0].topo_map.graph
    assert 2 <= len(graph.nodes) < len(PLACES)
    assert len(graph.edges) >= len(graph.nodes) - 1


def test_a_saved_map_is_the_same_again(mapped, tmp_path):
    tp, path = mapped
    other = navigator()
    other.load_map(path)
    assert other.topo_map.graph.nodes == tp.topo_map.graph.nodes
    assert other.topo_map.graph.edges == tp.topo_map.graph.edges
    again = tmp_path / path.name
    other.save_map(again)
    assert again.read_bytes() == path.read_bytes()


def test_pickles_and_broken_files_are_refused(tmp_path):
    (tmp_path / "map.pickle").write_bytes(pickle.dumps({}))
    (tmp_path / "map.zip").write_bytes(b"no archive")
    with pytest.raises(ValueError, match="pickle"):
        navigator().load_map(tmp_path / "map.pickle")
    with pytest.raises(ValueError, match="is no map"):
        navigator().load_map(tmp_path / "map.zip")


def test_the_heading_leads_towards_the_target(mapped, frames):
    tp = navigator()
    tp.load_map(mapped[1])
    tp.target_frame, tp.current_frame = frames[-1], frames[0]
    tp.compare_current_frame_with_map()
    assert abs(tp.heading) < 30.0
    np.testing.assert_allclose(
        tp.heading_vector, [math.cos(math.radians(tp.heading)), math.sin(math.radians(tp.heading))]
    )
    assert tp.draw_path().axes


def test_without_frames_the_next_step_is_named():
    tp = navigator()
    with pytest.raises(ValueError, match="set current_frame first"):
        tp.compare_current_frame_with_map()
    with pytest.raises(ValueError, match="no heading"):
        _ = tp.heading


def test_the_nearest_node_is_found_with_its_matches(mapped, frames):
    tp, _ = mapped
    tp.current_frame = frames[0]
    details = tp.topo_map.features[min(tp.topo_map.features)]
    closest, first, second, *matches = tp.find_nearest_map_node("frame", 0, details)
    assert closest == min(tp.topo_map.features)
    assert first > second > 0
    assert all(part.shape[1] == 2 for part in matches)
    assert len(matches[0]) == len(matches[1]) == first


def test_obstacles_near_the_robot_are_told_with_their_direction():
    tp = navigator()
    assert tp.check_obstacles()[0] is False
    tp.distance_sensor_values = [0.3] + [4.0] * 11
    found, vector = tp.check_obstacles()
    assert found
    np.testing.assert_allclose(vector, [1.0, 0.0], atol=1e-12)
    tp.distance_sensor_values = [1.0]
    with pytest.raises(ValueError, match="12"):
        tp.check_obstacles()


def test_unit_headings_are_those_of_the_planner():
    rng = np.random.default_rng(2)
    current, target = rng.uniform(-1.2, 1.2, (2, 12, 2))
    i, j = np.triu_indices(12, 1)
    u_c, u_t = (TopologicalNavigation.get_keypoint_unitvector(x) for x in (current, target))
    pairs = TopologicalNavigation.get_unit_heading([u_c[i], u_c[j]], [u_t[i], u_t[j]])
    np.testing.assert_allclose(pairs, pair_votes(current, target).directions, atol=1e-12)
    v_c, v_t = (TopologicalNavigation.get_keypoint_unitvector(x[:, 1]) for x in (current, target))
    singles = TopologicalNavigation.get_unit_heading_wrt_latitude(u_c, v_c, v_t, np.array([1.0, 0.0]))
    np.testing.assert_allclose(singles, latitude_votes(current, target).directions, atol=1e-12)


def test_mapping_heads_away_from_both_nodes_and_navigation_towards_one():
    tp = navigator(exploration_noise=0.0)
    lon = np.linspace(-3.0, 3.0, 40)
    here = np.stack([lon, 0.2 * np.ones(40)], axis=1)
    nearer = np.stack([lon, 0.2 + 0.1 * np.cos(lon)], axis=1)
    towards = tp.perform_navigation(False, here, nearer)
    away = tp.perform_navigation(True, here, nearer, here, nearer)
    assert abs(towards[0]) < 5.0
    assert abs(abs(away[0]) - 180.0) < 5.0


@pytest.mark.parametrize("program", ["appendix_b.py", "map_pictures.py", "compare_descriptors.py"])
def test_the_examples_run(program, mapped, files, repository, tmp_path):
    arguments = {
        "appendix_b.py": [mapped[1], files[-1], files[0]],
        "map_pictures.py": [tmp_path / "made.zip", *files[:4]],
        "compare_descriptors.py": [files[0], files[1]],
    }[program]
    script = repository / "deploy" / "examples" / program
    environment = {"PYTHONPATH": str(repository), "PATH": "/usr/bin:/bin", "HOME": str(tmp_path)}
    environment |= {"OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"}
    done = subprocess.run(
        [sys.executable, script, *arguments],
        cwd=tmp_path,
        env=environment,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    expected = {"appendix_b.py": "heading", "map_pictures.py": "nodes", "compare_descriptors.py": "matches"}
    assert expected[program] in done.stdout
