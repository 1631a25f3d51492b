"""Lines of text in a picture, by the models that come in the wheel of `rapidocr`: nothing is downloaded."""

from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import numpy.typing as npt

from shared.geometry.sphere import FloatArray

Image = npt.NDArray[np.uint8]
MODELS = {
    "Det.model_path": "ch_PP-OCRv4_det_infer.onnx",
    "Cls.model_path": "ch_ppocr_mobile_v2.0_cls_infer.onnx",
    "Rec.model_path": "ch_PP-OCRv4_rec_infer.onnx",
}
"""Files of the wheel: of one that it is not told of, the library tries to download another."""


@dataclass(frozen=True)
class Line:
    """One line of text.

    Attributes:
        text: as it was read: untrusted.
        confidence: 0 to 1.
        corners: (4, 2) pixels (u, v): top left, top right, bottom right, bottom left of the text.
    """

    text: str
    confidence: float
    corners: FloatArray


class TextReader:
    """Reads pictures; one thread at a time.

    Args:
        threads: cores it may use.
    """

    def __init__(self, threads: int) -> None:
        from rapidocr import RapidOCR

        spec = find_spec("rapidocr")
        assert spec is not None
        assert spec.origin is not None
        models = Path(spec.origin).parent / "models"
        self._read = RapidOCR(
            params={
                "Global.log_level": "error",
                "Global.use_cls": False,  # no sign hangs upside down
                **{option: str(models / file) for option, file in MODELS.items()},
                "Det.limit_type": "max",  # pictures are read in the size in which they are cut out
                "Det.limit_side_len": 2000,
                "EngineConfig.onnxruntime.intra_op_num_threads": threads,
                "EngineConfig.onnxruntime.inter_op_num_threads": 1,
            }
        )

    def __call__(self, picture: Image) -> list[Line]:
        """All lines in a (height, width, 3) BGR picture."""
        found = self._read(picture)
        if found.txts is None:
            return []
        rows = zip(found.txts, found.scores, found.boxes, strict=True)
        return [Line(str(text), float(score), np.asarray(box, np.float64)) for text, score, box in rows]
