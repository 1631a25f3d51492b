"""Trained weights that the learned plugins load: where they come from and under which licence. Pure data.

Files are downloaded by kornia and transformers themselves, into their own caches; what was trained here comes
with the code. A checksum is given where we have held the file in our hands; the others are checked by
their libraries alone.
"""

from dataclasses import dataclass
from typing import Literal

from services.features.pipeline.plugins import PATCH_NETWORKS

Source = Literal["kornia", "transformers", "topnav"]


@dataclass(frozen=True)
class TrainedModel:
    """One file of weights, or one repository of the Hugging Face hub.

    Attributes:
        name: as in `topnav models pull NAME`.
        file: name in $TORCH_HOME/hub/checkpoints, or the repository for transformers.
        licence: SPDX name, or words where there is none.
        origin: repository of its authors.
        pipelines: extractors and matchers that load it.
        size_bytes: size of the file; 0 where not known.
        sha256: checksum; empty where not known.
        commercial: False where the licence forbids commercial use.
        source: library that downloads it; `topnav` where it comes with the code.
    """

    name: str
    file: str
    licence: str
    origin: str
    pipelines: tuple[str, ...]
    size_bytes: int = 0
    sha256: str = ""
    commercial: bool = True
    source: Source = "kornia"


MAGIC_LEAP = "Magic Leap, non-commercial research only"
CHECKSUMS = {
    "aliked-t16": (794_859, "56782336919db220144a884e710e2b6af13b3b8f8da15b915a239078ab471085"),
    "aliked-n16": (2_738_091, "5be8704840ed662d9d8c561bf7279c222092674e7eb05fd0feab94899e9d82f2"),
    "aliked-n16rot": (2_738_325, "ddf3abbf38e86f6a74540d214e1a9712c54b2d8551abc864542199f2347d7332"),
    "aliked-n32": (3_946_667, "055283fd1624d3ab46a05c3b617b1a79a3f28d1f551737eef2d653e8c8232890"),
    "tfeat": (2_400_533, "1f2e9516b03c45876161da006ce8047e0a66ef08cc91d3fbf96a75f1a80f445a"),
    "mkd": (1_372_952, "e31112000009e0d6e159dd7726aeea9f6a7d746cfe7d59b59bfb86c570667641"),
    "affnet": (339_871, "65c8bb2cf71e913818522d09dcc4262bcbcef5d756baa86a41f28526c2d61160"),
    "orinet": (323_258, "030e7964ae3e136d00431c7e11c6b67df40ad299f02ac384fee0f1c3fd1dcb30"),
    "keynet": (79_873, "59d3a46d57b439513acf531877fdfaa95eb550ccd10ec462e23d7c1f7a86d52a"),
}
"""Size in bytes and SHA-256 of the files that we have held in our hands."""


def _file(name: str, file: str, licence: str, origin: str, *pipelines: str) -> TrainedModel:
    """A file that kornia downloads, from a repository at GitHub."""
    known = CHECKSUMS.get(name, (0, ""))
    return TrainedModel(name, file, licence, f"github.com/{origin}", pipelines or (name,), *known)


def _repository(name: str, repository: str, origin: str, pipeline: str) -> TrainedModel:
    """A repository of Magic Leap that transformers downloads."""
    return TrainedModel(
        name,
        f"magic-leap-community/{repository}",
        MAGIC_LEAP,
        f"github.com/magicleap/{origin}",
        (pipeline,),
        commercial=False,
        source="transformers",
    )


def _own(name: str, size_bytes: int, sha256: str, *plugins: str) -> TrainedModel:
    """A file in services/features/weights, see deploy/TRAINING.md."""
    file, origin = f"{name}.safetensors", "trained here"
    return TrainedModel(
        name, file, "Apache-2.0", origin, plugins or (name,), size_bytes, sha256, source="topnav"
    )


