"""Trained weights that the learned plugins load: where they come from and under which licence. Pure data.

Files are downloaded by kornia and transformers themselves, into their own caches. A checksum is given where
we have held the file in our hands; the others are checked by their libraries alone.
"""

from dataclasses import dataclass
from typing import Literal

from services.features.pipeline.plugins import PATCH_NETWORKS

Source = Literal["kornia", "transformers"]


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
        source: library that downloads it.
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


def _aliked(variant: str, size_bytes: int, sha256: str) -> TrainedModel:
    origin = "github.com/Shiaoming/ALIKED"
    return TrainedModel(variant, f"{variant}.pth", "BSD-3-Clause", origin, (variant,), size_bytes, sha256)


MAGIC_LEAP = "Magic Leap, non-commercial research only"

MODELS: tuple[TrainedModel, ...] = (
    _aliked("aliked-t16", 794859, "56782336919db220144a884e710e2b6af13b3b8f8da15b915a239078ab471085"),
    _aliked("aliked-n16", 2738091, "5be8704840ed662d9d8c561bf7279c222092674e7eb05fd0feab94899e9d82f2"),
    _aliked("aliked-n16rot", 2738325, "ddf3abbf38e86f6a74540d214e1a9712c54b2d8551abc864542199f2347d7332"),
    _aliked("aliked-n32", 3946667, "055283fd1624d3ab46a05c3b617b1a79a3f28d1f551737eef2d653e8c8232890"),
    TrainedModel(
        "tfeat",
        "tfeat-liberty.params",
        "MIT",
        "github.com/vbalnt/tfeat",
        ("tfeat",),
        2400533,
        "1f2e9516b03c45876161da006ce8047e0a66ef08cc91d3fbf96a75f1a80f445a",
    ),
    TrainedModel(
        "mkd",
        "mkd-concat-64.pth",
        "MIT",
        "github.com/manyids2/mkd_pytorch",
        ("mkd",),
        1372952,
        "e31112000009e0d6e159dd7726aeea9f6a7d746cfe7d59b59bfb86c570667641",
    ),
    TrainedModel(
        "affnet",
        "AffNet.pth",
        "MIT",
        "github.com/ducha-aiki/affnet",
        tuple(PATCH_NETWORKS),
        339871,
        "65c8bb2cf71e913818522d09dcc4262bcbcef5d756baa86a41f28526c2d61160",
    ),
    TrainedModel(
        "orinet",
        "OriNet.pth",
        "MIT",
        "github.com/ducha-aiki/affnet",
        tuple(PATCH_NETWORKS),
        323258,
        "030e7964ae3e136d00431c7e11c6b67df40ad299f02ac384fee0f1c3fd1dcb30",
    ),
    TrainedModel(
        "keynet",
        "keynet_pytorch.pth",
        "MIT",
        "github.com/axelBarroso/Key.Net-Pytorch",
        tuple(PATCH_NETWORKS),
        79873,
        "59d3a46d57b439513acf531877fdfaa95eb550ccd10ec462e23d7c1f7a86d52a",
    ),
    TrainedModel("hardnet", "HardNetPP.pth", "MIT", "github.com/DagnyT/hardnet", ("hardnet",)),
    TrainedModel(
        "hardnet8", "hardnet8v2.pt", "see its origin", "github.com/pultarmi/HardNet8", ("hardnet8",)
    ),
    TrainedModel(
        "sosnet", "sosnet_32x32_liberty.pth", "see its origin", "github.com/yuruntian/SOSNet", ("sosnet",)
    ),
    TrainedModel("disk", "depth-save.pth", "Apache-2.0", "github.com/cvlab-epfl/disk", ("disk",)),
    TrainedModel("xfeat", "xfeat.pt", "Apache-2.0", "github.com/verlab/accelerated_features", ("xfeat",)),
    TrainedModel(
        "dedode-detector", "dedode_detector_L_v2.pth", "MIT", "github.com/Parskatt/DeDoDe", ("dedode",)
    ),
    TrainedModel(
        "dedode-descriptor", "dedode_descriptor_B.pth", "MIT", "github.com/Parskatt/DeDoDe", ("dedode",)
    ),
    TrainedModel(
        "lightglue-aliked",
        "aliked_lightglue_v0-1_arxiv-pth",
        "Apache-2.0",
        "github.com/cvg/LightGlue",
        ("lightglue",),
    ),
    TrainedModel(
        "lightglue-disk",
        "disk_lightglue_v0-1_arxiv-pth",
        "Apache-2.0",
        "github.com/cvg/LightGlue",
        ("lightglue",),
    ),
    TrainedModel(
        "lightglue-xfeat",
        "xfeat-lighterglue.pt",
        "Apache-2.0",
        "github.com/verlab/accelerated_features",
        ("lightglue",),
    ),
    TrainedModel(
        "lightglue-dedode", "dedodeb_lightglue.pth", "Apache-2.0", "github.com/cvg/LightGlue", ("lightglue",)
    ),
    TrainedModel(
        "superpoint",
        "magic-leap-community/superpoint",
        MAGIC_LEAP,
        "github.com/magicleap/SuperPointPretrainedNetwork",
        ("superpoint",),
        commercial=False,
        source="transformers",
    ),
    TrainedModel(
        "superglue-indoor",
        "magic-leap-community/superglue_indoor",
        MAGIC_LEAP,
        "github.com/magicleap/SuperGluePretrainedNetwork",
        ("superglue",),
        commercial=False,
        source="transformers",
    ),
    TrainedModel(
        "superglue-outdoor",
        "magic-leap-community/superglue_outdoor",
        MAGIC_LEAP,
        "github.com/magicleap/SuperGluePretrainedNetwork",
        ("superglue-outdoor",),
        commercial=False,
        source="transformers",
    ),
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
