"""Success weighted by path length. Pure.

P. Anderson et al., On Evaluation of Embodied Navigation Agents, 2018.
"""


def spl(success: bool, shortest_m: float, driven_m: float) -> float:
    """S * l / max(p, l) of one round.

    Args:
        success: whether the goal was reached.
        shortest_m: length l of the shortest collision-free way, metres, positive.
        driven_m: length p of the way taken, metres.

    Raises:
        ValueError: a length that is not positive.
    """
    if not shortest_m > 0.0:
        raise ValueError(f"shortest_m must be positive, got {shortest_m}")
    return float(success) * shortest_m / max(driven_m, shortest_m)