OWN: tuple[TrainedModel, ...] = (
    _own(
        "topnav-slim",
        563_984,
        "48f9ded9bf4187f32a51ebca5db1d7cfd781858cae222b267412c8cf296def60",
        "topnav-slim",
        "topnav-sift-slim",
    ),
    _own(
        "topnav-hardnet",
        2_674_520,
        "01878c3814afe70ce8c7fd0bd946a5b3f8a02d1eda97534da8abb8602c99c3bb",
        "topnav-hardnet",
        "topnav-sift-hardnet",
    ),
    _own(
        "topnav-keypoints",
        787_920,
        "02c9d19ef3d62bf101e4f67983df86c03b83dc03587e216d0fec74d5708552a7",
    ),
    _own(
        "topnav-attention-sift",
        576_642,
        "3c64cd9c5cf3419f9df07cf9969ee75cd9c440b272bfc50ffbd2899a5b5c44ca",
        "topnav-attention",
    ),
    _own(
        "topnav-attention-keypoints",
        568_458,
        "e1fe0a77e8dba4c6c6f5bd8f42edd26f5d967baa377b2201385d2a422e72d353",
        "topnav-attention",
    ),
)
MODELS: tuple[TrainedModel, ...] = (
    _file("aliked-t16", "aliked-t16.pth", "BSD-3-Clause", "Shiaoming/ALIKED"),
    _file("aliked-n16", "aliked-n16.pth", "BSD-3-Clause", "Shiaoming/ALIKED"),
    _file("aliked-n16rot", "aliked-n16rot.pth", "BSD-3-Clause", "Shiaoming/ALIKED"),
    _file("aliked-n32", "aliked-n32.pth", "BSD-3-Clause", "Shiaoming/ALIKED"),
    _file("tfeat", "tfeat-liberty.params", "MIT", "vbalnt/tfeat"),
    _file("mkd", "mkd-concat-64.pth", "MIT", "manyids2/mkd_pytorch"),
    _file("affnet", "AffNet.pth", "MIT", "ducha-aiki/affnet", *PATCH_NETWORKS),
    _file("orinet", "OriNet.pth", "MIT", "ducha-aiki/affnet", *PATCH_NETWORKS),
    _file("keynet", "keynet_pytorch.pth", "MIT", "axelBarroso/Key.Net-Pytorch", *PATCH_NETWORKS),
    _file("hardnet", "HardNetPP.pth", "MIT", "DagnyT/hardnet"),
    _file("hardnet8", "hardnet8v2.pt", "see its origin", "pultarmi/HardNet8"),
    _file("sosnet", "sosnet_32x32_liberty.pth", "see its origin", "yuruntian/SOSNet"),
    _file("disk", "depth-save.pth", "Apache-2.0", "cvlab-epfl/disk"),
    _file("xfeat", "xfeat.pt", "Apache-2.0", "verlab/accelerated_features"),
    _file("dedode-detector", "dedode_detector_L_v2.pth", "MIT", "Parskatt/DeDoDe", "dedode"),
    _file("dedode-descriptor", "dedode_descriptor_B.pth", "MIT", "Parskatt/DeDoDe", "dedode"),
    _file("lightglue-aliked", "aliked_lightglue_v0-1_arxiv-pth", "Apache-2.0", "cvg/LightGlue", "lightglue"),
    _file("lightglue-disk", "disk_lightglue_v0-1_arxiv-pth", "Apache-2.0", "cvg/LightGlue", "lightglue"),
    _file(
        "lightglue-xfeat", "xfeat-lighterglue.pt", "Apache-2.0", "verlab/accelerated_features", "lightglue"
    ),
    _file("lightglue-dedode", "dedodeb_lightglue.pth", "Apache-2.0", "cvg/LightGlue", "lightglue"),
    _repository("superpoint", "superpoint", "SuperPointPretrainedNetwork", "superpoint"),
    _repository("superglue-indoor", "superglue_indoor", "SuperGluePretrainedNetwork", "superglue"),
    _repository("superglue-outdoor", "superglue_outdoor", "SuperGluePretrainedNetwork", "superglue-outdoor"),
    *OWN,
)


def find_model(name: str) -> TrainedModel:
    """Return the model of this name.

    Raises:
        ValueError: there is none; the text lists those there are.
    """
    for model in MODELS:
        if model.name == name:
            return model
    raise ValueError(f"model must be one of {', '.join(m.name for m in MODELS)}; got {name!r}")
