"""`TopologicalNavigation` of the thesis's appendix A: mapping and navigation of one robot, step by step."""

import logging
import math
from pathlib import Path
from typing import Any

import numpy as np
import torch
from matplotlib.figure import Figure

from experiments.rendered.features import as_message
from experiments.topological_navigation.drawing import graph_figure
from experiments.topological_navigation.keypoints import SelectKeypointDescriptor
from experiments.topological_navigation.matcher import LocalMatcher
from experiments.topological_navigation.memory_map import MemoryMap, load, save
from experiments.topological_navigation.pictures import picture_of
from experiments.topological_navigation.vectors import keypoint_unit_vectors, latitude_headings, pair_headings
from services.drive.passing import obstacle_heading
from services.features.networks.runtime import WeightsError
from services.planner.heading.choose import heading_by_votes
from services.planner.heading.methods import MethodName
from services.planner.mapping.strategies import ThesisExploration
from services.planner.missions.goto import Goto
from services.planner.ports import Decision, Mission, Observation
from services.planner.profiles import THESIS, Profile
from shared.geometry.sphere import FloatArray
from shared.messages.features import Features
from shared.messages.sensors import Ranges

log = logging.getLogger(__name__)

SENSORS = 12  # of the thesis's robot
FAR_M = 4.0  # reach of the simulated sensors
OBSTACLE_M = 0.5
"""Nearer than this counts as an obstacle (Q19)."""

FALLBACK = ("SIFT", "NearestNeighbor")
"""Descriptor and matcher where SuperPoint's non-commercial weights are not to be had."""


