"""`SelectKeypointDescriptor` of the thesis's appendix A."""

from dataclasses import replace
from typing import Any

import cv2
import numpy as np
import torch

from experiments.topological_navigation.pictures import Image, picture_of, resized
from services.features.pipeline.extraction import extract
from services.features.pipeline.interfaces import FeatureSet, FloatArray, IndexArray, Profile, Runtime
from services.features.pipeline.named_pipelines import combined
from services.features.pipeline.pipeline import Pipeline
from shared.geometry.sphere import EquirectGrid

DESCRIPTORS = {
    "orb": "orb",
    "sift": "sift",
    "beblid": "beblid",
    "tfeat": "tfeat",
    "hardnet": "hardnet",
    "hardnet8": "hardnet8",
    "sosnet": "sosnet",
    "mkd": "mkd",
    "mkddescriptor": "mkd",
    "superpoint": "superpoint",
}
REPRESENTATIONS = {"cartesian": "planar", "equirectangular": "equirectangular", "tangent": "tangent"}
MATCHERS = {
    "bruteforce": "brute_force",
    "nearestneighbor": "mutual_ratio",
    "superglue": "superglue",
    "lightglue": "lightglue",
}
BORDER_PX = 4  # detectors fire within a few pixels of a black edge
Details = tuple[torch.Tensor, torch.Tensor]
"""Keypoints (M, 4): column, row in the resized picture, longitude, latitude (rad); descriptors (M, D)."""


class SelectKeypointDescriptor:
    """Detects and describes keypoints of one picture with a chosen descriptor and representation.

    Attributes:
        img_info: the picture as it was given; another may be set.
    """

    def __init__(
        self,
        img_info: Any,
        kp_descriptor: str = "ORB",
        draw_keypoints: bool = False,
        representation: str = "Cartesian",
        crop_degree: float = 0,
        max_keypoints: int = 1024,
        device: str = "cpu",
        matcher_selection: str = "BruteForce",
        resize: list[int] | None = None,
        kornia_apply_orinet: bool = True,
        kornia_apply_affnet: bool = True,
        ignore_border_kp: bool = False,
    ) -> None:
        """Choose; nothing is computed yet.

        Args:
            img_info: path, OpenCV image or torch image; "" for none yet.
            kp_descriptor: one of DESCRIPTORS, in any case of letters.
            draw_keypoints: keep a drawing of the keypoints in `drawing`.
            representation: Cartesian, Equirectangular or Tangent.
            crop_degree: angle cut away above and below, degrees.
            max_keypoints: most keypoints.
            device: cpu or cuda.
            matcher_selection: BruteForce, NearestNeighbor, SuperGlue or LightGlue.
            resize: [rows, columns] of the whole picture, [-1] to keep it.
            kornia_apply_orinet: turn patches with OriNet.
            kornia_apply_affnet: shape patches with AffNet.
            ignore_border_kp: leave out keypoints next to black areas and to the border.

        Raises:
            ValueError: a name that is not known, or plugins that do not work together.
        """
        self.img_info: Any = img_info
        self._kp_descriptor, self._representation = kp_descriptor, representation
        self.draw_keypoints = draw_keypoints
        self.drawing: Image | None = None
        self.crop_degree, self.max_keypoints, self.device = crop_degree, max_keypoints, device
        self.matcher_selection = matcher_selection
        self.resize = [-1] if resize is None else list(resize)
        self.kornia_apply_orinet, self.kornia_apply_affnet = kornia_apply_orinet, kornia_apply_affnet
        self.ignore_border_kp = ignore_border_kp
        self._pipeline: Pipeline | None = None
        self._profile()

    @property
    def kp_descriptor(self) -> str:
        """Name of the descriptor."""
        return self._kp_descriptor

    @kp_descriptor.setter
    def kp_descriptor(self, new_descriptor: str) -> None:
        self._kp_descriptor = new_descriptor
        self.update_kp_changes()

    @property
    def representation(self) -> str:
        """Name of the representation."""
        return self._representation

    @representation.setter
    def representation(self, new_representation: str) -> None:
        self._representation = new_representation
        self.update_kp_changes()

    @property
    def pipeline(self) -> Pipeline:
        """The plugins, loaded when first asked for."""
        if self._pipeline is None:
            self._pipeline = Pipeline(self._profile(), runtime=Runtime(self.device))
        return self._pipeline

    def update_kp_changes(self) -> None:
        """Take over changed settings before the next detection."""
        self._pipeline = None
        self._profile()

    def try_descriptor(self) -> Details:
        """Keypoints and descriptors of `img_info` with the chosen descriptor and representation."""
        return self._details(self.img_info)

    def compute_cv2_keypoints(self, img: Image) -> Details:
        """Keypoints (M, 4) and SIFT, BEBLID or ORB descriptors (M, 128 | 64 | 32) of a picture."""
        return self._computed(img, ("sift", "beblid", "orb"))

    def compute_kornia_keypoints(self, img: Image) -> Details:
        """Keypoints (M, 4) and a patch network's descriptors (M, 128) of a picture."""
        return self._computed(img, ("tfeat", "hardnet", "hardnet8", "sosnet", "mkd"))

    def compute_superpoint_keypoints(self, img: Image) -> Details:
        """Keypoints (M, 4) and SuperPoint descriptors (M, 256) of a picture."""
        return self._computed(img, ("superpoint",))

    def detect_equirectangular(self) -> Details:
        """Keypoints and descriptors of `img_info` as one equirectangular picture."""
        return self._represented("Equirectangular")

    def detect_tangent_images(self) -> Details:
        """Keypoints and descriptors of `img_info` by its tangent pictures, in equirectangular coordinates."""
        return self._represented("Tangent")

    @staticmethod
    def read(info: Any) -> Image:
        """A picture from a path, an OpenCV image or a torch image."""
        return picture_of(info)

    def features(self, picture: Image) -> FeatureSet:
        """Features of a picture, without those at the border where `ignore_border_kp` is set."""
        return self._extracted(resized(picture, self.resize))

    def _extracted(self, whole: Image) -> FeatureSet:
        pipeline = self.pipeline
        found = extract(whole, pipeline.extractor, pipeline.representation, pipeline.profile)
        if self.ignore_border_kp:
            found = _inside(found, whole)
        if self.draw_keypoints:
            self.drawing = _drawn(whole, found)
        return found

    def _profile(self) -> Profile:
        names = (
            _known("kp_descriptor", self._kp_descriptor, DESCRIPTORS),
            _known("representation", self._representation, REPRESENTATIONS),
            _known("matcher_selection", self.matcher_selection, MATCHERS),
        )
        return replace(
            combined(*names),
            keypoints=self.max_keypoints,
            crop_deg=float(self.crop_degree),
            resize=None,  # done here, before the picture is cropped, as the thesis's order is unstated (Q20)
            upright=not self.kornia_apply_orinet,
            affnet=self.kornia_apply_affnet,
        )

    def _computed(self, img: Image, allowed: tuple[str, ...]) -> Details:
        name = _known("kp_descriptor", self._kp_descriptor, DESCRIPTORS)
        if name not in allowed:
            raise ValueError(
                f"kp_descriptor must be one of {', '.join(allowed)} here, got {self._kp_descriptor}"
            )
        return self._details(img)

    def _represented(self, representation: str) -> Details:
        before, self.representation = self._representation, representation
        try:
            return self.try_descriptor()
        finally:
            self.representation = before

    def _details(self, info: Any) -> Details:
        whole = resized(picture_of(info), self.resize)
        found = self._extracted(whole)
        keypoints = np.column_stack([_pixels(found, whole), found.lonlat_rad]).astype(np.float32)
        return torch.from_numpy(keypoints), torch.from_numpy(np.ascontiguousarray(found.descriptors))


