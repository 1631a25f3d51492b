"""Weights whose licence forbids commercial use are loaded only where somebody has said so."""

import os

VARIABLE = "TOPNAV_NON_COMMERCIAL"


def require_consent(model: str) -> None:
    """Refuse unless the environment says that the use is not commercial.

    Raises:
        ValueError: it does not; the text names the licence and the variable.
    """
    if os.environ.get(VARIABLE, "").lower() not in ("1", "true", "yes"):
        raise ValueError(
            f"the weights of {model} are licensed by Magic Leap for non-commercial research only: "
            f"set {VARIABLE}=1 if that is your use, or choose another pipeline, for example aliked-n16"
        )