class TopologicalNavigation(SelectKeypointDescriptor):
    """Maps while `mapping_stage`, else drives towards `target_frame`; one step per current frame."""

    def __init__(
        self,
        device: str,
        crop_degree: float,
        max_keypoints: int,
        min_matches: int,
        resize: list[int],
        exploration_noise: float = 50,
        mapping_stage: bool = False,
        continue_mapping: bool = False,
        *,
        profile: Profile = THESIS,
        seed: int = 0,
    ) -> None:
        """Begin with an empty map.

        Args:
            device: cpu or cuda; without a GPU, cuda falls back to cpu with a warning.
            crop_degree: angle cut away above and below, degrees.
            max_keypoints: most keypoints per frame.
            min_matches: fewer matches give no heading (Q10).
            resize: [rows, columns] of the whole picture, [-1] to keep it.
            exploration_noise: random part of exploration headings, degrees to either side (Q18).
            mapping_stage: map instead of navigating.
            continue_mapping: load_map before mapping goes on; ids are kept.
            profile: thresholds; the thesis's by default.
            seed: of the random headings.
        """
        super().__init__(
            "",
            kp_descriptor="SuperPoint",
            representation="Equirectangular",
            crop_degree=crop_degree,
            max_keypoints=max_keypoints,
            device=_device(device),
            matcher_selection="SuperGlue",
            resize=resize,
            kornia_apply_orinet=False,
        )
        self._choose_pipeline()
        self.min_matches, self.exploration_noise = min_matches, exploration_noise
        self.mapping_stage, self.continue_mapping = mapping_stage, continue_mapping
        self.distance_sensor_values: list[float] = [FAR_M] * SENSORS
        self._rules = profile
        self._rng = np.random.default_rng(seed)
        self._current: Any = None
        self._target: Any = None
        self._goal: Features | None = None
        self._frames = 0
        self._decision: Decision | None = None
        self.topo_map = MemoryMap()

    @property
    def topo_map(self) -> MemoryMap:
        """The map: graph and features of its nodes."""
        return self._map

    @topo_map.setter
    def topo_map(self, new_topo_map: MemoryMap) -> None:
        self._map = new_topo_map
        self._matcher = LocalMatcher(self.pipeline, new_topo_map)
        self._mission: Mission | None = None

    @property
    def heading(self) -> float:
        """Heading of the last step, degrees, current frame.

        Raises:
            ValueError: no step has given one yet.
        """
        if self._decision is None or self._decision.action != "go":
            why = "no step was made yet" if self._decision is None else self._decision.why
            raise ValueError(
                f"there is no heading: {why}; call compare_current_frame_with_map with a new frame"
            )
        return math.degrees(self._decision.heading_rad)

    @property
    def heading_vector(self) -> FloatArray:
        """Heading as a unit vector (2,): x ahead, y to the left."""
        angle = math.radians(self.heading)
        return np.array([math.cos(angle), math.sin(angle)])

    @property
    def current_frame(self) -> Any:
        """The current frame as it was given."""
        return self._current

    @current_frame.setter
    def current_frame(self, new_frame: Any) -> None:
        self._current = new_frame
        self.update_current_frame_properties()

    @property
    def target_frame(self) -> Any:
        """The target frame as it was given."""
        return self._target

    @target_frame.setter
    def target_frame(self, new_frame: Any) -> None:
        self._target = new_frame
        self.update_target_frame_properties()

    def update_current_frame_properties(self) -> None:
        """Extract the current frame."""
        self._frames += 1
        self._matcher.current = self._features(self._current)

    def update_target_frame_properties(self) -> None:
        """Extract the target frame; the way there is planned anew."""
        self._goal = self._features(self._target)
        self._mission = None

    def load_map(self, map_name: str | Path | None = None) -> None:
        """Read a map archive; one that `topnav map export` wrote will do.

        Raises:
            ValueError: it is no map, or its pictures were described by another pipeline.
        """
        maps = load(_map_path(map_name))
        made_by = {features.pipeline for features in maps.features.values()} - {self.pipeline.identity}
        if made_by:
            raise ValueError(
                f"the map was made with {sorted(made_by)}, this object uses {self.pipeline.identity!r}: "
                "choose the same descriptor and max_keypoints"
            )
        self.topo_map = maps

    def save_map(self, map_name: str | Path | None = None) -> None:
        """Write the map as an archive that `topnav map import` reads."""
        save(self._map, _map_path(map_name))

    def draw_map(self, block: bool = True) -> Figure:
        """The map as a figure; a notebook shows it, elsewhere call savefig. `block` has no effect."""
        del block
        return graph_figure(self._map.graph)

    def draw_path(self) -> Figure:
        """The map with the path of the last step."""
        progress = self._mission.progress if self._mission is not None else None
        path = progress.via_points if progress is not None else ()
        return graph_figure(self._map.graph, path, path[0] if path else None)

    def compare_current_frame_with_map(self) -> Decision:
        """One step with the current frame: map it, or head for the target; sets `heading`.

        Raises:
            ValueError: a frame is missing.
        """
        current = self._matcher.current
        if current is None:
            raise ValueError("set current_frame first")
        if self._mission is None:
            self._mission = self._new_mission()
        self._decision = self._mission.decide(Observation(current, self._ranges()))
        return self._decision

    def follow_robot_path(self) -> Decision:
        """The same step by the thesis's name for it while a path is followed."""
        return self.compare_current_frame_with_map()

    def perform_navigation(
        self,
        mapping_active: bool = False,
        matched1_sp_closest: FloatArray | None = None,
        matched2_sp_closest: FloatArray | None = None,
        matched1_sp_second_closest: FloatArray | None = None,
        matched2_sp_second_closest: FloatArray | None = None,
        similarity_first: float | None = None,
        similarity_second: float | None = None,
    ) -> tuple[float, float, float]:
        """Heading (degrees, x, y) from matches at hand: towards a node, or away from both while mapping.

        Args:
            mapping_active: away from the bisector of the two nearest nodes, with noise (figure 4.6).
            matched1_sp_closest: (N, 2) bearings, radians, of the current frame.
            matched2_sp_closest: (N, 2) of the most similar node.
            matched1_sp_second_closest: (N, 2) of the current frame.
            matched2_sp_second_closest: (N, 2) of the second node.
            similarity_first: similarity of the first; not needed for the heading.
            similarity_second: the same of the second.
        """
        del similarity_first, similarity_second
        if matched1_sp_closest is None or matched2_sp_closest is None:
            raise ValueError("perform_navigation needs the matches with the closest node")
        found = self.get_heading(matched1_sp_closest, matched2_sp_closest)
        if not mapping_active:
            return found
        vector = np.array(found[1:])
        if matched1_sp_second_closest is not None and matched2_sp_second_closest is not None:
            vector = vector + self.get_heading(matched1_sp_second_closest, matched2_sp_second_closest)[1:]
        noise = math.radians(self._rng.uniform(-self.exploration_noise, self.exploration_noise))
        angle = math.atan2(-vector[1], -vector[0]) + noise
        return math.degrees(angle), math.cos(angle), math.sin(angle)

    def check_obstacles(self) -> tuple[bool, FloatArray]:
        """Whether an obstacle is near, and the unit vector (2,) towards it; zeros where there is none."""
        ranges = self._ranges()
        found = obstacle_heading(ranges.angles_rad, ranges.distances_m, OBSTACLE_M)
        vector = np.zeros(2) if found is None else np.array([math.cos(found), math.sin(found)])
        return found is not None, vector

    def get_heading(
        self, matched1_sp: FloatArray, matched2_sp: FloatArray, method: MethodName = "4"
    ) -> tuple[float, float, float]:
        """Heading (degrees, x, y) from matched longitudes and latitudes (N, 2), radians (method 4, Q8).

        Raises:
            ValueError: the matches give no direction.
        """
        choice = heading_by_votes(method, matched1_sp, matched2_sp, "given matches")
        angle = choice.estimate.heading_rad
        if angle is None:
            raise ValueError(f"the matches give no heading: {choice.reason}")
        return math.degrees(angle), math.cos(angle), math.sin(angle)

    get_unit_heading_wrt_latitude = staticmethod(latitude_headings)
    get_unit_heading = staticmethod(pair_headings)
    get_keypoint_unitvector = staticmethod(keypoint_unit_vectors)

    def compute_similarity(
        self, node1_details: Features, node2_details: Features
    ) -> tuple[float, FloatArray, FloatArray]:
        """Number of matches of two frames, and their bearings (N, 2) in each, radians."""
        found = LocalMatcher(self.pipeline, MemoryMap())
        found.current = node1_details
        match = found.match([], targets=(node2_details,))[-1]
        matches = np.zeros((0, 4)) if match.matches_rad is None else match.matches_rad.astype(np.float64)
        return float(match.raw_matches), matches[:, :2], matches[:, 2:]

    def find_nearest_map_node(
        self, current_frame_name: str, current_frame_number: float, current_frame_details: Features
    ) -> tuple[int, float, float, FloatArray, FloatArray, FloatArray, FloatArray]:
        """The two most similar nodes of the map, by comparing with all of them (equation 4.1).

        Args:
            current_frame_name: not used; names do not matter to the map.
            current_frame_number: not used either.
            current_frame_details: features of the frame.

        Returns:
            Id of the closest node, similarity to it and to the second, then the matched bearings (N, 2) of
            the frame and of the node for the first and for the second.

        Raises:
            ValueError: the map is empty.
        """
        del current_frame_name, current_frame_number
        nodes = self._map.features
        if not nodes:
            raise ValueError("the map is empty: load_map or map something first")
        found = {n: self.compute_similarity(current_frame_details, nodes[n]) for n in sorted(nodes)}
        closest, *rest = sorted(found, key=lambda n: (-found[n][0], n))
        first = found[closest]
        second = found[rest[0]] if rest else (0.0, np.zeros((0, 2)), np.zeros((0, 2)))
        return closest, first[0], second[0], *first[1:], *second[1:]

    def _new_mission(self) -> Mission:
        if self.mapping_stage:
            if self._map.graph.nodes and not self.continue_mapping:
                raise ValueError("the map is not empty: set continue_mapping, or begin with a new object")
            return ThesisExploration(self._rules, self._map, self._matcher, self._rng)
        if self._goal is None:
            raise ValueError("set target_frame first")
        return Goto(self._rules, self._map, self._matcher, self._goal)

    def _ranges(self) -> Ranges:
        values = tuple(float(v) for v in self.distance_sensor_values)
        if len(values) != SENSORS:
            raise ValueError(f"distance_sensor_values must hold {SENSORS} metres, got {len(values)}")
        angles = tuple(math.radians(360.0 / SENSORS * k) for k in range(SENSORS))
        return Ranges(robot="library", angles_rad=angles, distances_m=values, max_range_m=FAR_M)

    def _features(self, info: Any) -> Features:
        return as_message(self.features(picture_of(info)), self.pipeline.identity, self._frames)

    def _choose_pipeline(self) -> None:
        try:
            self.pipeline  # noqa: B018 - loads the weights
        except (WeightsError, ValueError, ImportError) as error:
            log.warning("SuperPoint and SuperGlue are not to be had, using %s with %s: %s", *FALLBACK, error)
            self.matcher_selection = FALLBACK[1]
            self.kp_descriptor = FALLBACK[0]


def _device(name: str) -> str:
    if name == "cuda" and not torch.cuda.is_available():
        log.warning("there is no GPU, using the processor")
        return "cpu"
    return name


def _map_path(map_name: str | Path | None) -> Path:
    path = Path("map.zip" if map_name is None else map_name)
    return path if path.suffix else path.with_suffix(".zip")