def _known(what: str, name: str, names: dict[str, str]) -> str:
    found = names.get(name.lower().replace(" ", "").replace("_", ""))
    if found is None:
        raise ValueError(f"{what} must be one of {', '.join(names)}, got {name!r}")
    return found


def _pixels(found: FeatureSet, whole: Image) -> FloatArray:
    """Columns and rows (N, 2) of keypoints in a whole panorama."""
    height, width = whole.shape[:2]
    return EquirectGrid(width, height).pixels_from_lonlat(found.lonlat_rad)


def _cells(found: FeatureSet, whole: Image) -> IndexArray:
    """The pixels (N, 2) that keypoints lie in."""
    height, width = whole.shape[:2]
    return np.minimum(_pixels(found, whole).astype(np.intp), [width - 1, height - 1])


def _inside(found: FeatureSet, picture: Image) -> FeatureSet:
    lit = (picture if picture.ndim == 2 else picture.max(axis=2)) > 0
    inner = cv2.erode(lit.astype(np.uint8), np.ones((3, 3)), iterations=BORDER_PX, borderValue=0)
    column, row = _cells(found, picture).T
    keep = np.flatnonzero(inner[row, column])
    return FeatureSet(found.lonlat_rad[keep], found.scores[keep], found.descriptors[keep])


def _drawn(picture: Image, found: FeatureSet) -> Image:
    shown = cv2.cvtColor(picture, cv2.COLOR_GRAY2BGR) if picture.ndim == 2 else picture.copy()
    for column, row in _cells(found, picture):
        cv2.circle(shown, (int(column), int(row)), 3, (0, 220, 0), 1, cv2.LINE_AA)
    return np.asarray(shown, np.uint8)
